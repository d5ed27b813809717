"""Read and write BVH motion files."""
