"""Videos and cameras: where the joints of a filmed person are, as keypoints. Nothing leaves the computer."""
