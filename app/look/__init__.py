"""Colours, icons, and counted words."""
