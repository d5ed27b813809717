"""Tension shows in the whole body: shoulders, elbows, hands, trunk."""

from dataclasses import replace
from typing import Any

import msgspec
import numpy as np
import pytest

from metagraph.graph import anatomy
from metagraph.graph.model import Project
from metagraph.motion.joint_map import find_known_roles
from metagraph.playback.planner import make_plan
from metagraph.playback.planning.mood import MOODS, Mood, bearing
from tests.posing import pose_at


def standing(project: Project, valence: float, arousal: float) -> tuple[dict[str, int], Any]:
    """Return roles and where the joints of one who stands are."""
    life = msgspec.structs.replace(project.life, valence=valence, arousal=arousal)
    project = replace(project, life=life)
    assert project.skeleton is not None
    pose = pose_at(make_plan(project, 4.0, seed=1, idle=False), project, 2.0)
    return find_known_roles(project.skeleton, anatomy.project_roles(project)), project.skeleton.globals(pose)[
        1
    ]


def bend(at: Any, *line: int) -> float:
    a, b = np.diff(at[list(line)].astype(float), axis=0)
    return float(np.degrees(np.arccos(a @ b / np.linalg.norm(a) / np.linalg.norm(b))))


def test_in_anger_hands_close_elbows_bend_and_the_trunk_goes_ahead(sample: Project) -> None:
    roles, calm = standing(sample, 0.0, 0.0)
    _, angry = standing(sample, *MOODS["angry"])
    for side in ("left", "right"):
        finger = [roles[f"{side}_{p}"] for p in ("hand", "index_1", "index_2")]
        arm = [roles[f"{side}_{p}"] for p in ("upper_arm", "lower_arm", "hand")]
        assert bend(angry, *finger) > bend(calm, *finger) + 20
        assert bend(angry, *arm) > bend(calm, *arm) + 10
        shoulder = roles[f"{side}_upper_arm"]
        assert (
            angry[shoulder, 1] - angry[roles["neck"], 1] > calm[shoulder, 1] - calm[roles["neck"], 1] + 0.005
        )
    ahead = [at[roles["head"], 2] - at[roles["hips"], 2] for at in (calm, angry)]
    assert ahead[1] > ahead[0] + 0.03


@pytest.mark.parametrize("name", ["thrust", "tension"])
def test_both_grow_with_arousal_fall_with_pleasure_and_are_none_at_rest(name: str) -> None:
    steps = np.linspace(-1, 1, 21)
    for other in steps[9:]:  # beyond, fear draws back
        up = [getattr(bearing(Mood(float(other), float(x), 1.0)), name) for x in steps]
        across = [getattr(bearing(Mood(float(x), float(other), 1.0)), name) for x in steps[10:]]
        assert (np.diff(up) >= 0).all()
        assert (np.diff(across) <= 0).all()
        assert max(up[:11]) == 0


def test_in_fear_the_trunk_draws_back_and_shoulders_come_up_and_forward(sample: Project) -> None:
    roles, calm = standing(sample, 0.0, 0.0)
    _, afraid = standing(sample, *MOODS["afraid"])
    ahead = [at[roles["neck"], 2] - at[roles["hips"], 2] for at in (calm, afraid)]
    assert ahead[1] < ahead[0] - 0.03
    for side in ("left", "right"):
        away = [at[roles[f"{side}_upper_arm"]] - at[roles["neck"]] for at in (calm, afraid)]
        assert away[1][1] > away[0][1] + 0.015
