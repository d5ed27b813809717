"""Exporting for engines."""
