"""Files of props."""
