"""Universal Scene Description, written as text."""
