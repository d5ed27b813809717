"""The sample keypoints: small, our own, said to be made up, and what is in them is what their truth says."""

from __future__ import annotations

import json

import numpy as np
import pytest

from metagraph.formats.keypoints.reader import read_keypoints
from metagraph.graph.model import LAYERS, Project
from metagraph.mimicry.keypoint_layouts import LAYOUTS
from metagraph.mimicry.mimic import Mimic
from sample_clips.make.sample_keypoints import OUT, SCRIPT, SECONDS, View, played, seen, truth
from tests.unchanged import only_when_changed

pytestmark = only_when_changed("sample clips")

NAMES = ["conversation.mediapipe.jsonl", "conversation.openpose.json", "conversation.truth.json"]


def test_there_are_three_files_small_and_said_to_be_made_up() -> None:
    assert sorted(p.name for p in OUT.iterdir()) == NAMES
    for name in NAMES:
        text = (OUT / name).read_text(encoding="utf-8")
        assert len(text) < 400_000 and "Made up: nobody was filmed" in text[:200]


def test_every_stance_is_gone_to(sample: Project) -> None:
    for layer in LAYERS:
        assert {name for _, name in SCRIPT[layer]} == {s.name for s in sample.graphs[layer].stances.values()}


def test_the_truth_tells_of_every_stance_of_the_script_in_its_order(sample: Project) -> None:
    kept = json.loads((OUT / "conversation.truth.json").read_text(encoding="utf-8"))
    for rows in (kept["layers"], truth(*played(sample))):
        for layer in LAYERS:
            assert [name for _, _, name in rows[layer]] == [name for _, name in SCRIPT[layer]]
            ends = [t for start, end, _ in rows[layer] for t in (start, end)]
            assert ends == sorted(ends) and ends[0] == 0 and ends[-1] == SECONDS


@pytest.mark.parametrize("name", NAMES[:2])
def test_what_is_seen_in_the_files_is_the_truth(sample: Project, name: str) -> None:
    found, rows = (
        read_keypoints(OUT / name),
        json.loads((OUT / "conversation.truth.json").read_text(encoding="utf-8"))["layers"],
    )
    mimic = Mimic(sample, mirror=False)
    good, total = dict.fromkeys(LAYERS, 0), dict.fromkeys(LAYERS, 0)
    for time, points, sure in zip(found.times, found.points, found.confidence, strict=True):
        mimic.feed(float(time), points[:, : found.dims], sure)
        for layer in LAYERS:
            true = next((stance for start, end, stance in rows[layer] if start <= time < end), None)
            ident = mimic.seen.get(layer)
            good[layer] += (
                true is not None and ident is not None and sample.graphs[layer].stances[ident].name == true
            )
            total[layer] += true is not None
    assert good["arms"] / total["arms"] > 0.92 and good["head"] / total["head"] > 0.9
    assert good["body"] / total["body"] > (
        0.92 if found.dims == 3 else 0.8
    )  # leaning towards a camera does not show in its picture


def test_a_person_is_seen_whole_with_what_was_lost_left_out(sample: Project) -> None:
    times, picture, space, sure = seen(*played(sample), "mediapipe", 10.0, 6.0, View(lost=0.1))
    assert picture.shape == (60, 33, 2) and space.shape == (60, 33, 3) and times[-1] == pytest.approx(5.9)
    assert 0.05 < (sure == 0).mean() < 0.15 and sure.max() < 1
    names = LAYOUTS["mediapipe"]
    nose, hip, foot = (picture[:, names.index(n), 1] for n in ("nose", "left_hip", "left_ankle"))
    assert (nose < hip).all() and (hip < foot).all() and (foot < View().tall).all()  # y grows downwards
    left, right = (space[:, names.index(f"{s}_shoulder"), 0] for s in ("left", "right"))
    assert (left > right).all()
    hips = (space[:, names.index("left_hip")] + space[:, names.index("right_hip")]) / 2
    assert np.abs(hips).max() < 0.1
