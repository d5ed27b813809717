"""The log of a sitting, and what is read from it or added to it."""
