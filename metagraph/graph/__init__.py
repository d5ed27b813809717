"""The meta-graph: its values, edits, checks and expansion."""
