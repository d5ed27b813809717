"""Drags of the mouse on the timeline, one in each module."""
