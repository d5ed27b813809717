"""Paths that are extended while they play."""
