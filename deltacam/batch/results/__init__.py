"""The folder of results, and what it says of all parts."""
