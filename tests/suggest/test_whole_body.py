"""Recordings of the whole body: noticed in whatever figure, units and names, and nowhere else."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.graph.model import LAYERS, Project
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.suggest.accept import accept
from metagraph.suggest.clip_measures import with_tremble
from metagraph.suggest.propose import propose
from metagraph.suggest.traits import Traits, measure_all_traits
from metagraph.suggest.whole_body import (
    CARRIER,
    SCALE,
    are_whole_body_recordings,
    is_whole_body_carried,
    with_whole_body,
)
from tests.label_zoo.catalogue import named
from tests.suggest.test_traits import chain, of

WHOLE = (
    "standing talker",
    "arms tell the stances",
    "sitting talker",
    "sitting, leaning, standing",
    "sitting without legs",
    "opaque takes",
)
LAYERED = ("japanese joints", "few joints", "no turns at rest, no fingers", "a hundred times too large")


def test_without_clips_or_with_one_nothing_was_recorded_whole(toy: Any) -> None:
    one = {"x": of(toy.clip("x"))}
    assert not are_whole_body_recordings({}) and not are_whole_body_recordings({}, {"x": "sit"})
    assert not are_whole_body_recordings(one) and not are_whole_body_recordings(
        one, {"x": "sit", "gone": "stand"}
    )


@pytest.mark.parametrize("frames", [1, 40])
def test_a_skeleton_that_is_no_figure_was_not_recorded_whole(frames: int) -> None:
    from metagraph.motion.clip import Clip

    turns = np.tile([0, 0, 0, 1.0], (frames, 4, 1))
    clips = {f"x{n}": of(Clip("x", chain(4), 30, turns, np.zeros((frames, 1, 3)))) for n in range(5)}
    assert not are_whole_body_recordings(clips) and not are_whole_body_recordings(
        clips, dict.fromkeys(clips, "sit")
    )
    for t in clips.values():
        whole = with_whole_body(t).layers[CARRIER]
        assert np.isfinite(whole.first).all() and np.isfinite([whole.extent, whole.loop_error]).all()


@pytest.mark.nightly
@pytest.mark.parametrize("name", WHOLE)
def test_takes_of_the_whole_body_are_noticed_by_names_or_by_motion(name: str) -> None:
    assert propose(named(name).project).whole


@pytest.mark.nightly
@pytest.mark.parametrize("name", LAYERED)
def test_clips_of_single_layers_are_not(name: str) -> None:
    project = named(name).project
    assert not propose(project).whole and not propose(project, sources=("motion",)).whole


@pytest.fixture(scope="module")
def talker() -> dict[str, Traits]:
    return measure_all_traits(named("standing talker").project)


@pytest.mark.nightly
@settings(max_examples=25)  # what one order in eight would change is found 96 times of 100
@given(st.randoms())
def test_the_order_of_clips_does_not_matter(random: Any) -> None:
    for name, whole in (("opaque takes", True), ("few joints", False)):
        found = list(_known(name).items())
        random.shuffle(found)
        assert are_whole_body_recordings(dict(found)) == whole


_TRAITS: dict[str, dict[str, Traits]] = {}


def _known(name: str) -> dict[str, Traits]:
    if name not in _TRAITS:
        _TRAITS[name] = measure_all_traits(named(name).project)
    return _TRAITS[name]


@pytest.mark.nightly
def test_names_alone_tell_it_where_one_stance_stands_before_what_several_layers_do(
    talker: dict[str, Traits],
) -> None:
    from metagraph.suggest.clip_measures import guess_layer, has_no_measures

    moving = [c for c, t in talker.items() if not has_no_measures(t) and t.face == 0]
    layer = {c: guess_layer(talker[c]).value for c in moving}
    assert len(set(layer.values())) > 1
    by_layer = {c: {"arms": "wave", "head": "nod", "body": "shift"}[layer[c]] for c in moving}
    mixed = {c: ("stand", "sit")[n % 2] for n, c in enumerate(moving)}
    some = {c: talker[c] for c in moving}
    assert are_whole_body_recordings(some, mixed)
    assert are_whole_body_recordings(some, by_layer) == are_whole_body_recordings(
        some
    )  # words for layers say nothing new
    assert are_whole_body_recordings(some, dict.fromkeys(moving, "stand")) == are_whole_body_recordings(some)


def test_the_whole_is_every_layer_in_the_carriers_measure(talker: dict[str, Traits]) -> None:
    for t in talker.values():
        whole = with_whole_body(t).layers[CARRIER]
        assert whole.names == tuple(n for layer in LAYERS for n in t.layers[layer].names)
        at = 0
        for layer in LAYERS:
            own = t.layers[layer]
            part = whole.first[at : at + len(own.names)]
            assert part == pytest.approx(own.first * SCALE[layer])
            at += len(own.names)
        assert whole.extent == pytest.approx(max(t.layers[x].extent * SCALE[x] for x in LAYERS))
        assert {x: with_whole_body(t).layers[x] is t.layers[x] for x in LAYERS if x != CARRIER} == {
            x: True for x in LAYERS if x != CARRIER
        }


def test_traits_without_any_layer_stay_as_they_are(talker: dict[str, Traits]) -> None:
    from dataclasses import replace

    t = next(iter(talker.values()))
    none = replace(t.layers["arms"], names=(), first=np.zeros((0, 3)))
    bare = replace(t, layers=dict.fromkeys(LAYERS, none))
    assert with_whole_body(bare) is bare


@pytest.mark.nightly
def test_a_project_carries_the_whole_body_once_such_takes_are_accepted() -> None:
    made = named("standing talker").project
    assert not is_whole_body_carried(Project()) and not is_whole_body_carried(made)
    found = propose(made)
    assert not is_whole_body_carried(accept(made, found, clips=()).project)
    project = accept(made, found).project
    assert is_whole_body_carried(project) and not is_whole_body_carried(
        accept(named("few joints").project, propose(named("few joints").project)).project
    )
    assert {layer for layer in LAYERS if project.graphs[layer].stances} == {CARRIER}
    # Clips that come later are of that layer, too, few as they are.
    placed = list(project.uses)[-3:]
    from metagraph.graph import edits

    open_ = edits.remove_actions(
        project, [a.id for c in placed for a in project.uses[c] if a.kind != "stance"]
    )
    again = propose(open_)
    assert again.whole and {p.layer.value for p in again.proposals.values()} <= {CARRIER}


@pytest.mark.parametrize("name", ["few joints", "a hundred times too large"])
def test_clips_of_single_layers_that_tremble_all_over_are_not(name: str) -> None:
    project = named(name).project
    chance = np.random.default_rng(3)
    shaken = {}
    for key, entry in project.clips.items():
        clip = entry.motion
        assert clip is not None
        angles = chance.normal(0, np.radians(0.25), clip.rotations.shape[:2])
        axes = chance.normal(0, 1, (*angles.shape, 3))
        axes /= np.linalg.norm(axes, axis=-1, keepdims=True)
        turned = rotation.multiply(clip.rotations.astype(float), rotation.from_axis_angle(axes, angles))
        motion = Clip(clip.name, clip.skeleton, clip.fps, turned, clip.translations, clip.translated)
        shaken[key] = replace(entry, motion=motion)
    found = measure_all_traits(replace(project, clips=shaken))
    assert not are_whole_body_recordings(found)
    assert not are_whole_body_recordings(with_tremble(found))
