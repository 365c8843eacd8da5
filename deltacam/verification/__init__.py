"""Checks of a program that trust nothing the planner said, and the report of what they found."""
