"""Clips of other skeletons: joint maps."""
