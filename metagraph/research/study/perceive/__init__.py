"""Perceptual studies: which of two videos people prefer, and how they rate one."""
