"""Measuring how people make characters: what their hands do, and how long that takes."""
