"""The meta-graph in the middle of the window."""
