"""Proposals from names, motion and labels together; taken over they make a graph that is whole."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from metagraph.formats.store import open_project
from metagraph.graph import edits
from metagraph.graph.check import check
from metagraph.graph.model import LAYERS, Action, Project
from metagraph.suggest.propose import Proposals, accept, propose
from tests.projects import clip as still_clip

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def practice() -> Project:
    return open_project(ROOT / "sample_clips" / "practice.metagraph.yaml").project


@pytest.fixture(scope="module")
def truth(practice: Project) -> dict[str, tuple[Action, Project]]:
    """Clip id of the practice project -> its action in the finished one."""
    sample = open_project(ROOT / "sample_clips" / "sample.metagraph.yaml").project
    by_path = {sample.clips[a.clip].path: (a, sample) for a in sample.actions()}
    return {i: by_path[c.path] for i, c in practice.clips.items() if c.path in by_path}


def right(found: Proposals, truth: dict[str, tuple[Action, Project]], field: str) -> float:
    """Return the share of clips whose kind or layer was found."""
    hits = [getattr(found.proposals[i], field).value == getattr(action, field) for i, (action, _) in truth.items() if i in found.proposals]
    return sum(hits) / len(truth)


def names_of(found: Proposals, clip: str) -> tuple[str, str]:
    p = found.proposals[clip]
    return tuple(found.places[b.value].name if b is not None else "" for b in (p.stance, p.end_stance))  # type: ignore[return-value]


def test_an_empty_project_has_no_proposals() -> None:
    assert propose(Project()).proposals == {}
    assert accept(Project(), propose(Project())).placed == ()


def test_with_names_and_motion_the_practice_project_labels_itself(practice: Project, truth: Any) -> None:
    found = propose(practice)
    assert right(found, truth, "kind") >= 0.98 and right(found, truth, "layer") >= 0.98
    for ident, (action, sample) in truth.items():
        stance, end = names_of(found, ident)
        assert stance == sample.stance(action.stance).name  # type: ignore[union-attr]
        if action.end_stance is not None:
            assert end == sample.stance(action.end_stance).name  # type: ignore[union-attr]
    taken = accept(practice, found)
    assert not taken.left and len(taken.placed) == len(practice.clips)
    assert not [p for p in check(taken.project) if p.severity == "error"]
    assert sum(1 for _ in taken.project.actions()) == len(practice.clips)


def test_layers_begin_in_their_most_used_stance_and_the_base_pose_is_the_arms(practice: Project) -> None:
    bare = replace(practice, base=type(practice.base)())
    after = accept(bare, propose(bare)).project
    start = after.stance(after.graphs["arms"].start)
    assert start is not None and start.name == "hands at sides"
    assert after.base.clip is not None and after.clips[after.base.clip].name == "hands_at_sides__stance"
    again = accept(practice, propose(practice)).project
    assert again.base == practice.base


def test_names_alone_do_and_so_does_motion_alone(practice: Project, truth: Any) -> None:
    assert right(propose(practice, sources=("name",)), truth, "kind") >= 0.98
    found = propose(practice, sources=("motion",))
    assert right(found, truth, "kind") >= 0.9
    together: dict[str, set[str]] = {}
    for ident, (action, _) in truth.items():
        stance = found.proposals[ident].stance
        assert stance is not None
        together.setdefault(stance.value, set()).add(action.stance)
    assert all(len(stances) == 1 for stances in together.values())


def test_what_is_placed_is_not_proposed_again_and_teaches_the_rest(practice: Project, truth: Any) -> None:
    taken = accept(practice, propose(practice), clips=list(practice.clips)[:100])
    rest = propose(taken.project, sources=("learned", "motion"))
    assert set(rest.proposals) == set(practice.clips) - set(taken.placed)
    assert any("like '" in p.kind.reason for p in rest.proposals.values())


def test_a_name_that_lies_is_told_from_the_motion(practice: Project, truth: Any) -> None:
    transition = next(i for i, (a, _) in truth.items() if a.kind == "transition" and a.layer == "arms")
    loop = next(i for i, (a, _) in truth.items() if a.kind == "stance" and a.layer == "arms")
    clips = dict(practice.clips)
    clips[loop] = replace(clips[loop], name=practice.clips[transition].name)
    lying = replace(practice, clips=clips)
    p = propose(lying).proposals[loop]
    assert p.conflicts or p.confidence < 0.7
    assert propose(practice).proposals[loop].confidence > p.confidence


def test_only_what_is_sure_enough_is_taken_over_and_the_rest_says_why(practice: Project) -> None:
    found = propose(practice, sources=("motion",))
    sure = sorted(p.confidence for p in found.proposals.values())
    limit = sure[len(sure) // 2]
    taken = accept(practice, found, above=limit)
    assert 0 < len(taken.placed) < len(practice.clips)
    assert all("sure" in why or "no resting clip" in why for why in taken.left.values())
    assert found.doubtful[0].confidence == sure[0]


def test_clips_of_which_nothing_is_known_are_left_not_raised() -> None:
    project = edits.add_clips(Project(), [(f"{n}.glb", 0, "", still_clip(f"{n}", frames)) for n, frames in enumerate((1, 2, 31))])
    found = propose(project)
    taken = accept(project, found)
    assert set(taken.placed) | set(taken.left) == set(found.proposals) <= set(project.clips)


def test_a_gesture_without_a_loop_in_its_stance_is_left_with_the_reason(practice: Project, truth: Any) -> None:
    gestures = [i for i, (a, _) in truth.items() if a.kind == "gesture" and a.layer == "arms"][:6]
    found = propose(practice, gestures, sources=("name",))
    taken = accept(practice, found)
    assert not taken.placed and all("no resting clip shows its stance" in why for why in taken.left.values())
    assert taken.project.graphs == practice.graphs and set(LAYERS) == set(taken.project.graphs)
