"""From a study's folder to its results."""
