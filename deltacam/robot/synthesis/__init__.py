"""Dimensional synthesis: the smallest robot that does what is asked everywhere in a prescribed workspace."""
