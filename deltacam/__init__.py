"""From a DXF drawing to a verified joint-setpoint program for a delta-robot laser cutter."""
