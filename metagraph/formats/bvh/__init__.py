"""BVH motion files."""
