"""Read the default body as it was sculpted."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from metagraph.formats.gltf.reader import read_character
from metagraph.motion.fitting.sculpture import Sculpture, make_sculpture

PATH = Path(__file__).with_name("body.glb")


@lru_cache(maxsize=1)
def read_sculpture() -> Sculpture:
    """Return the sculpted body; it is kept, as it is the same for all skeletons."""
    return make_sculpture(read_character(PATH))
