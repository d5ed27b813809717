"""The compiled loops that glTF files are read with, loaded where their object code is kept and it pays."""

from __future__ import annotations

from metagraph.compiling import Loops

TEXT = Loops("metagraph.formats.json_kernels")
KEYS = Loops("metagraph.formats.gltf_kernels")
MANY = 1 << 19  # bytes of files: loading takes what reading so many saves

_read = [0]  # bytes so far, without loops


def count(size: int) -> None:
    """Say that so many bytes are going to be read."""
    if _read[0] < MANY <= _read[0] + size:
        TEXT.load_kept()
        KEYS.load_kept()
    _read[0] = min(_read[0] + size, MANY)
