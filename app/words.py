"""Small words that several panels say alike."""

from __future__ import annotations


def many(count: int, noun: str) -> str:
    """Return "1 clip", "2,328 connections"."""
    return f"{count:,} {noun}{'s' if count != 1 else ''}"
