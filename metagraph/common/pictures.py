"""What the head of a PNG or JPEG says, read without unpacking it: a picture of kilobytes may unpack to
gigabytes.
"""

from __future__ import annotations

import struct

_PNG = b"\x89PNG\r\n\x1a\n"
_SIZES = frozenset(range(0xC0, 0xD0)) - {0xC4, 0xC8, 0xCC}  # JPEG's frames; the three are tables


def read_picture_size(data: bytes) -> tuple[int, int] | None:
    """Return width and height in pixels of a PNG or JPEG; None for what is neither, or is damaged."""
    size = _png(data) if data[:8] == _PNG else _jpeg(data) if data[:3] == b"\xff\xd8\xff" else None
    return size if size is not None and min(size) > 0 else None


def holds_flat_colors(size: tuple[int, int]) -> bool:
    """Return whether a texture of a size in pixels is so small or narrow that it is a palette: fields of
    colours that must not run into each other, as in smaller copies of the whole (mipmaps).
    """
    return max(size) <= 128 or min(size) <= 64


def _png(data: bytes) -> tuple[int, int] | None:
    if len(data) < 33 or data[12:16] != b"IHDR":
        return None
    width, height = struct.unpack_from(">II", data, 16)
    return width, height


def _jpeg(data: bytes) -> tuple[int, int] | None:
    at = 2
    while at + 9 < len(data):
        if data[at] != 0xFF:
            return None
        kind = data[at + 1]
        if kind == 0xFF:  # filling
            at += 1
            continue
        if kind in _SIZES:
            height, width = struct.unpack_from(">HH", data, at + 5)
            return width, height
        if kind == 0xDA:
            return None
        at += 2 if kind == 0x01 or 0xD0 <= kind <= 0xD8 else 2 + int.from_bytes(data[at + 2 : at + 4], "big")
    return None
