"""Curves to closed loops and open chains."""
