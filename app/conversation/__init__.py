"""Conversations in the window: what each of two says on lanes that can be edited, and how it drives two characters."""
