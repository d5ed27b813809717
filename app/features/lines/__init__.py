"""Lines of dialogue."""
