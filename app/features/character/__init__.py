"""The panel in which the character plays."""
