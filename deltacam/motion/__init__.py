"""From cuts to setpoints: a smooth path, its fastest time law, and a setpoint at every tick."""
