"""Simulated participants with known effects."""
