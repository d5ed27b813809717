"""Texts as OSC packs them."""

from __future__ import annotations


def padded(text: str) -> bytes:
    """Return a text as OSC has it: ended by a zero byte and filled up to four."""
    data = text.encode("utf-8", "replace").replace(b"\0", b"?") + b"\0"
    return data + b"\0" * (-len(data) % 4)
