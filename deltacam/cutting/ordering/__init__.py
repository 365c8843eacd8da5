"""The search for the order of cuts: sequence, places and directions with little time on the way in between."""
