"""Hands in contact: whose, with what, how much of it shows, and how far from where it should be."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import msgspec
import numpy as np
import pytest

from metagraph.graph.model import Project
from metagraph.playback.plan import Plan
from metagraph.playback.posing.hand_touches import MISSED, HandTouch, find_hand_touches, plan_of_clip
from tests.posing import contact_rig, pose_at


def seen(project: Project, plan: Plan, seconds: float) -> Any:
    assert project.skeleton is not None
    return project.skeleton.globals(pose_at(plan, project, seconds))


@pytest.fixture
def held(sample: Project) -> tuple[Project, Plan, float]:
    """The sample, a plan of a clip with a contact that lasts, and the middle of that."""
    touching = [a for a in sample.actions() if a.contacts]
    action = max(touching, key=lambda a: a.contacts[0].end - a.contacts[0].start)
    span = action.contacts[0]
    return sample, plan_of_clip(sample, action.clip), (span.start + span.end) / 2


def test_a_project_without_arms_and_a_plan_without_contacts_have_none(sample: Project) -> None:
    at = np.zeros((61, 4)), np.zeros((61, 3))
    assert find_hand_touches(Plan(0, 1.0), Project(), 0.5, *at) == []
    assert find_hand_touches(Plan(0, 1.0), sample, 0.5, *at) == []


def test_a_hand_that_came_is_held_where_the_contact_wants_it(held: tuple[Project, Plan, float]) -> None:
    project, plan, seconds = held
    touches = find_hand_touches(plan, project, seconds, *seen(project, plan, seconds))
    assert touches and all(t.held and t.away < MISSED and not t.missed for t in touches)
    rig = contact_rig(project)
    assert rig is not None
    names = {rig.joints[arm.hand] for arm in rig.arms}
    assert {t.hand for t in touches} <= names and [t.side for t in touches] == sorted(t.side for t in touches)


def test_a_hand_that_is_elsewhere_is_missed_by_as_much(held: tuple[Project, Plan, float]) -> None:
    project, plan, seconds = held
    rotations, positions = seen(project, plan, seconds)
    (first, *_) = find_hand_touches(plan, project, seconds, rotations, positions)
    moved = np.array(positions)
    moved[first.hand] += (0.0, 0.05, 0.0)
    (again, *_) = find_hand_touches(plan, project, seconds, rotations, moved)
    assert again.missed and again.away == pytest.approx(0.05, abs=MISSED)


def test_contacts_that_are_off_are_not_shown(held: tuple[Project, Plan, float]) -> None:
    project, plan, seconds = held
    off = replace(project, touch=msgspec.structs.replace(project.touch, contacts=False))
    assert find_hand_touches(plan, off, seconds, *seen(off, plan, seconds)) == []


def test_a_hand_on_its_way_is_not_yet_missed() -> None:
    assert not HandTouch(0, 1, 2, 0.5, 0.3).missed and not HandTouch(0, 1, 2, 0.5, 0.3).held
    assert HandTouch(1, 1, 2, 1.0, 0.3).missed
