"""From contours to an ordered list of cuts: the process, the kerf, the order."""
