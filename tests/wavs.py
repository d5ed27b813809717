"""WAV files as a test wants them, with heads that a writer of sounds would refuse."""

from __future__ import annotations

import struct
from pathlib import Path


def wav(path: Path, rate: int, data: bytes, channels: int = 1, kind: int = 1, bits: int = 16) -> Path:
    """Write samples under a head that says what the caller wants, true or not. kind: 1 for whole numbers."""
    bytes_a_second = rate * channels * bits // 8 & 0xFFFFFFFF
    head = struct.pack("<IHHIIHH", 16, kind, channels, rate, bytes_a_second, channels * bits // 8, bits)
    body = b"WAVEfmt " + head + b"data" + struct.pack("<I", len(data)) + data
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(b"RIFF" + struct.pack("<I", len(body)) + body)
    return path
