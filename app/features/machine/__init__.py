"""The expanded state machine beside the meta-graph."""
