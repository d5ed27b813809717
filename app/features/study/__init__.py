"""Timing studies with people."""
