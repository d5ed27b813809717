"""Evaluations of the learned generator."""
