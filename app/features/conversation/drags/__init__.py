"""Drags of the mouse on the lanes of a conversation, one in each module."""
