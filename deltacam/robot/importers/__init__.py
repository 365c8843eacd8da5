"""Robot descriptions of other programs, read as robots."""
