"""The meta-graph on its canvas."""
