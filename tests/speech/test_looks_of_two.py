"""Two who talk look at each other about as long as people do, measured from their poses."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from metagraph.formats.store import open_project
from metagraph.graph import anatomy
from metagraph.graph.model import Project
from metagraph.playback.evaluator import Evaluator
from metagraph.playback.planning.running_plan import plan_performance
from metagraph.speech.duet import find_resting_eyes, plan_duet
from tests.benchmarks.bench_gaze import SAMPLES, Looked, look_at, without_brief
from tests.speech.group import made_up


@pytest.fixture(scope="module")
def standing(sample: Project) -> Project:
    return sample


@pytest.fixture(scope="module")
def sitting() -> Project:
    return open_project(SAMPLES / "seated.metagraph.yaml").project


def test_eyes_are_where_a_character_that_sits_has_them(standing: Project, sitting: Project) -> None:
    high, low = find_resting_eyes(standing), find_resting_eyes(sitting)
    assert high[1] - low[1] > 0.3 and low[2] < high[2] - 0.3
    assert sitting.skeleton is not None
    plan = plan_performance(sitting, (), 4.0, 1, idle=False)
    at = sitting.skeleton.globals(Evaluator(plan, sitting).at(np.arange(0, 4.0, 0.5)))[1]
    roles = anatomy.project_roles(sitting)
    np.testing.assert_allclose(at[:, roles["left_eye"], 1], low[1], atol=0.04)
    assert find_resting_eyes(Project("empty"))[1] > 1.0


def test_who_stands_looks_at_who_sits_also_after_a_look_away(standing: Project, sitting: Project) -> None:
    duet = plan_duet(made_up(2, 3, 30.0), "talk", (standing, sitting), (None, None))
    for n, part in enumerate(duet.parts):
        points = {p.name: p.point for p in part.plan.track.places}
        assert points["user"] == points["partner"]
        other = duet.parts[1 - n]
        eyes = part.stand.own(other.stand.world(find_resting_eyes(other.project)))
        np.testing.assert_allclose(points["user"], eyes, atol=1e-3)


def test_looks_as_short_as_jumps_of_the_eyes_do_not_count() -> None:
    looks = np.array([True] * 10 + [False] * 2 + [True] * 10 + [False] * 8 + [True] * 2 + [False] * 8)
    assert without_brief(looks).tolist() == [True] * 22 + [False] * 18


@pytest.mark.nightly
@pytest.mark.parametrize("seated", [False, True])
def test_speakers_look_half_of_the_time_and_listeners_three_quarters(
    standing: Project, sitting: Project, seated: bool
) -> None:
    found, projects = Looked(), (standing, sitting if seated else standing)
    office = next(iter(standing.conversations.values()))
    for seed in range(300, 308):
        look_at(found, msgspec.structs.replace(office, seed=seed), projects, SAMPLES)
    for seed in range(300, 302):
        look_at(found, made_up(2, seed, 120.0), projects, None)
    assert 0.38 < found.share("speaks") < 0.6
    assert 0.65 < found.share("listens") < 0.85
    assert 0.28 < found.share("both look") < 0.5
