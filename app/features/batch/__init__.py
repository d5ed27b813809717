"""Renaming, pasting and replacing of several actions at once."""
