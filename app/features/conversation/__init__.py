"""Two who talk: lanes of sound, words and segments."""
