"""Checks of one part of a project each; `graph.check` asks them all."""
