"""Searches for a path through a motion graph that goes with speech."""
