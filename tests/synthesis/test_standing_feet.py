"""Feet that stand where they stood."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from metagraph.graph.model import Project
from metagraph.motion.clip import Clip
from metagraph.motion.roles import find_roles
from metagraph.synthesis.standing_feet import FARTHEST, find_standing, keep_feet_still

Array = NDArray[Any]


@pytest.fixture
def still(sample: Project) -> Clip:
    """Somebody who stands for two seconds, 30 frames a second."""
    clip = next(c.motion for c in sample.clips.values() if c.motion is not None)
    rotations, translations = np.repeat(clip.rotations[:1], 60, 0), np.repeat(clip.translations[:1], 60, 0)
    return replace(clip, rotations=rotations, translations=translations, fps=30.0, weights=None, morphs=())


def slid(clip: Clip, by: Array) -> Clip:
    """The same, its root moved aside by metres `[F]`."""
    translations = clip.translations.copy()
    translations[:, 0, 0] += by
    return replace(clip, translations=translations)


def feet(clip: Clip) -> Array:
    roles = find_roles(clip.skeleton)
    return np.asarray(clip.skeleton.globals(clip.poses())[1][:, [roles["left_foot"], roles["right_foot"]]])


def everywhere(clip: Clip) -> dict[str, Array]:
    return {side: np.ones(clip.frames, bool) for side in ("left", "right")}


def test_who_stands_still_stands_and_who_is_carried_does_not(still: Clip) -> None:
    found = find_standing(still.skeleton, still.poses())
    assert all(there.all() for there in found.values()) and set(found) == {"left", "right"}
    carried = slid(still, np.linspace(0, 2, 60))
    assert not any(there.any() for there in find_standing(carried.skeleton, carried.poses()).values())


def test_feet_that_do_not_slide_stay_as_they_are(still: Clip) -> None:
    made = keep_feet_still(still, everywhere(still))
    assert np.abs(made.rotations - still.rotations).max() < 1e-4
    step = slid(still, np.where(np.arange(60) < 30, 0.0, 0.5))
    nowhere = {side: np.zeros(60, bool) for side in ("left", "right")}
    assert np.abs(keep_feet_still(step, nowhere).rotations - step.rotations).max() < 1e-6


def test_feet_stay_where_they_were_put_down_while_the_body_sways(still: Clip) -> None:
    sways = slid(still, 0.05 * np.sin(np.linspace(0, 6, 60)))
    made = feet(keep_feet_still(sways, everywhere(sways)))
    assert np.abs(made[..., [0, 2]] - made[0][:, [0, 2]]).max() < 0.004
    assert np.abs(feet(sways) - feet(sways)[0]).max() > 0.045


def test_a_foot_goes_along_with_what_goes_too_far(still: Clip) -> None:
    far = slid(still, np.linspace(0, 0.6, 60))
    made = feet(keep_feet_still(far, everywhere(far)))
    back = np.linalg.norm((made - feet(far))[..., [0, 2]], axis=-1)
    assert back.max() <= FARTHEST * 1.2
    assert np.linalg.norm(np.diff(made, axis=0), axis=-1).max() < 0.03  # and never jumps


def test_a_foot_that_is_let_go_does_not_jump(still: Clip) -> None:
    sways = slid(still, np.linspace(0, 0.08, 60))
    there = {side: np.arange(60) < 40 for side in ("left", "right")}
    made = feet(keep_feet_still(sways, there))
    assert np.linalg.norm(np.diff(made, axis=0), axis=-1).max() < 0.03


def test_without_legs_nothing_is_held(still: Clip) -> None:
    assert keep_feet_still(still, {}) is still
