"""The report of a verification for people and programs: text, JSON and a page with pictures."""
