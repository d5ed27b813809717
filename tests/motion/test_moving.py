"""What a clip moves, and how near it is looked at."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.moving import find_moved_parts
from preview.framing import choose_nearness
from sample_clips.make.mannequin_skeleton import mannequin_skeleton

SKELETON = mannequin_skeleton()


def clip(joint: str, degrees: float, walk: float = 0.0, frames: int = 9) -> Clip:
    rotations = np.tile(SKELETON.rest_rotations, (frames, 1, 1))
    angles = np.radians(degrees) * np.sin(np.linspace(0, np.pi, frames))
    turn = rotation.from_axis_angle(np.array([0.0, 0, 1]), angles)
    place = SKELETON.index(joint)
    rotations[:, place] = rotation.multiply(rotations[:, place], turn)
    root = SKELETON.rest_translations[0] + np.linspace(0, walk, frames)[:, None, None] * [0, 0, 1.0]
    return Clip("c", SKELETON, 30, rotations, root)


@pytest.mark.parametrize(
    ("joint", "degrees", "walk", "parts", "near"),
    [
        ("LeftUpperArm", 60, 0, ("arms",), "upper"),
        ("LeftUpperArm", 2, 0, (), "whole"),
        ("LeftUpperArm", 60, 2, ("place", "arms"), "whole"),
        ("Head", 25, 0, ("head",), "head"),
        ("LeftUpperLeg", 40, 0, ("legs",), "whole"),
        ("Chest", 20, 0, ("spine",), "upper"),
    ],
)
def test_a_clip_moves_the_parts_whose_joints_turn_and_is_seen_as_near(joint, degrees, walk, parts, near):
    made = clip(joint, degrees, walk)
    assert find_moved_parts(made) == parts
    assert choose_nearness(made) == near


def test_one_frame_moves_nothing():
    assert find_moved_parts(clip("LeftUpperArm", 90, frames=1)) == ()
