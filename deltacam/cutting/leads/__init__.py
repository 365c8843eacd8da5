"""How the tool comes to a contour and leaves it: leads through the waste, and the overcut."""
