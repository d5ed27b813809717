"""Breathing, gaze, blinks and lips."""
