"""Read and write glTF 2.0 files: clips, characters, morph targets and packed buffers."""
