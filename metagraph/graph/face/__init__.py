"""The face: which joints and morph targets move it, and what other tools call them."""
