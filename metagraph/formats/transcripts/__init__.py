"""Transcripts: who says which word when, from every format of them that is read."""
