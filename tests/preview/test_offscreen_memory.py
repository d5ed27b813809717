"""Pictures of many sizes from one place cost no more memory than one."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from preview.camera import Camera
from preview.offscreen import Offscreen
from preview.scene import Scene

pytestmark = pytest.mark.gl
STATM = Path("/proc/self/statm")


@pytest.mark.nightly
@pytest.mark.skipif(not STATM.is_file(), reason="this system does not tell what a process holds")
def test_what_was_drawn_in_another_size_is_given_back():
    def held() -> float:
        return int(STATM.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 2**20

    with Offscreen(64, 64) as place:
        for n in range(6):
            place.render(Scene(), Camera(), size=(600 + 40 * n, 500))
        before = held()
        for n in range(60):
            place.render(Scene(), Camera(), size=(600 + 40 * (n % 6), 500 + (n % 3)))
        # Sixty pictures of 1.2 MB with their depths are 140 MB where they stay.
        assert held() - before < 40
