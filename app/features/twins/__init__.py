"""Mirrored twins of clips and actions."""
