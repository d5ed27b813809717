"""Drags of the mouse on the canvas of the manual editor, one in each module."""
