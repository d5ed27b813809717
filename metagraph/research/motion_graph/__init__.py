"""Evaluations of searches in motion graphs."""
