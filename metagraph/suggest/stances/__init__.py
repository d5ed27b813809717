"""Stances: which there are, what they are called, how far clips are from them."""
