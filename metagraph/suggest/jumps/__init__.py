"""Which actions would jump visibly, and how to avoid it."""
