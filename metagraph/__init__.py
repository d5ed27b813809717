"""Metagraph: stance, gesture, fidget, transition - the domain, without Qt or OpenGL."""

__version__ = "0.1.0"
