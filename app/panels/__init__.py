"""Panels round the canvas; each knows the document and the session, and nothing of the others."""
