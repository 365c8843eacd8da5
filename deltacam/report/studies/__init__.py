"""What studies of a robot look like: each from its result to a `Study`."""
