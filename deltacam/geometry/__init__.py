"""Plane curves on arrays: lines, arcs, their lengths, headings, flattening and fitting."""
