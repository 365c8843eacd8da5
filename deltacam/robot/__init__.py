"""The machine: its kinematics, its limits, and the file that describes it."""
