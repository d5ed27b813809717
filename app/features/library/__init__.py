"""The clips of the project."""
