"""The joint-setpoint program, and the files that hold it."""
