"""Going through proposals: what is said stays said, stances come first, and what a clip needs comes along."""

from __future__ import annotations

from pathlib import Path

import pytest

from metagraph.formats.store import open_project
from metagraph.graph import edits
from metagraph.graph.model import Project
from metagraph.suggest.estimate import Belief
from metagraph.suggest.flags import estimate_gain
from metagraph.suggest.proposal import Proposal, Proposals, StancePlace
from metagraph.suggest.propose import propose
from metagraph.suggest.review import PAUSE, SAID, USUAL, Review, ReviewPace

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def practice() -> Project:
    return open_project(ROOT / "sample_clips" / "practice.metagraph.yaml").project


@pytest.fixture(scope="module")
def found(practice: Project) -> Proposals:
    return propose(practice)


def clip(project: Project, name: str) -> str:
    return next(c for c, e in project.clips.items() if e.name == name)


def sure(value, confidence: float = 0.9):  # type: ignore[no-untyped-def]
    return Belief(value, confidence, "told")


def test_nothing_to_review_has_no_order() -> None:
    review = Review(Proposals({}, {}))
    assert review.order() == [] and review.take(Project(), ["gone"]).placed == ()


def test_stances_come_first_the_most_used_before_the_others_then_where_a_look_gains_most(
    practice: Project, found: Proposals
) -> None:
    order = [found.proposals[c] for c in Review(found).order()]
    kinds = [p.kind.value == "stance" for p in order]
    assert kinds == sorted(kinds, reverse=True)
    assert practice.clips[order[0].clip].name == "hands_at_sides__stance"
    gains = [estimate_gain(p) for p in order if p.kind.value != "stance"]
    assert gains == sorted(gains, reverse=True)


def test_what_is_said_is_certain_and_ends_the_dispute(practice: Project, found: Proposals) -> None:
    wave = clip(practice, "hands_at_sides__point_you_rt_01")
    review = Review(found).tell(wave, "kind", "fidget").tell(wave, "limb", "left")
    p = review.found.proposals[wave]
    assert (p.kind.value, p.kind.confidence, p.kind.reason) == ("fidget", 1.0, SAID)
    assert p.limb.value == "left" and p.conflicts == ()
    assert found.proposals[wave].kind.value == "gesture"  # nothing was changed in place


def test_a_transition_ends_nowhere_until_that_is_said(practice: Project, found: Proposals) -> None:
    wave = clip(practice, "hands_at_sides__point_you_rt_01")
    review = Review(found).tell(wave, "kind", "transition")
    assert review.doubtful(wave) == "end_stance" and review.value(wave, "end_stance") is None
    taken = review.take(practice, [wave])
    assert taken.placed == () or wave not in taken.placed
    review = review.tell(wave, "end_stance", "on hips")
    assert review.value(wave, "end_stance") == "on hips"
    assert wave in review.take(practice, [wave]).placed


def test_a_stance_nobody_spoke_of_is_made_when_a_resting_clip_is_placed_in_it(
    practice: Project, found: Proposals
) -> None:
    rest = clip(practice, "on_hips__stance")
    review = Review(found).tell(rest, "stance", "akimbo")
    assert ("akimbo", "akimbo") in review.choices(rest, "stance")
    taken = review.take(practice, [rest])
    assert taken.placed == (rest,) and [s.name for s in taken.project.graphs["arms"].stances.values()] == [
        "akimbo"
    ]


def test_another_layer_has_other_stances(practice: Project, found: Proposals) -> None:
    wave = clip(practice, "hands_at_sides__point_you_rt_01")
    review = Review(found).tell(wave, "stance", "on hips").tell(wave, "layer", "head")
    assert review.found.places[review.found.proposals[wave].stance.value].layer == "head"
    assert review.choices(wave, "limb") == []  # only arms have sides
    assert review.tell(wave, "layer", "arms").choices(wave, "limb")


def test_a_gesture_brings_the_clip_that_rests_in_its_stance(practice: Project, found: Proposals) -> None:
    beat = clip(practice, "arms_crossed__beat_small_rt_01")
    taken = Review(found).take(practice, [beat])
    assert set(taken.placed) == {beat, clip(practice, "arms_crossed__stance")}


def test_a_stance_of_another_layer_shows_one_of_the_same_name(practice: Project, found: Proposals) -> None:
    rest, beat = clip(practice, "arms_crossed__stance"), clip(practice, "arms_crossed__beat_small_rt_01")
    review = Review(found).tell(rest, "layer", "body").tell(rest, "stance", "arms crossed")
    project = review.take(practice, [rest]).project
    taken = review.settled(project).take(project, [beat])
    assert beat in taken.placed and taken.project.graphs["arms"].stances


def test_stances_made_meanwhile_are_the_projects(practice: Project, found: Proposals) -> None:
    rest, beat = clip(practice, "arms_crossed__stance"), clip(practice, "arms_crossed__beat_small_rt_01")
    review = Review(found)
    project = review.take(practice, [rest]).project
    project = review.settled(project).take(project, [beat]).project
    assert [s.name for s in project.graphs["arms"].stances.values()] == ["arms crossed"]
    # And when that is taken back, it is made again.
    again = review.settled(project).settled(practice).take(practice, [beat])
    assert [s.name for s in again.project.graphs["arms"].stances.values()] == ["arms crossed"]


def test_ids_that_come_again_after_undo_are_not_taken_for_what_they_were(
    practice: Project, found: Proposals
) -> None:
    arms, body = clip(practice, "arms_crossed__stance"), clip(practice, "body_weight_both__stance")
    review = Review(found)
    review = review.settled(review.take(practice, [arms]).project).settled(practice)
    project = review.take(practice, [body]).project
    review = review.settled(project)
    assert review.value(arms, "stance") == "arms crossed" and review.value(body, "stance") == "weight both"


def test_a_renamed_stance_is_the_same_stance(practice: Project, found: Proposals) -> None:
    rest, beat = clip(practice, "arms_crossed__stance"), clip(practice, "arms_crossed__beat_small_rt_01")
    project = Review(found).take(practice, [rest]).project
    review = Review(found).settled(project)
    project = edits.rename_stance(project, next(iter(project.graphs["arms"].stances)), "folded")
    assert review.settled(project).value(beat, "stance") == "folded"


def test_what_was_said_outlives_proposals_made_anew(practice: Project, found: Proposals) -> None:
    wave = clip(practice, "hands_at_sides__point_you_rt_01")
    review = Review(found).tell(wave, "stance", "on hips").tell(wave, "tags", ("hello",))
    other = {wave: found.proposals[wave]}
    anew = review.anew(Proposals(other, found.places))
    assert anew.value(wave, "stance") == "on hips" and anew.found.proposals[wave].tags.value == ("hello",)
    assert set(anew.found.proposals) == set(found.proposals)  # the others are as they were


def test_a_placed_clip_is_placed_anew_and_nothing_is_lost_when_it_cannot_be(
    practice: Project, found: Proposals
) -> None:
    wave = clip(practice, "hands_at_sides__point_you_rt_01")
    review = Review(found)
    project = review.take(practice, [wave]).project
    moved = review.tell(wave, "kind", "fidget").settled(project).take(project, [wave]).project
    assert [a.kind for a in moved.uses[wave]] == ["fidget"]
    stuck = review.tell(wave, "kind", "transition").settled(project).take(project, [wave])
    assert stuck.project is project and wave in stuck.left


def test_times_that_are_said_are_added_to_those_proposed(practice: Project, found: Proposals) -> None:
    wave = clip(practice, "hands_at_sides__point_you_rt_01")
    review = Review(found).tell(wave, "timing", {"start": 0.2}).tell(wave, "timing", {"end": 1.0})
    action = review.take(practice, [wave]).project.uses[wave][0]
    assert (action.timing.start, action.timing.end) == (0.2, 1.0)


def test_what_is_something_else_has_other_times(practice: Project, found: Proposals) -> None:
    wave = clip(practice, "hands_at_sides__point_you_rt_01")
    review = Review(found).tell(wave, "timing", {"start": 0.3}).tell(wave, "kind", "stance")
    assert review.found.proposals[wave].timing == {"start": 0.3}  # the gesture's own are gone
    timed = review.timed(practice, wave)
    assert timed.timing["loop"] and timed.timing["start"] == 0.3
    assert review.with_times(timed).found.proposals[wave].timing == timed.timing
    again = review.tell(wave, "kind", "fidget")
    assert again.with_times(timed) is again  # it is something else by now


def test_what_is_not_known_is_looked_at_first() -> None:
    p = Proposal("c", sure("gesture"), sure("arms"), None, None, sure("both"))
    review = Review(Proposals({"c": p}, {"s": StancePlace("s", "arms", "rest", True)}))
    assert review.doubtful("c") == "stance" and review.choices("c", "stance") == [("rest", "rest")]


def test_a_refused_placing_tells_why() -> None:
    project = edits.rename_project(Project(), "empty")
    p = Proposal("c", sure("gesture"), sure("arms"), None, None, sure("both"))
    assert Review(Proposals({"c": p}, {})).take(project, ["c"]).placed == ()


def test_the_time_left_is_taken_from_the_last_decisions_without_the_pauses() -> None:
    pace = ReviewPace()
    assert pace.left(10) == 10 * USUAL and not pace.known
    for seconds in (1.0, 2.0, PAUSE + 1, 3.0):
        pace.decided(seconds)
    assert pace.known and pace.left(10) == 20.0
