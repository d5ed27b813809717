"""What a character does by itself in an hour, counted."""

from __future__ import annotations

from dataclasses import replace

import pytest

from metagraph.graph import edits
from metagraph.graph.model import MODES, Project
from metagraph.playback.behaviour import (
    LATER,
    BehaviourCount,
    describe_lack,
    measure_behaviour,
    measure_repeated_share,
)
from metagraph.playback.planning.running_plan import improvise
from metagraph.research.exhibits.paper_planner import plan_as_in_paper

SECONDS = 1200.0


def value(of: BehaviourCount, name: str) -> float:
    return next(row.value for row in of.rows if row.name.startswith(name))


@pytest.fixture(scope="module")
def counted(sample: Project) -> dict[str, BehaviourCount]:
    return {mode: measure_behaviour(sample, mode, SECONDS) for mode in MODES}


def test_nobody_gestures_or_nods_to_nobody(counted: dict[str, BehaviourCount]) -> None:
    assert value(counted["idle"], "Gestures") == value(counted["idle"], "Nods") == 0
    assert value(counted["idle"], "Fidgets") > 2 and value(counted["idle"], "Changes of stance") > 1
    assert value(counted["talking"], "Gestures") > 3 and value(counted["listening"], "Nods") > 3
    assert value(counted["listening"], "Gestures") < 0.2 * value(counted["talking"], "Gestures")


def test_acts_of_the_arms_seldom_come_again_at_once(counted: dict[str, BehaviourCount]) -> None:
    for mode, most in (("idle", 0.3), ("listening", 0.3), ("talking", 0.3)):
        assert value(counted[mode], "The same act of the arms again within 30 s") <= 0.05
        assert value(counted[mode], "The same act of the arms again within 5 minutes") <= most


def test_stances_are_kept_rests_spread_and_the_head_is_mostly_straight(
    counted: dict[str, BehaviourCount],
) -> None:
    for mode in MODES:
        assert value(counted[mode], "Changes of stance undone") == 0
        assert value(counted[mode], "Head tilted") < 0.45
        assert value(counted[mode], "Spread of the time between acts") > 0.6
    assert 5 < value(counted["idle"], "Half of the rests of the arms") < 30


def test_eyes_do_as_peoples_do(counted: dict[str, BehaviourCount]) -> None:
    for mode in MODES:
        compared = [row for row in counted[mode].rows if row.source is not None]
        assert compared and all(row.usual for row in compared), [(r.name, r.value) for r in compared]


def test_without_variety_all_of_it_is_plan_as_in_paper(sample: Project) -> None:
    found = measure_behaviour(plan_as_in_paper(sample), "idle", SECONDS)
    assert value(found, "Gestures") > 3
    assert value(found, "The same act of the arms again within 5 minutes") > 0.5


def test_a_repetition_is_counted_within_its_time_alone(sample: Project) -> None:
    cue = improvise(sample, 120.0).layers["arms"].cues[0]
    at = [replace(cue, start=t) for t in (0.0, 20.0, 60.0, 400.0)]
    assert measure_repeated_share(at, 30.0) == 0.25 and measure_repeated_share(at, 50.0) == 0.5
    assert measure_repeated_share([], LATER) == 0.0


def test_a_stance_lacks_as_many_actions_as_would_end_the_repetition(sample: Project) -> None:
    """Of all stances' gestures all but one are taken away; what is missed then names the stance."""
    arms = sample.graphs["arms"]
    poor = edits.remove_actions(
        sample, [a.id for stance in arms.stances for a in arms.of(stance, "gesture")[1:]]
    )
    found = [x for x in measure_behaviour(poor, "talking", SECONDS).lacks if x.stance == arms.start]
    assert found and found[0].have == 1 and found[0].more >= 1
    assert "'hands at sides' would end the repetition; it has 1" in describe_lack(poor, found[0])


def test_an_empty_project_does_nothing_and_has_no_head_to_speak_of() -> None:
    found = measure_behaviour(Project(), "idle", 60.0)
    assert not any("head" in row.name.lower() for row in found.rows)
    assert value(found, "Fidgets") == 0 and found.lacks == ()
