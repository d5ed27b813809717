"""Timing studies in the window: participants are led through their sittings, and what their hands do is counted."""
