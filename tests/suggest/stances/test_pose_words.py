"""Stances that nobody named are called as they look."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from metagraph.formats.imports import import_files
from metagraph.graph.model import Project
from metagraph.suggest.propose import propose
from metagraph.suggest.stances.known import Shape
from metagraph.suggest.stances.pose_words import describe_pose, is_lying

ROOT = Path(__file__).resolve().parents[3]
ARMS = ("left_hand", "left_lower_arm", "left_upper_arm", "right_hand", "right_lower_arm", "right_upper_arm")


def arms(left: list[float], right: list[float], out: float = 0.0) -> Shape:
    """A stance of arms whose hands are there, heights from the chest; elbows halfway, and so far out."""
    poses = []
    for hand, x in ((left, 0.1), (right, -0.1)):
        shoulder = [x, 0.08, 0.0]
        poses += [
            hand,
            [(a + b) / 2 + c for a, b, c in zip(hand, shoulder, (10 * x * out, 0, 0), strict=True)],
            shoulder,
        ]
    return Shape("", "", "arms", ARMS, np.array([poses]), (), "", 0.0, 1.0)


@pytest.mark.parametrize(
    ("left", "right", "words"),
    [
        ([0.0, -0.11, 0.1], [0.02, -0.05, 0.12], "arms crossed"),
        ([0.04, -0.17, 0.12], [-0.04, -0.17, 0.12], "hands clasped"),
        ([0.05, -0.2, -0.08], [-0.05, -0.2, -0.08], "hands behind the back"),
        ([0.15, -0.24, 0.02], [-0.15, -0.24, 0.02], "hands at the sides"),
        ([0.13, -0.16, 0.0], [-0.13, -0.16, 0.0], "hands on the hips"),
        ([0.15, -0.24, 0.02], [-0.02, 0.06, 0.1], "right hand at the chin"),
        ([0.2, 0.35, 0.1], [-0.2, 0.35, 0.1], "hands raised"),
    ],
)
def test_arms_are_called_by_where_the_hands_are(left: list[float], right: list[float], words: str) -> None:
    assert describe_pose(arms(left, right, 0.1 if "hips" in words else 0.0)) == words


def test_a_pose_of_no_figure_has_a_name_too() -> None:
    shape = Shape("", "", "body", ("joint 0",), np.zeros((1, 1, 3)), (), "", 0.0, 1.0)
    assert describe_pose(shape) and describe_pose(shape, shape)


def test_stances_that_names_do_not_speak_of_are_called_as_they_look() -> None:
    folder = ROOT / "sample_clips" / "clips"
    project = import_files(Project(), None, [folder]).into(Project())
    names = {place.name for place in propose(project, sources=("motion",)).places.values()}
    assert {"arms crossed", "hands on the hips", "hands clasped", "weight left", "head tilted right"} <= names
    assert not any("stance" in name for name in names)


def test_somebody_lies_whose_trunk_is_nearer_to_level_than_to_upright():
    names = ["hips", "trunk"]
    assert is_lying(names, np.array([[0.0, 0.1, 0.0], [0.0, 0.12, 0.3]]))
    assert not is_lying(names, np.array([[0.0, 0.5, 0.0], [0.0, 0.7, 0.1]]))
    assert is_lying(names, np.array([[0.0, 0.5, 0.0], [0.0, 0.3, 0.0]])), "head down"
    assert not is_lying(["hips"], np.zeros((1, 3))), "nothing is known of the trunk"
