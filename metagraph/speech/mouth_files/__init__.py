"""What the mouth does over time, from every kind of file that says it."""
