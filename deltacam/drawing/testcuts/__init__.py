"""Drawings of test cuts: what to cut, and to measure, to find the values of a process."""
