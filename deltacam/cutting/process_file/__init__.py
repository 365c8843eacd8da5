"""The process file: what it may hold, how it is read, and how one is written."""
