"""Contacts found in clips whose touches are known: the sample's."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest

from metagraph.formats.gltf.reader import read_character
from metagraph.formats.store import open_project
from metagraph.graph.model import Action, Project
from metagraph.motion.contact_spans import ContactSpan
from metagraph.playback.posing.contacts import find_body_parts
from metagraph.suggest.find_contacts import find_contacts, with_contacts, with_measured_body

SAMPLES = Path(__file__).resolve().parents[2] / "sample_clips"


@lru_cache(maxsize=1)
def sample() -> Project:
    return open_project(SAMPLES / "sample.metagraph.yaml").project


def of(clip: str) -> tuple[Action, tuple[ContactSpan, ...]]:
    entry = next(c for c in sample().clips.values() if c.name == clip)
    action = next(a for a in sample().actions() if a.clip == entry.id)
    return action, find_contacts(sample(), action)


@pytest.mark.parametrize(
    ("clip", "hand", "to"),
    [
        ("on_hips__stance", "left", "Hips"),
        ("on_hips__stance", "right", "Hips"),
        ("arms_crossed__stance", "right", "LeftUpperArm"),
        ("hands_clasped__stance", "right", "LeftHand"),
        ("hand_to_chin__stance", "right", "Head"),
        ("hands_at_sides__touch_neck_rt_01", "right", "Neck"),
        ("hands_clasped__rub_hands_bt_01", "right", "LeftHand"),
    ],
)
def test_hands_that_rest_on_something_are_found_there(clip: str, hand: str, to: str) -> None:
    _, found = of(clip)
    assert any(s.hand == hand and s.to == to for s in found)


@pytest.mark.parametrize(
    "clip",
    ["hands_at_sides__stance", "hands_at_sides__wave_hello_rt_01", "hands_at_sides__swing_arms_bt_01"],
)
def test_hands_that_hang_or_wave_touch_nothing(clip: str) -> None:
    assert of(clip)[1] == ()


def test_a_hand_that_stays_has_one_key_and_one_that_rubs_has_many() -> None:
    assert {len(s.keys) for s in of("on_hips__stance")[1]} == {1}
    assert len(of("hands_clasped__rub_hands_bt_01")[1][0].keys) > 5


@pytest.mark.nightly
def test_of_two_hands_on_each_other_one_carries_the_other() -> None:
    for action in sample().actions():
        spans = find_contacts(sample(), action) if action.layer == "arms" else ()
        for a in spans:
            for b in spans:
                both = {a.to, b.to} == {"LeftHand", "RightHand"} and a is not b if a.hand != b.hand else False
                assert not (both and a.start < b.end and b.start < a.end), action.name


@pytest.mark.nightly
def test_spans_lie_in_their_action_in_order_with_keys_in_order() -> None:
    for action in sample().actions():
        start, end = sample().span(action)
        for span in find_contacts(sample(), action):
            times = [k.time for k in span.keys]
            assert start <= span.start < span.end <= end
            assert times == sorted(set(times))
            assert all(abs(np.linalg.norm(k.turn) - 1) < 1e-5 for k in span.keys)


@pytest.mark.nightly
def test_the_sample_has_the_contacts_that_are_found_in_it() -> None:
    ids = [a.id for a in sample().graphs["arms"].actions.values()]
    again = with_contacts(sample(), ids)
    for ident in ids:
        before, after = sample().action(ident), again.action(ident)
        assert before is not None and after is not None
        assert [(s.hand, s.to) for s in before.contacts] == [(s.hand, s.to) for s in after.contacts]


def test_a_clip_that_is_missing_or_one_of_another_skeleton_has_none() -> None:
    action = next(a for a in sample().actions() if a.contacts)
    clips = {**sample().clips, action.clip: replace(sample().clips[action.clip], motion=None)}
    assert find_contacts(replace(sample(), clips=clips), action) == ()


def test_a_body_measured_on_its_mesh_is_about_what_its_skeleton_says() -> None:
    character = read_character(SAMPLES / "mannequin.glb")
    by_mesh = with_measured_body(sample(), character).touch.parts
    assert with_measured_body(sample(), None).touch.parts == ()
    by_bones = find_body_parts(with_measured_body(sample(), None))
    assert [(p.joint, p.to) for p in by_mesh] == [(p.joint, p.to) for p in by_bones]
    for a, b in zip(by_mesh, by_bones, strict=True):
        assert 0.6 < a.radius / b.radius < 1.5, a.joint
