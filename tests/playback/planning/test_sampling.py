"""From meta actions to clips: candidates, the paper's three temporal cases, the draw, chains of
transitions.
"""

from __future__ import annotations

import itertools
import sys
from collections import Counter
from collections.abc import Callable, Mapping
from typing import Any

import pytest

from metagraph.graph import edits
from metagraph.graph.model import Project
from metagraph.playback.life.track import Track
from metagraph.playback.plan import LayerPlan, MetaAction, MetaRequest, Plan
from metagraph.playback.planner import make_plan
from metagraph.playback.planning import drawing
from metagraph.playback.planning.layer_state import LayerState
from metagraph.playback.planning.mood import Moods
from metagraph.playback.planning.running_plan import improvise
from metagraph.playback.planning.sampling import perform_metas


@pytest.fixture
def project(toy: Any) -> Project:
    return toy.project()


def arms(
    project: Project, *requests: MetaRequest, end: float = 30.0, seed: int = 1, stance: str | None = None
) -> tuple[LayerPlan, Plan]:
    plan = make_plan(project, end, requests, seed, {"arms": stance} if stance else None, idle=False)
    return plan.layers["arms"], plan


def names(plan: LayerPlan) -> list[str]:
    return [cue.action.name for cue in plan.cues]


def outcomes(plan: Plan) -> dict[str, str]:
    return {r.request: r.outcome for r in plan.reports}


def ask(
    ident: str, start: float, duration: float | None = None, kind: Any = "gesture", **more: Any
) -> MetaRequest:
    return MetaRequest(ident, "arms", kind, start, duration, **more)


def lengths(project: Project, toy: Any, **seconds: float) -> Project:
    """Give actions other lengths, by cutting their ends."""
    for name, length in seconds.items():
        project = edits.update_actions(
            project, [toy.id(project, name.replace("_", " "))], timing={"end": length}
        )
    return project


# --- who may play


def test_candidates_are_of_the_kind_and_the_stance(project: Project, toy: Any) -> None:
    seen = {names(arms(project, ask(f"r{n}", 0))[0])[0] for n in range(60)}
    assert seen == {"rest short", "rest beat lf", "rest wave rt", "rest long"}
    assert {names(arms(project, ask(f"r{n}", 0, kind="fidget"))[0])[0] for n in range(30)} == {
        "rest scratch",
        "rest cough",
    }
    up = toy.id(project, "up")
    assert {names(arms(project, ask(f"r{n}", 0), stance=up)[0])[0] for n in range(30)} == {
        "up beat",
        "up point",
    }


def test_tags_must_all_be_there_and_the_limb_must_be_the_one(project: Project, toy: Any) -> None:
    project = edits.update_actions(
        project, [toy.id(project, "rest short"), toy.id(project, "rest long")], tags=("positive", "small")
    )
    project = edits.update_actions(project, [toy.id(project, "rest long")], tags=("positive", "big"))
    for n in range(20):
        assert names(arms(project, ask(f"r{n}", 0, tags=("positive", "big")))[0]) == ["rest long"]
        assert names(arms(project, ask(f"r{n}", 0, limb="left"))[0]) == ["rest beat lf"]
        assert names(arms(project, ask(f"r{n}", 0, limb="both", tags=("small",)))[0]) == ["rest short"]


def test_what_is_not_there_is_reported_with_where_there_is_one(project: Project, toy: Any) -> None:
    project = edits.update_actions(project, [toy.id(project, "up beat")], tags=("rare",))
    plan, whole = arms(project, ask("r", 1, tags=("rare",)))
    assert not plan.cues and whole.reports[0].outcome == "no-candidate"
    words = whole.reports[0].message
    assert all(piece in words for piece in ("'rest'", "rare gesture", "'up'"))
    words = arms(project, ask("r", 1, tags=("none",)))[1].reports[0].message
    assert "'rest'" in words and "none gesture" in words and "'up'" not in words
    words = arms(project, ask("r", 1, limb="right", kind="fidget"))[1].reports[0].message
    assert "'rest'" in words and "right fidget" in words
    made, told = arms(project, ask("r", 1, limb="right", kind="fidget"))
    assert [c.action.kind for c in made.cues] == ["fidget"] and told.reports[0].played


def test_an_action_of_no_likelihood_is_never_drawn_but_may_be_asked_for(project: Project, toy: Any) -> None:
    ident = toy.id(project, "rest scratch")
    project = edits.update_actions(project, [ident], likelihood=0.0)
    assert {names(arms(project, ask(f"r{n}", 0, kind="fidget"))[0])[0] for n in range(30)} == {"rest cough"}
    assert names(arms(project, ask("r", 0, kind="fidget", action=ident))[0]) == ["rest scratch"]


# --- the draw


def test_the_chance_is_likelihood_over_uses(
    project: Project, toy: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    project = edits.update_actions(project, [toy.id(project, "rest long")], likelihood=2.5)
    project = edits.set_settings(project, never_twice=False, variety=0.0)
    drawn: list[tuple[Mapping[str, float], str]] = []
    choose = drawing.pick

    def watch(seed: int, key: str, purpose: str, weights: Mapping[str, float]) -> str:
        chosen = choose(seed, key, purpose, weights)
        if purpose == "action":
            drawn.append((dict(weights), chosen))
        return chosen

    monkeypatch.setattr(drawing, "pick", watch)
    arms(project, *(ask(f"r{n}", n * 3.0) for n in range(60)), end=200)
    assert len(drawn) == 60
    uses: Counter[str] = Counter()
    for weights, chosen in drawn:
        for ident, weight in weights.items():
            action = project.action(ident)
            assert weight == action.likelihood / max(4 * uses[ident], 1)  # alpha = 4
        uses[chosen] += 1
    assert len(uses) == 4


@pytest.mark.parametrize(("alpha", "spread"), [(0.0, None), (4.0, 6)])
def test_counting_uses_evens_them_out(project: Project, alpha: float, spread: int | None) -> None:
    project = edits.set_settings(project, alpha=alpha, never_twice=False, variety=0.0)
    counts = Counter(names(arms(project, *(ask(f"r{n}", n * 3.0) for n in range(100)), end=400)[0]))
    assert sum(counts.values()) == 100
    if spread is not None:
        assert max(counts.values()) - min(counts.values()) <= spread


def test_nothing_plays_twice_in_a_row_where_there_is_a_choice(project: Project) -> None:
    for seed in range(10):
        played = names(arms(project, *(ask(f"r{n}", n * 3.0) for n in range(40)), end=200, seed=seed)[0])
        assert len(played) == 40 and all(a != b for a, b in itertools.pairwise(played))


def test_where_there_is_no_choice_it_plays_again(project: Project) -> None:
    assert (
        names(arms(project, *(ask(f"r{n}", n * 3.0, limb="left") for n in range(3)))[0])
        == ["rest beat lf"] * 3
    )


def test_other_requests_do_not_reshuffle_a_draw(project: Project) -> None:
    alone = names(arms(project, ask("z", 20), end=40)[0])
    for n in range(20):
        others = [ask(f"o{n}{k}", k * 3.0, kind="fidget") for k in range(4)]
        assert names(arms(project, *others, ask("z", 20), end=40)[0])[-1:] == alone


# --- figure 7


def test_case_1_an_action_that_ends_early_leaves_the_rest_to_the_stance(project: Project) -> None:
    plan, whole = arms(project, ask("a", 1, 6), ask("b", 8))
    assert (
        len(plan.cues) == 2 and plan.cues[0].start == 1 and plan.cues[0].end < 7 and plan.cues[1].start == 8
    )
    assert whole.reports == ()
    assert plan.cue_at(7.5) is None and plan.stance_at(7.5) == plan.rests[0].stance


def test_case_2_only_what_fits_before_something_more_important_is_drawn(project: Project) -> None:
    for n in range(40):
        plan, _ = arms(project, ask(f"a{n}", 1, 1), ask("king", 2, priority=2))
        assert names(plan)[0] in ("rest short", "rest beat lf") and plan.cues[1].start == 2


def test_case_2_where_nothing_fits_the_meta_action_is_discarded_and_reported(project: Project) -> None:
    plan, whole = arms(project, ask("a", 1, 0.5), ask("king", 1.5, priority=2))
    assert [c.meta for c in plan.cues] == ["king"] and outcomes(whole) == {"a": "no-room"}
    assert "0.50 s" in whole.reports[0].message


def test_case_3_what_the_clip_covers_wholly_is_discarded_and_reported(project: Project, toy: Any) -> None:
    long = ask("a", 1, 1, action=toy.id(project, "rest long"))
    plan, whole = arms(project, long, ask("b", 2.1, 1), ask("c", 3.2, 1))
    assert [c.meta for c in plan.cues] == ["a", "c"] and outcomes(whole) == {"b": "covered", "c": "queued"}
    assert plan.cues[1].start == pytest.approx(3.4), "planning goes on at the clip's end"
    assert "'rest long'" in whole.reports[0].message


def test_a_request_of_no_duration_plays_one_action(project: Project) -> None:
    plan, whole = arms(project, ask("a", 0, 0), ask("b", 5, 0))
    assert [c.meta for c in plan.cues] == ["a", "b"] and whole.reports == ()


# --- timing of a cue


def test_an_action_may_be_left_at_its_earliest_exit_where_something_waits(project: Project, toy: Any) -> None:
    ident = toy.id(project, "rest long")
    project = edits.update_actions(project, [ident], timing={"earliest_exit": 0.7, "blend_out": 0.2})
    one = ask("a", 1, 0.5, action=ident)
    assert arms(project, one)[0].cues[0].end == pytest.approx(1 + 2.4), "nothing waits: it plays through"
    assert arms(project, one, ask("b", 1.5))[0].cues[0].end == pytest.approx(1 + 0.9), "exit and blend out"
    assert arms(project, one, ask("b", 3.0))[0].cues[0].end == pytest.approx(3.0), "as long as there is time"
    early = arms(project, one, ask("king", 1.95, priority=3))[0]
    assert early.cues[0].end <= 1.95 and early.cues[1].start == 1.95


def test_blends_are_squeezed_to_fit(project: Project, toy: Any) -> None:
    ident = toy.id(project, "rest short")
    project = edits.update_actions(project, [ident], timing={"blend_in": 0.6, "blend_out": 0.3})
    [cue] = arms(project, ask("a", 1, action=ident))[0].cues
    assert (cue.blend_in, cue.blend_out) == (
        pytest.approx(0.4),
        pytest.approx(0.2),
    ) and cue.end - cue.start == pytest.approx(0.6)
    project = edits.update_actions(project, [ident], timing={"blend_in": -1.0, "blend_out": 0.0})
    assert arms(project, ask("a", 1, action=ident))[0].cues[0].blend_in == 0


def test_a_clip_of_one_frame_neither_hangs_nor_breaks_the_plan(project: Project, toy: Any) -> None:
    ident = toy.id(project, "rest short")
    project = edits.update_actions(project, [ident], timing={"start": 0.3, "end": 0.3})
    plan, _ = arms(project, *(ask(f"r{n}", n * 1.0, action=ident) for n in range(3)))
    assert [c.start for c in plan.cues] == [c.end for c in plan.cues] == [0, 1, 2]


# --- going to stances


def test_an_action_of_another_stance_brings_the_transitions_along(project: Project, toy: Any) -> None:
    project = edits.place_clips(
        project, [next(iter(project.clips))], "arms", "gesture", toy.id(project, "far")
    )
    ident = [*project.actions()][-1].id
    plan, whole = arms(project, ask("a", 1, action=ident))
    assert names(plan) == ["rest to up", "up to far", "rest loop"] and whole.reports == ()
    assert {c.meta for c in plan.cues} == {"a"}
    assert all(
        a.end == b.start and a.then == b.stance for a, b in zip(plan.cues, plan.cues[1:], strict=False)
    )
    assert plan.stance_at(29) == toy.id(project, "far")


def test_a_stance_can_be_asked_for_and_is_reached_by_the_shortest_chain(project: Project, toy: Any) -> None:
    far = toy.id(project, "far")
    for kind in ("transition", "stance"):
        plan, _ = arms(project, ask("a", 1, kind=kind, stance=far))
        assert names(plan) == ["rest to up", "up to far"] and plan.rests[-1].stance == far
    loop = ask("a", 1, kind="stance", action=toy.id(project, "far loop"))
    assert names(arms(project, loop)[0]) == ["rest to up", "up to far"]


def test_a_stance_the_layer_is_in_already_needs_nothing_and_says_so(project: Project, toy: Any) -> None:
    plan, whole = arms(project, ask("a", 1, kind="transition", stance=toy.id(project, "rest")))
    assert not plan.cues and outcomes(whole) == {"a": "already-there"} and whole.reports[0].played


def test_any_transition_may_be_asked_for(project: Project, toy: Any) -> None:
    plan, _ = arms(
        project, ask("a", 1, kind="transition"), ask("b", 5, kind="transition"), stance=toy.id(project, "up")
    )
    assert names(plan)[0] in ("up to rest", "up to far") and plan.cues[1].stance == plan.cues[0].then


def test_the_rest_after_a_transition_is_the_new_stances_loop_from_its_beginning(
    project: Project, toy: Any
) -> None:
    plan, _ = arms(project, ask("a", 1, kind="transition", stance=toy.id(project, "up")))
    [cue], rest = plan.cues, plan.rests[-1]
    assert rest.action.name == "up loop" and rest.start == pytest.approx(cue.end - cue.blend_out)
    assert cue.start + cue.blend_in <= rest.fade_start and rest.fade_start + rest.fade <= cue.end


# --- what cannot be done is reported


def test_impossible_requests_are_reported_with_their_reason(project: Project, toy: Any) -> None:
    one_way = edits.remove_actions(project, [toy.id(project, "up to far")])
    no_loop = edits.remove_actions(project, [toy.id(project, "far loop")])
    nowhere = edits.update_actions(project, [toy.id(project, "rest to up")], end_stance="s999")
    far, up = toy.id(project, "far"), toy.id(project, "up")
    cases = [
        (
            project,
            ask("r", 1, action="a999"),
            "unknown-action",
            "there is no action 'a999' in the arms layer",
        ),
        (
            project,
            ask("r", 1, kind="transition", stance="s999"),
            "no-stance",
            "there is no stance 's999' in the arms layer",
        ),
        (
            one_way,
            ask("r", 1, kind="transition", stance=far),
            "no-way",
            "no chain of transitions leads from 'rest' to 'far'",
        ),
        (
            one_way,
            ask("r", 1, action=toy.id(project, "far to up")),
            "no-way",
            "no chain of transitions leads from 'rest' to 'far'",
        ),
        (
            no_loop,
            ask("r", 1, kind="transition", stance=far),
            "no-way",
            "no chain of transitions leads from 'rest' to 'far'",
        ),
        (
            no_loop,
            ask("r", 1, action=toy.id(project, "up to far")),
            "no-stance",
            "'up to far' ends in a stance that has no loop",
        ),
        (
            nowhere,
            ask("r", 1, action=toy.id(project, "rest to up")),
            "no-stance",
            "'rest to up' ends in a stance that has no loop",
        ),
        (
            nowhere,
            ask("r", 1, kind="transition", stance=up),
            "no-way",
            "no chain of transitions leads from 'rest' to 'up'",
        ),
        (nowhere, ask("r", 1, kind="transition"), "no-candidate", "stance 'rest' has no transition"),
    ]
    for given, request, outcome, message in cases:
        plan, whole = arms(given, request)
        assert not plan.cues
        [report] = whole.reports
        assert (report.outcome, report.played) == (outcome, False) and report.message.startswith(message)


def test_a_transition_into_a_stance_without_a_loop_is_never_drawn(project: Project, toy: Any) -> None:
    broken = edits.remove_actions(project, [toy.id(project, "far loop")])
    for n in range(30):
        assert names(arms(broken, ask(f"r{n}", 0, kind="transition"), stance=toy.id(project, "up"))[0]) == [
            "up to rest"
        ]


def test_a_layer_with_no_loop_to_begin_in_stays_still_and_says_so(project: Project) -> None:
    plan = make_plan(project, 10, [MetaRequest("r", "head", "gesture", 1.0)])
    assert plan.layers["head"].cues == plan.layers["head"].rests == ()
    assert [(r.request, r.outcome) for r in plan.reports if not r.written] == [("r", "no-stance")]
    assert "head layer" in plan.reports[-1].message


def test_what_the_model_writes_takes_what_there_is(toy: Any) -> None:
    project = edits.update_actions(toy.project(), [toy.id(toy.project(), "rest short")], tags=("positive",))
    request = MetaRequest(
        "auto/arms/0", "arms", "gesture", 0.0, 1.0, limb="left", tags=("positive",), priority=0
    )
    state = LayerState(project, project.graphs["arms"], 1, toy.id(project, "rest"), Moods(), Track())
    perform_metas(state, [MetaAction(request, 0, 1, written=True)], 10)
    assert [c.action.name for c in state.cues] == ["rest short"], "the tag weighs more than the limb"
    perform_metas(state, [MetaAction(request, 5, 6, written=True)], 10)
    assert state.cues[1].action.name != "rest short", "but not so much as to play it twice in a row"
    assert state.reports == []


# --- rests


def test_a_long_rest_changes_between_the_loops_of_its_stance(project: Project, toy: Any) -> None:
    project = edits.place_clips(
        project,
        [project.action(toy.id(project, "rest scratch")).clip],
        "arms",
        "stance",
        toy.id(project, "rest"),
    )
    plan, _ = arms(project, end=120)
    assert {r.action.name for r in plan.rests} == {"rest loop", "rest scratch"}
    assert [r.fade_start for r in plan.rests] == sorted(r.fade_start for r in plan.rests)
    for before, after in zip(plan.rests, plan.rests[1:], strict=False):
        assert after.fade_start >= before.fade_start + before.fade, "one change at a time"
        assert after.fade_start + after.fade == pytest.approx(after.start), (
            "the new loop begins when it is fully there"
        )


def test_an_action_that_leaves_joints_alone_changes_the_rest_below_slowly(project: Project, toy: Any) -> None:
    one_armed = arms(project, ask("a", 1, action=toy.id(project, "rest beat lf")))[0]
    cue, rest = one_armed.cues[0], one_armed.rests[-1]
    assert cue.start <= rest.fade_start < rest.fade_start + rest.fade <= cue.end and rest.fade == 0.6
    way = edits.update_actions(project, [toy.id(project, "rest to up")], limb="left")
    one_armed = arms(way, ask("a", 1, action=toy.id(project, "rest to up")))[0]
    cue, rest = one_armed.cues[0], one_armed.rests[-1]
    assert (rest.fade_start, rest.fade) == (cue.start, pytest.approx(cue.end - cue.start))


def test_what_is_wanted_once_waits_for_a_longer_action_and_what_is_wanted_then_is_dropped(
    project: Project, toy: Any
) -> None:
    long = toy.id(project, "rest long")
    plan, whole = arms(
        project, ask("a", 1.0, action=long), ask("once", 1.4), ask("then", 1.6, 0.5, kind="fidget")
    )
    assert [(c.meta, round(c.start, 3)) for c in plan.cues] == [("a", 1.0), ("once", 3.4)]
    assert outcomes(whole)["once"] == "queued" and outcomes(whole)["then"] == "covered"
    assert "2.00 s for 'rest long'" in next(r.message for r in whole.reports if r.outcome == "queued")


def test_what_would_wait_too_long_behind_an_action_is_dropped(project: Project, toy: Any) -> None:
    project = edits.set_settings(project, wait=1.0)
    plan, whole = arms(project, ask("a", 1.0, action=toy.id(project, "rest long")), ask("once", 1.4))
    assert len(plan.cues) == 1 and outcomes(whole)["once"] in ("covered", "late")


# --- many actions


def crowd(project: Project, times: int) -> Project:
    """Return a project each of whose nodes has its clips so many times more."""
    for layer, graph in project.graphs.items():
        for (stance, kind), bucket in graph.index.items():
            clips = [action.clip for action in bucket] * times
            project = edits.place_clips(project, clips, layer, kind, stance, bucket[0].end_stance)
    return project


def count_calls(work: Callable[[], object]) -> int:
    calls = 0

    def note(frame: object, event: str, of: object) -> None:
        nonlocal calls
        calls += event == "call"

    sys.setprofile(note)
    try:
        work()
    finally:
        sys.setprofile(None)
    return calls


def test_a_minute_of_ten_times_the_actions_takes_at_most_ten_times_the_work(project):
    few, many = crowd(project, 20), crowd(project, 200)
    assert count_calls(lambda: improvise(many, 60)) < 11 * count_calls(lambda: improvise(few, 60))
