"""Keypoints that pose estimators find in videos."""
