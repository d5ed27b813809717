"""Who sees what: balanced, concealed, the same for ever."""

from __future__ import annotations

import json
from collections import Counter
from itertools import pairwise

import pytest

from metagraph.research.study.perceive.design import count_sequences, make_design
from metagraph.research.study.perceive.perceive_plan import PerceivePlan
from tests.research.study.perceive.perceive_makers import CHOICE, RATING, SECRET, plan

THREE = "{a: {clip: x}, b: {clip: y}, c: {clip: z}}"


def wide(**options: object) -> PerceivePlan:
    return plan(**{"people": 24, "items": 6, "conditions": THREE, **options})


@pytest.mark.parametrize("each", [None, 1, 4, 6, 9])
def test_after_whole_rounds_every_pair_was_on_every_side_as_often(each: int | None) -> None:
    asked = f"choice: {{question: Q{'' if each is None else f', each: {each}'}}}\n"
    rounds = count_sequences(wide(asked=asked))
    made = make_design(wide(asked=asked, people=2 * rounds), SECRET)
    counts = Counter(
        (t.item, t.a, t.b) for s in made.key.sessions.values() for t in s.trials if t.kind == "choice"
    )
    assert len(counts) == 2 * 3 * 6 and len(set(counts.values())) == 1


@pytest.mark.parametrize("each", [None, 4, 9])
def test_in_each_session_sides_are_balanced_within_each_comparison(each: int | None) -> None:
    asked = f"choice: {{question: Q{'' if each is None else f', each: {each}'}}}\n"
    for session in make_design(wide(asked=asked), SECRET).key.sessions.values():
        lefts = Counter[tuple[str, str]]()
        for t in session.trials:
            if t.kind == "choice":
                pair = (t.a, t.b) if t.a < t.b else (t.b, t.a)
                lefts[pair] += 1 if t.a < t.b else -1
        assert all(abs(n) <= 1 for n in lefts.values())


def test_orders_differ_between_people_and_an_item_hardly_follows_itself() -> None:
    sessions = make_design(wide(), SECRET).key.sessions
    orders = {
        tuple((t.item, *sorted((t.a, t.b))) for t in s.trials if t.kind == "choice")
        for s in sessions.values()
    }
    assert len(orders) == len(sessions)
    for s in sessions.values():
        plain = [t.item for t in s.trials if t.kind == "choice"]
        assert all(one != other for one, other in pairwise(plain))


def test_one_item_is_all_there_is_and_follows_itself() -> None:
    made = make_design(wide(items=1), SECRET)
    assert all(len([t for t in s.trials if t.kind == "choice"]) == 3 for s in made.key.sessions.values())


def test_checks_and_practice_are_there_and_told_sides_are_balanced() -> None:
    made = make_design(wide(more="checks: {told: 4, same: 2}\ntraining: 2\n"), SECRET)
    for session in made.key.sessions.values():
        kinds = Counter(t.kind for t in session.trials)
        assert kinds == {"training": 2, "choice": 18, "told": 4, "same": 2}
        assert [t.kind for t in session.trials[:2]] == ["training", "training"]
        assert Counter(t.told for t in session.trials if t.kind == "told") == {"left": 2, "right": 2}
        assert all(t.left == t.right for t in session.trials if t.kind == "same")
        assert session.trials[2].kind == "choice"  # nobody begins with a check


def test_ratings_are_of_every_condition_of_an_item_and_told_numbers_are_on_the_scale() -> None:
    made = make_design(wide(asked=CHOICE + RATING + "  each: 2\n"), SECRET)
    items = Counter[str]()
    for session in made.key.sessions.values():
        rated = [t for t in session.trials if t.kind == "rating"]
        assert Counter(Counter(t.item for t in rated).values()) == {3: 2}
        assert all(not t.right and not t.b for t in rated)
        assert {t.told for t in session.trials if t.kind == "told" and not t.right} <= set(range(1, 8))
        items.update({t.item for t in rated})
    assert len(set(items.values())) == 1


def test_nothing_that_the_page_is_told_says_what_is_what() -> None:
    words = "{synthesised: {clip: x, title: Ours}, captured: {clip: y, title: Theirs}}"
    made = make_design(plan(conditions=words), SECRET)
    told = json.dumps(made.public)
    assert not any(w in told for w in ("synthesised", "captured", "Ours", "Theirs", "i0", "i1", SECRET))
    names = {n for s in made.public["sessions"].values() for t in s for n in t[2:4]}
    assert names == set(made.key.stimuli) and all(len(n) == 20 for n in names)
    ids = [t.id for s in made.key.sessions.values() for t in s.trials]
    assert len(set(ids)) == len(ids)


def test_the_same_secret_gives_the_same_for_ever_and_another_one_another_order() -> None:
    assert make_design(wide(), SECRET).key == make_design(wide(), SECRET).key
    other = make_design(wide(), "another")
    assert not set(other.key.stimuli) & set(make_design(wide(), SECRET).key.stimuli)
    first = make_design(plan(people=1, items=1), "x").key.sessions["P01"].trials[-1]
    assert first.id == make_design(plan(people=1, items=1), "x").key.sessions["P01"].trials[-1].id


def test_only_what_is_shown_has_a_video() -> None:
    made = make_design(wide(more="compare: [[a, b]]\n"), SECRET)
    assert {c for c, _ in made.key.stimuli.values()} == {"a", "b"}
    assert {c for c, _ in make_design(wide(asked=RATING), SECRET).key.stimuli.values()} == {"a", "b", "c"}
