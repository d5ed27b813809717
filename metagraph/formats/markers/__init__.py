"""Read optical motion capture: markers of TRC and C3D files, joint centres, and clips of these."""
