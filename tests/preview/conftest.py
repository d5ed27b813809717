"""Scenes and golden pictures. Set METAGRAPH_UPDATE_GOLDEN=1 to write the pictures again."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from metagraph.motion.character_mesh import CharacterMesh
from metagraph.motion.skeleton import Skeleton
from preview.offscreen import Offscreen, OpenGLError
from preview.sheet import write_png

GOLDEN = Path(__file__).parent / "golden"


@pytest.fixture(scope="session")
def offscreen() -> Iterator[Offscreen]:
    try:
        made = Offscreen(160, 120)
    except OpenGLError as error:
        pytest.skip(str(error))
    with made:
        yield made


@pytest.fixture(scope="session")
def mannequin() -> CharacterMesh:
    from metagraph.formats.gltf.reader import read_character

    return read_character(Path(__file__).parents[2] / "sample_clips" / "mannequin.glb")


@pytest.fixture
def golden() -> Callable[[str, np.ndarray], None]:
    """Compare with `golden/<name>.png`: drivers differ a little along edges, so the mean and the share of far
    pixels count.
    """

    def check(name: str, picture: np.ndarray) -> None:
        from PIL import Image

        path = GOLDEN / f"{name}.png"
        if os.environ.get("METAGRAPH_UPDATE_GOLDEN") == "1":
            GOLDEN.mkdir(exist_ok=True)
            write_png(path, picture)
        with Image.open(path) as image:
            wanted = np.asarray(image.convert("RGBA")).astype(int)
        assert picture.shape == wanted.shape
        apart = np.abs(picture.astype(int) - wanted).max(-1)
        assert apart.mean() < 2.0, f"{name}: pixels differ by {apart.mean():.2f} of 255 on average"
        assert (apart > 40).mean() < 0.02, f"{name}: {(apart > 40).mean():.1%} of the pixels differ much"

    return check


def chain(*names: str, length: float = 0.3) -> Skeleton:
    """A straight chain of joints upwards."""
    offsets = np.zeros((len(names), 3))
    offsets[1:, 1] = length
    return Skeleton(
        tuple(names), np.arange(len(names)) - 1, np.tile([0.0, 0, 0, 1], (len(names), 1)), offsets
    )
