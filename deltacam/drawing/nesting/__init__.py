"""Which contour lies in which, and where they meet."""
