import re
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest

from metagraph.generation.features import PARTNER, SELF
from metagraph.generation.landmarks import LANDMARKS, place_landmarks
from metagraph.generation.poses import encode_clip
from metagraph.generation.statistics import MotionSample, mean_landmarks
from metagraph.research.generation import figures
from tests.generation.makers import moving, rig


def performance(seconds: float = 8.0, seed: int = 1) -> MotionSample:
    own = rig()
    poses = encode_clip(own, moving(seconds, seed), 25.0)
    activity = np.zeros((len(poses), 4))
    activity[: len(poses) // 2, SELF] = 1
    activity[len(poses) // 2 :, PARTNER] = 1
    return MotionSample(place_landmarks(own, poses), poses, activity)


def test_whiskers_end_at_values_and_what_is_beyond_stands_alone():
    low, first, middle, third, high, beyond = figures.compute_box_plot(np.array([*range(1, 12), 100.0]))
    assert (low, middle, high) == (1, 6.5, 11)
    assert first < middle < third
    assert beyond.tolist() == [100]
    assert figures.compute_box_plot(np.full(5, 3.0))[:5] == (3, 3, 3, 3, 3)


def test_distances_are_in_centimetres_from_the_mean():
    one = performance()
    mean = mean_landmarks([one])
    moved = replace(one, landmarks=np.repeat(mean[None], len(one), 0) + [0.03, 0.04, 0.0])
    assert figures.measure_landmark_distances([moved], mean) == pytest.approx(5.0)


def test_changes_are_split_by_who_speaks():
    one = performance()
    mean = mean_landmarks([one])
    own, partner = (figures.measure_distance_changes([one], mean, who) for who in (SELF, PARTNER))
    assert len(own) + len(partner) == len(one) - 1
    grown = np.diff(figures.measure_landmark_distances([one], mean), axis=0) * 25
    assert np.allclose(np.concatenate([own, partner]), grown)


def test_every_drawing_is_xml_within_its_frame():
    one, other = performance(), performance(seed=2)
    mean = mean_landmarks([one])
    far = {
        "true": figures.measure_landmark_distances([one], mean),
        "<b>": figures.measure_landmark_distances([other], mean),
    }
    for drawing in (
        figures.draw_over_time(one, mean),
        figures.draw_boxes(far, "cm"),
        figures.draw_overlaid({"true": one, "<b>": other}),
    ):
        root = ElementTree.fromstring(drawing)
        assert root.tag.endswith("svg")
        height = float(root.attrib["viewBox"].split()[3])
        for points in re.findall(r"points='([^']+)'", drawing):
            xy = np.array([p.split(",") for p in points.split()], float)
            assert xy.min() >= 0 and xy[:, 0].max() <= 640 and xy[:, 1].max() <= height


def test_a_box_of_each_landmark_and_system_is_drawn():
    one = performance()
    mean = mean_landmarks([one])
    drawing = figures.draw_boxes(
        {"a": figures.measure_landmark_distances([one], mean), "none": np.zeros((0, 9))}, "cm"
    )
    assert drawing.count("<polygon") == len(LANDMARKS)
    assert "nothing to draw" in figures.draw_boxes({}, "cm")


def test_poses_are_drawn_once_a_second_from_the_front_whichever_way_somebody_looks():
    one = performance(8.0)
    assert figures.draw_overlaid({"true": one}).count("<path") == 9
    quarter = np.array([[0.0, 0, 1], [0, 1, 0], [-1, 0, 0]])
    turned = replace(one, landmarks=one.landmarks @ quarter.T)
    wide = [
        np.ptp([float(x) for x in re.findall(r"M([\d.]+) ", figures.draw_overlaid({"a": m}))])
        for m in (one, turned)
    ]
    assert wide[1] == pytest.approx(wide[0], rel=0.02)
