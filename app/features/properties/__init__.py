"""The properties and the timing of actions."""
