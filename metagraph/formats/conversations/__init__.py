"""Conversations: sound files, who says what in which language, and how they are written."""
