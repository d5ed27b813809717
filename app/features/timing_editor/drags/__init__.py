"""Drags of the mouse in the timing editor, one in each module."""
