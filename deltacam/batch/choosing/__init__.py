"""Which drawings a batch plans, and what is different for which."""
