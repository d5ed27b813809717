"""Keypoints of a person, mimicked."""
