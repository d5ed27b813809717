"""Proposals from names, motion and labels together; taken over they make a graph that is whole."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.formats.imports import import_files
from metagraph.formats.store import open_project
from metagraph.graph import edits
from metagraph.graph.check import check_project
from metagraph.graph.model import LAYERS, Action, Project
from metagraph.suggest.flags import is_unlikely, needs_look
from metagraph.suggest.propose import Proposals, accept, propose
from metagraph.suggest.review import Review
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
    hits = [
        getattr(found.proposals[i], field).value == getattr(action, field)
        for i, (action, _) in truth.items()
        if i in found.proposals
    ]
    return sum(hits) / len(truth)


def names_of(found: Proposals, clip: str) -> tuple[str, str]:
    p = found.proposals[clip]
    return tuple(found.places[b.value].name if b is not None else "" for b in (p.stance, p.end_stance))  # type: ignore[return-value]


def test_an_empty_project_has_no_proposals() -> None:
    assert propose(Project()).proposals == {}
    assert accept(Project(), propose(Project())).placed == ()


@pytest.mark.nightly
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
    assert not [p for p in check_project(taken.project) if p.severity == "error"]
    assert sum(1 for _ in taken.project.actions()) == len(practice.clips)


@pytest.mark.nightly
def test_layers_begin_in_their_most_used_stance_and_the_base_pose_is_the_arms(practice: Project) -> None:
    bare = replace(practice, base=type(practice.base)())
    after = accept(bare, propose(bare)).project
    start = after.stance(after.graphs["arms"].start)
    assert start is not None and start.name == "hands at sides"
    assert after.base.clip is not None and after.clips[after.base.clip].name == "hands_at_sides__stance"
    again = accept(practice, propose(practice)).project
    assert again.base == practice.base


@pytest.mark.nightly
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


@pytest.mark.nightly
def test_what_is_placed_is_not_proposed_again_and_teaches_the_rest(practice: Project, truth: Any) -> None:
    taken = accept(practice, propose(practice), clips=list(practice.clips)[:100])
    rest = propose(taken.project, sources=("learned", "motion"))
    assert set(rest.proposals) == set(practice.clips) - set(taken.placed)
    assert any("like '" in p.kind.reason for p in rest.proposals.values())


@pytest.mark.nightly
def test_a_name_that_lies_is_told_from_the_motion(practice: Project, truth: Any) -> None:
    transition = next(i for i, (a, _) in truth.items() if a.kind == "transition" and a.layer == "arms")
    loop = next(i for i, (a, _) in truth.items() if a.kind == "stance" and a.layer == "arms")
    clips = dict(practice.clips)
    clips[loop] = replace(clips[loop], name=practice.clips[transition].name)
    lying = replace(practice, clips=clips)
    p = propose(lying).proposals[loop]
    assert p.conflicts or p.confidence < 0.7
    assert propose(practice).proposals[loop].confidence > p.confidence


@pytest.mark.nightly
def test_only_what_is_sure_enough_is_taken_over_and_the_rest_says_why(practice: Project) -> None:
    found = propose(practice, sources=("motion",))
    sure = sorted(p.confidence for p in found.proposals.values())
    limit = sure[len(sure) // 2]
    taken = accept(practice, found, above=limit)
    assert 0 < len(taken.placed) < len(practice.clips)
    assert all("certain" in why or "no resting clip" in why for why in taken.left.values())
    assert found.doubtful[0].confidence == sure[0]


def test_clips_of_which_nothing_is_known_are_left_not_raised() -> None:
    project = edits.add_clips(
        Project(), [(f"{n}.glb", 0, "", still_clip(f"{n}", frames)) for n, frames in enumerate((1, 2, 31))]
    )
    found = propose(project)
    taken = accept(project, found)
    assert set(taken.placed) | set(taken.left) == set(found.proposals) <= set(project.clips)


def test_a_gesture_without_a_loop_in_its_stance_is_placed_and_the_stance_held_in_a_still_moment(
    practice: Project, truth: Any
) -> None:
    gestures = [i for i, (a, _) in truth.items() if a.kind == "gesture" and a.layer == "arms"][:6]
    found = propose(practice, gestures, sources=("name",))
    taken = accept(practice, found)
    assert set(taken.placed) == set(gestures) and not taken.left
    assert [p for p in check_project(taken.project) if p.severity == "error"] == []
    for stance, rest in taken.held.items():
        (loop,) = taken.project.graphs["arms"].of(stance, "stance")
        assert (
            loop.clip == rest.clip
            and loop.timing.loop
            and (loop.timing.start, loop.timing.end) == (rest.start, rest.end)
        )
        told = "the first frame of" if rest.start == rest.end else "holds still for its first"
        assert rest.reason.startswith("no clip rests there; ") and told in rest.reason


def test_a_clip_that_only_lends_a_stance_a_moment_still_waits_to_be_placed(
    practice: Project, truth: Any
) -> None:
    gestures = [i for i, (a, _) in truth.items() if a.kind == "gesture" and a.layer == "arms"][:6]
    taken = accept(practice, propose(practice, gestures, sources=("name",)))
    lending = {rest.clip for rest in taken.held.values()}
    twice = [a.id for a in taken.project.actions() if a.clip in lending and a.kind == "gesture"]
    assert lending <= set(propose(edits.remove_actions(taken.project, twice), sources=("name",)).proposals)


def test_without_motion_nothing_shows_a_stance_and_the_reason_is_told(practice: Project, truth: Any) -> None:
    gestures = [i for i, (a, _) in truth.items() if a.kind == "gesture" and a.layer == "arms"][:6]
    bare = replace(practice, clips={i: replace(c, motion=None) for i, c in practice.clips.items()})
    taken = accept(bare, propose(bare, gestures, sources=("name",)))
    assert not taken.placed and all("no resting clip shows its stance" in why for why in taken.left.values())
    assert taken.project.graphs == bare.graphs and set(LAYERS) == set(taken.project.graphs)


@pytest.mark.nightly
def test_transitions_that_are_accepted_unseen_end_in_the_right_stance(practice: Project, truth: Any) -> None:
    taken = accept(practice, propose(practice))
    count = 0
    for action in taken.project.actions():
        told, sample = truth[action.clip]
        if told.kind == "transition":
            count += 1
            assert action.kind == "transition"
            ends = [taken.project.stance(action.end_stance).name, sample.stance(told.end_stance).name]  # type: ignore[union-attr, arg-type]
            assert ends[0] == ends[1]
    assert count == 34


@pytest.mark.parametrize(("name", "count"), [("kaykit-rogue", 6), ("robot-expressive", 2)])
def test_so_they_do_on_sets_made_by_others(name: str, count: int) -> None:
    folder = ROOT.parent / "shared" / "data" / name
    if not folder.is_dir():
        pytest.skip(f"{folder} is not there")
    told = json.loads((ROOT / "tests" / "suggest" / "truth" / f"{name}.json").read_text("utf-8"))["clips"]
    project = import_files(Project(), None, [folder]).into(Project())
    taken = accept(project, propose(project))
    stances: dict[str, set[str]] = {}
    for action in taken.project.actions():
        row = told.get(project.clips[action.clip].name)
        if row and row["kind"] == action.kind == "transition":
            count -= 1
            stances.setdefault(str(action.end_stance), set()).add(row["end_stance"])
        if row and row["kind"] == action.kind == "stance":
            stances.setdefault(action.stance, set()).add(row["stance"])
    assert count == 0 and all(len(names) == 1 for names in stances.values())


@pytest.mark.nightly
def test_every_part_of_a_proposal_has_a_confidence_and_a_reason(practice: Project, truth: Any) -> None:
    found = propose(practice)
    usual = {"start", "end", "blend_in", "blend_out", "earliest_exit", "loop", "mask", "likelihood"}
    for p in found.proposals.values():
        assert set(p.details) == usual | ({"stroke"} if p.kind.value == "gesture" else set())
        assert all(0 < b.confidence < 1 and b.reason for b in p.details.values())
        assert p.timing.get("stroke") == (p.details["stroke"].value if "stroke" in p.details else None)


@pytest.mark.nightly
def test_numbered_variants_share_the_weight_of_one(practice: Project, truth: Any) -> None:
    found = propose(practice)
    mine = [
        p
        for p in found.proposals.values()
        if practice.clips[p.clip].name.startswith("head_straight__nod_single")
    ]
    assert len(mine) > 1 and all(p.details["likelihood"].value == round(1 / len(mine), 3) for p in mine)
    assert "the weight of one" in mine[0].details["likelihood"].reason
    taken = accept(practice, found, clips=[p.clip for p in found.proposals.values()])
    (action,) = (a for a in taken.project.actions() if a.clip == mine[0].clip)
    assert action.likelihood == mine[0].details["likelihood"].value
    assert sum(
        a.likelihood for a in taken.project.actions() if a.clip in {p.clip for p in mine}
    ) == pytest.approx(1, abs=0.01)
    later = propose(edits.remove_actions(taken.project, [action.id]))
    assert later.proposals[action.clip].details["likelihood"].value == action.likelihood


def test_a_clip_that_nothing_says_the_stance_of_goes_where_most_are(practice: Project, truth: Any) -> None:
    found = propose(practice, ["c1"], sources=("name",))
    clips = {**practice.clips, "c1": replace(practice.clips["c1"], name="waving")}
    lost = propose(replace(practice, clips=clips), ["c1"], sources=("name",)).proposals["c1"]
    assert (
        lost.stance is not None
        and lost.stance.confidence == 0.4
        and "no stance is named" in lost.stance.reason
    )
    assert found.proposals["c1"].stance.confidence > 0.5  # type: ignore[union-attr]


@pytest.mark.nightly
def test_walks_and_fights_are_left_aside_with_a_word() -> None:
    folder = ROOT.parent / "shared" / "data" / "kaykit-rogue"
    if not folder.is_dir():
        pytest.skip(f"{folder} is not there")
    project = import_files(Project(), None, [folder]).into(Project())
    names = {entry.name: clip for clip, entry in project.clips.items()}
    walks = [names[f"Walking_{x}"] for x in "ABC"]
    found = propose(project)
    assert {found.aside[clip] for clip in walks} == {"name says 'Walking'"}
    assert found.proposals[names["Interact"]].kind.value == "gesture"
    unnamed = propose(project, sources=("motion",))
    assert all(unnamed.aside[clip].startswith("walks or runs: its feet pass") for clip in walks)
    assert not set(walks) & set(accept(project, found).placed)


def test_a_clip_called_after_a_stance_alone_that_comes_from_elsewhere_leads_there():
    from metagraph.suggest.estimate import Belief
    from metagraph.suggest.motion_guess import MotionGuess
    from metagraph.suggest.propose import _leading
    from metagraph.suggest.words.names import NameGuess

    said = NameGuess(kind=Belief("stance", 0.7, "x"), stance=Belief("sitting", 0.9, "name says 'Sitting'"))

    def motion(kind, sure):
        return MotionGuess(
            Belief(kind, sure, ""), Belief("body", 1, ""), Belief("both", 1, ""), Belief(False, 1, "")
        )

    led = _leading(said, motion("transition", 0.86))
    assert (led.kind, led.stance, led.end_stance.value) == (None, None, "sitting")
    assert "Sitting" in led.end_stance.reason
    assert _leading(said, motion("transition", 0.6)) is said
    assert _leading(said, motion("gesture", 0.9)) is said
    assert _leading(said, None) is said
    gesture = NameGuess(kind=Belief("gesture", 0.7, "x"), stance=said.stance)
    assert _leading(gesture, motion("transition", 0.9)) is gesture


def test_a_robot_nobody_made_here_sits_where_its_clip_of_sitting_ends(shared_data):
    project = import_files(Project(), None, [shared_data / "robot-expressive"]).into(Project())
    found = propose(project)
    names = {project.clips[c].name: p for c, p in found.proposals.items()}
    ends = {
        name: found.places[p.end_stance.value].name for name, p in names.items() if p.end_stance is not None
    }
    assert ends["Sitting"] == "sitting" and ends["Standing"] == "standing"


def test_who_stands_and_talks_hardly_ever_lies_down(shared_data):
    project = import_files(Project(), None, [shared_data / "kaykit-rogue"]).into(Project())
    found = propose(project)
    likely = {project.clips[c].name: p.details["likelihood"] for c, p in found.proposals.items()}
    assert likely["Lie_Down"].value < 0.05 and "lies down" in likely["Lie_Down"].reason
    assert likely["Sit_Chair_Down"].value == likely["Lie_StandUp"].value == 1.0


def test_a_transition_that_travels_to_where_no_other_clip_plays_is_skipped_not_slid_back(toy: Any) -> None:
    def away(name: str, metres: float, end: float) -> Any:
        clip = toy.clip(name, 2.0, 0.0, end, swing=0.0)
        places = clip.translations.copy()
        places[:, 0, 2] += metres * np.linspace(0, 1, clip.frames)
        return replace(clip, translations=places)

    clips = [toy.clip("rest idle", 3.0, swing=0.05), toy.clip("up idle", 3.0, 1.2, swing=0.05)]
    clips += [toy.clip(f"rest {name}", 1.0) for name in ("wave", "beat", "point")]
    clips += [
        away("rest to leave", 2.6, 2.4),
        away("rest to up", 0.0, 1.2),
        toy.clip("up to rest", 1.0, 1.2, 0.0),
    ]
    project = edits.add_clips(Project(), [(f"{c.name}.glb", 0, "", c) for c in clips])
    ids = {entry.name: clip for clip, entry in project.clips.items()}
    found = propose(project)
    assert list(found.aside) == [ids["rest to leave"]] == list(found.spare)
    assert "travels 2.6 m" in found.aside[ids["rest to leave"]]
    assert found.proposals[ids["rest to up"]].kind.value == "transition"
    assert not any("leave" in place.name for place in found.places.values())


def test_a_clip_of_a_face_that_moves_is_no_stance(toy: Any) -> None:
    clips = [toy.clip("idle", 3.0, swing=0.0), *(toy.clip(f"idle {n}", 1.0) for n in ("wave", "beat"))]
    still = toy.clip("head idle", 1.0, swing=0.0)
    weights = np.linspace(0.0, 1.0, still.frames)[:, None]
    clips.append(replace(still, morphs=("jawOpen",), weights=weights))
    project = edits.add_clips(Project(), [(f"{c.name}.glb", 0, "", c) for c in clips])
    ids = {entry.name: clip for clip, entry in project.clips.items()}
    found = propose(project)
    face = found.proposals.get(ids["head idle"])
    assert face is None or face.kind.value != "stance"
    assert found.proposals[ids["idle"]].kind.value == "stance"


def astray_project(toy: Any, up: int) -> tuple[Project, dict[str, str]]:
    """Return a project of two stances, with three gestures in the first and so many in the second, and a wave
    that was cut while the arm is between them.
    """
    clips = [toy.clip("hush", 3.0, swing=0.05), toy.clip("tall", 3.0, 2.4, swing=0.05)]
    clips += [toy.clip(f"low {n}", 1.0) for n in range(3)]
    clips += [toy.clip(f"high {n}", 1.0, 2.4) for n in range(up)]
    clips.append(toy.clip("wave", 1.0, 1.2))
    project = edits.add_clips(Project(), [(f"{c.name}.glb", 0, "", c) for c in clips])
    return project, {entry.name: clip for clip, entry in project.clips.items()}


def test_a_clip_that_begins_far_from_every_stance_goes_where_most_clips_are_and_needs_a_look(
    toy: Any,
) -> None:
    project, ids = astray_project(toy, 0)
    found = propose(project, sources=("motion",))
    wave, low = found.proposals[ids["wave"]], found.proposals[ids["low 0"]]
    assert wave.stance is not None and low.stance is not None and wave.stance.value == low.stance.value
    assert "from every stance; most clips are in this one" in wave.stance.reason
    assert needs_look(wave) and not is_unlikely(wave)
    assert ids["wave"] not in accept(project, found).left


def test_where_no_stance_is_likely_a_clip_is_not_placed_until_somebody_says_so(toy: Any) -> None:
    project, ids = astray_project(toy, 3)
    found = propose(project, sources=("motion",))
    wave = ids["wave"]
    assert is_unlikely(found.proposals[wave])
    taken = accept(project, found)
    assert "no stance is likely: begins" in taken.left[wave] and not taken.project.uses.get(wave)
    assert Review(found).take(project, [wave]).project.uses[wave], "who chooses the clip itself means it"
