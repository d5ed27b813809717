"""Drags of the mouse on the canvas of the meta-graph, one in each module."""
