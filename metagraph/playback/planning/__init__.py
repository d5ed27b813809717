"""The planner: from asks to a plan of specific actions."""
