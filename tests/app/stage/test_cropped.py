"""What is empty round a picture is not held."""

from __future__ import annotations

import numpy as np
import pytest

from app.stage.cropped import Cropped
from app.stage.gl_view import to_image


@pytest.fixture
def pictures(qapp) -> list[np.ndarray]:
    out = [np.zeros((40, 40, 4), np.uint8) for _ in range(4)]
    out[0][3:9, 20:31] = (10, 20, 30, 40)
    out[1][:] = 200
    out[2][39, 0] = out[2][0, 39] = (0, 0, 1, 1)
    return out  # the last one is empty


def test_pictures_come_back_as_they_were(pictures):
    held = Cropped(pictures)
    assert len(held) == 4
    assert list(held) == [to_image(p) for p in pictures]
    assert held[1:3] == [to_image(p) for p in pictures[1:3]]
    with pytest.raises(IndexError):
        held[4]


def test_only_what_shows_something_is_held(pictures):
    assert Cropped(pictures[:1]).bytes == 6 * 11 * 4
    assert Cropped(pictures[3:]).bytes == 4


def test_the_one_that_was_asked_for_last_is_still_there(pictures):
    held = Cropped(pictures)
    assert held[0] is held[0]
    assert held[1] is not held[0]
