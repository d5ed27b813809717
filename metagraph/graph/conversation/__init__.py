"""Conversations in a project and their edits."""
