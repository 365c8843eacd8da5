"""What was read from a drawing, for people and programs: text, JSON and a picture."""
