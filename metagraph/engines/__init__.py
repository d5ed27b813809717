"""Exports for engines."""
