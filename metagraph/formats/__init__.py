"""Files in and out: BVH, glTF, FBX, projects."""
