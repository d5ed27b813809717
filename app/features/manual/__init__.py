"""The state machine drawn by hand."""
