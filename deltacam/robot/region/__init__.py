"""Where a robot can work: the region that keeps every requirement, proved and not sampled."""
