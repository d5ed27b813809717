"""Motion: rotations, skeletons, clips and what can be measured on them. The ground everything stands on."""
