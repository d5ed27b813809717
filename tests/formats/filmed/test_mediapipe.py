"""With MediaPipe itself, where its extra is installed: the sample's character is found in a film of it."""

from __future__ import annotations

from pathlib import Path

import pytest

from metagraph.common.extras import is_installed
from metagraph.formats.filmed.estimator import EXTRA, PoseEstimator
from metagraph.formats.filmed.film import film_video
from metagraph.mimicry.keypoint_layouts import PLACE

pytestmark = pytest.mark.skipif(
    not is_installed(EXTRA), reason="MediaPipe is not installed: metagraph extras add camera"
)


@pytest.mark.gl
def test_the_character_is_found_and_stands_upright(tmp_path: Path) -> None:
    from app.cli.parser import main

    project = Path(__file__).resolve().parents[3] / "sample_clips" / "sample.metagraph.yaml"
    film = tmp_path / "ada.mp4"
    assert main(["render", str(project), "-s", "1", "--fps", "10", "-o", str(film)]) == 0
    filmed = film_video(film)
    assert filmed.estimator.startswith("MediaPipe 0.10.")
    assert sum("landmarks" in frame for frame in filmed.frames) == len(filmed.frames) == 10
    points, sure = filmed.track.canonical
    assert sure[:, [PLACE["left_shoulder"], PLACE["right_hip"]]].min() > 0.5
    assert (points[:, PLACE["nose"], 1] > points[:, PLACE["left_ankle"], 1] + 1.0).all()
    assert (points[:, PLACE["left_shoulder"], 0] > points[:, PLACE["right_shoulder"], 0]).all()


def test_it_loads_nothing_from_the_network(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("HTTP_PROXY", "HTTPS_PROXY", "http_proxy", "https_proxy"):
        monkeypatch.setenv(name, "http://127.0.0.1:9")  # where nobody answers
    estimator = PoseEstimator()
    try:
        assert estimator.name.startswith("MediaPipe")
    finally:
        estimator.close()
