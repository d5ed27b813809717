"""Mimicry (Borer et al., section 7.4): a person's keypoints, seen frame by frame, become requests for the
stances they are in.
"""
