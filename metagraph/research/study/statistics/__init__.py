"""Statistics for small studies."""
