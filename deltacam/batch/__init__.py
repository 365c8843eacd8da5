"""Many drawings: planned and verified one by one in processes of their own, here or on a cluster."""
