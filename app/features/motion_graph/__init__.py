"""New motion from takes."""
