"""OpenGL preview: numbers in, pixels out; no Qt."""
