"""From intervals to sequences, from sequences to models and performances."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.formats.elan import read_elan
from metagraph.formats.project.data import decode_markov, encode_markov
from metagraph.graph.model import Layer, Markov
from metagraph.graph.requests import Change, Fidget, Gesture, Nod
from metagraph.playback.learning.annotation import (
    Annotation,
    AnnotationInterval,
    AnnotationTier,
    Label,
    guess_roles,
    list_labels,
)
from metagraph.playback.learning.learn import (
    Act,
    as_performance,
    describe_state,
    find_act_sequences,
    learn_model,
    list_model_states,
    make_asks_from_acts,
    measure_rests,
    merge_acts,
    read_acts_of_asks,
    remove_state,
    with_cell,
    with_state,
)
from metagraph.playback.planning.markov import ARMS

SAMPLE = Path(__file__).resolve().parents[3] / "sample_clips" / "annotation" / "conversation.eaf"


def annotated(**tiers: list[tuple[float, float, str]]) -> dict[Layer, tuple[Act, ...]]:
    """Sequences of tiers whose roles and labels are as guessed."""
    annotation = Annotation(
        tuple(
            AnnotationTier(name.replace("_", " "), tuple(AnnotationInterval(*i) for i in some))
            for name, some in tiers.items()
        )
    )
    roles = guess_roles(annotation)
    return find_act_sequences(annotation, roles, list_labels(annotation, roles))


def act(start: float, end: float, what: str = "both gesture", *tags: str) -> Act:
    limb, kind = what.split()
    return Act(start, end, limb, kind, tags)  # type: ignore[arg-type]


def kinds(*words: str) -> list[Act]:
    """Acts one after the other: one second each, half a second of rest."""
    return [act(1.5 * n, 1.5 * n + 1, *word.split(",")) for n, word in enumerate(words)]


# --- sequences


def test_an_annotation_without_anything_gives_no_layers_and_an_empty_tier_gives_an_empty_one() -> None:
    assert annotated() == {}
    assert annotated(LH=[]) == {"arms": ()}
    assert annotated(words=[(0, 1, "gesture")]) == {}


def test_intervals_become_acts_of_their_layer_and_limb() -> None:
    found = annotated(
        LH=[(0, 1, "gesture")],
        RH=[(2, 3, "fidget"), (4, 5, "rest")],
        Head=[(0, 1, "nod")],
        Body=[(1, 2, "shift")],
    )
    assert found == {
        "arms": (act(0, 1, "left gesture"), act(2, 3, "right fidget")),
        "head": (act(0, 1, "both gesture", "positive"),),
        "body": (act(1, 2, "both transition"),),
    }


@pytest.mark.parametrize(
    ("start", "one"), [(1.0, True), (1.49, True), (1.5, False), (1.6, False), (2.5, False)]
)
def test_arms_that_share_more_than_half_of_the_shorter_act_together(start: float, one: bool) -> None:
    found = annotated(LH=[(0, 2, "gesture")], RH=[(start, start + 1, "gesture")])["arms"]
    assert found == (
        (act(0, max(2, start + 1)),)
        if one
        else (act(0, 2, "left gesture"), act(start, start + 1, "right gesture"))
    )


@pytest.mark.parametrize(
    ("left", "right", "both"),
    [
        ("fidget", "gesture", "gesture"),
        ("gesture", "change", "transition"),
        ("fidget", "transition", "transition"),
        ("fidget", "fidget", "fidget"),
    ],
)
def test_of_two_kinds_the_more_important_stays(left: str, right: str, both: str) -> None:
    for a, b in ((left, right), (right, left)):
        assert annotated(LH=[(0, 1, a)], RH=[(0.1, 1.2, b)])["arms"] == (act(0, 1.2, f"both {both}"),)


def test_tags_of_the_less_important_kind_are_dropped_and_others_joined() -> None:
    assert merge_acts([act(0, 1, "left gesture", "positive"), act(0, 1, "right fidget", "calm")]) == (
        act(0, 1, "both gesture", "positive"),
    )
    assert merge_acts([act(0, 1, "left gesture", "b", "a"), act(0, 1, "right gesture", "a", "c")]) == (
        act(0, 1, "both gesture", "b", "a", "c"),
    )


def test_a_long_act_takes_in_the_short_ones_within_it_and_neighbours_stay_apart() -> None:
    acts = [
        act(0, 10, "left gesture"),
        act(1, 2, "right fidget"),
        act(5, 6, "right fidget"),
        act(10, 11, "right gesture"),
    ]
    assert merge_acts(acts) == (act(0, 10), act(10, 11, "right gesture"))


spans = st.tuples(
    st.floats(0, 50),
    st.floats(0.05, 8),
    st.sampled_from(["left", "right", "both"]),
    st.sampled_from(["gesture", "fidget"]),
)


@given(st.lists(spans, max_size=25))
def test_merged_acts_ascend_cover_the_same_time_and_no_two_are_mostly_the_same(
    some: list[tuple[float, float, str, str]],
) -> None:
    acts = [act(start, start + length, f"{limb} {kind}") for start, length, limb, kind in some]
    found = merge_acts(acts)
    assert merge_acts(found) == found
    assert list(found) == sorted(found, key=lambda a: (a.start, a.end))
    for n, a in enumerate(found):
        for b in found[n + 1 :]:
            assert min(a.end, b.end) - b.start <= 0.5 * min(a.length, b.length) + 1e-9
    for a in acts:
        assert any(b.start <= a.start and a.end <= b.end for b in found)
    assert {a.start for a in found} <= {a.start for a in acts}


def test_phases_become_one_gesture_whose_stroke_is_known() -> None:
    phases = [
        (0, 0.4, "prep"),
        (0.4, 0.6, "pre-stroke hold"),
        (0.6, 1.0, "stroke"),
        (1.0, 1.5, "hold"),
        (1.5, 2, "retraction"),
    ]
    assert annotated(LH=phases)["arms"] == (Act(0, 2, "left", "gesture", (), 0.8),)


@pytest.mark.parametrize(
    ("phases", "ends"),
    [
        (["prep", "stroke", "prep", "stroke"], [2, 4]),  # a preparation begins a gesture
        (["prep", "prep", "stroke"], [3]),  # but not between two of them
        (["stroke", "retr", "stroke"], [2, 3]),  # a retraction ends one
        (["stroke", "hold", "stroke", "retr"], [2, 4]),  # each has one stroke
        (["prep", "retr", "hold"], [2, 3]),
        (["hold"], [1]),
    ],
)
def test_where_one_gesture_ends_and_the_next_begins(phases: list[str], ends: list[float]) -> None:
    found = annotated(LH=[(n, n + 1, p) for n, p in enumerate(phases)])["arms"]
    assert sorted(a.end for a in found if a.kind == "gesture") == ends


def test_phases_far_apart_are_of_two_gestures() -> None:
    assert len(annotated(LH=[(0, 1, "prep"), (1.9, 3, "stroke")])["arms"]) == 1
    assert len(annotated(LH=[(0, 1, "prep"), (2.1, 3, "stroke")])["arms"]) == 2


def test_where_stances_are_annotated_the_changes_between_them_are_found() -> None:
    stances = [(0, 4, "left"), (4, 8, "left"), (8, 8.5, "right"), (8.5, 20, "middle"), (20, 24, "left")]
    assert annotated(Head_stance=stances)["head"] == tuple(
        act(a, b, "both transition") for a, b in ((8, 8.5), (8.5, 9.5), (20, 21))
    )


def test_labels_that_were_said_otherwise_count() -> None:
    annotation = Annotation(
        (AnnotationTier("LH", (AnnotationInterval(0, 1, "Cup"), AnnotationInterval(1, 2, "gesture"))),)
    )
    said = [
        Label("arms", "cup", 1, "fidget calm idle"),
        Label("arms", "gesture", 1, "ignore"),
        Label("head", "cup", 1, "gesture"),
    ]
    assert find_act_sequences(annotation, {"LH": "arms"}, said) == {
        "arms": (act(0, 1, "both fidget", "calm", "idle"),)
    }


# --- models


def test_transitions_are_counted_and_rows_sum_to_1() -> None:
    model = learn_model(
        "arms",
        [
            kinds(
                "left gesture",
                "left gesture",
                "right fidget",
                "left gesture",
                "right fidget",
                "both transition",
            )
        ],
    )
    assert list_model_states(model) == (
        ("left", "gesture", ""),
        ("right", "fidget", ""),
        ("both", "transition", ""),
    )
    assert np.allclose(model.matrix, [[1 / 3, 2 / 3, 0], [1 / 2, 0, 1 / 2], [1 / 2, 1 / 3, 1 / 6]])
    assert model.gap == 0.5


def test_states_come_in_the_order_of_the_papers_figure() -> None:
    words = [
        f"{limb} {kind}" for limb in ("both", "right", "left") for kind in ("transition", "fidget", "gesture")
    ]
    assert learn_model("arms", [kinds(*words)]).states == ARMS.states


def test_a_state_that_was_never_left_goes_on_as_often_as_each_was_seen() -> None:
    model = learn_model("head", [kinds("both gesture", "both gesture", "both gesture", "both transition")])
    assert np.allclose(model.matrix, [[2 / 3, 1 / 3], [3 / 4, 1 / 4]])
    assert learn_model("head", [kinds("both gesture")]).matrix == ((1.0,),)


def test_smoothing_makes_everything_possible_and_none_is_plan_as_in_paper() -> None:
    acts = [kinds("both gesture", "both gesture", "both fidget", "both gesture")]
    assert np.allclose(learn_model("head", acts, smoothing=1.0).matrix, [[2 / 4, 2 / 4], [2 / 3, 1 / 3]])
    assert np.allclose(learn_model("head", acts).matrix, [[1 / 2, 1 / 2], [1, 0]])
    with pytest.raises(ValueError, match="0 or more"):
        learn_model("head", acts, smoothing=-1)


def test_what_follows_from_one_recording_to_the_next_does_not_count() -> None:
    model = learn_model("head", [kinds("both gesture", "both gesture"), kinds("both fidget", "both gesture")])
    assert np.allclose(model.matrix, [[1, 0], [1, 0]])


def test_meaning_is_a_share_of_gestures_or_part_of_the_states() -> None:
    acts = [
        kinds(
            "both gesture,positive",
            "both gesture",
            "both gesture,negative",
            "both gesture,positive",
            "both fidget,positive",
        )
    ]
    shares = learn_model("head", acts)
    assert (shares.positive, shares.negative, shares.tags) == (0.5, 0.25, ())
    assert len(shares.states) == 2
    states = learn_model("head", acts, tagged=True)
    assert [describe_state(s, "head") for s in list_model_states(states)] == [
        "gesture",
        "gesture, positive",
        "gesture, negative",
        "fidget, positive",
    ]
    assert (states.positive, states.negative) == (0, 0)
    assert states.tags == ("", "positive", "negative", "positive")
    assert np.allclose(states.matrix, [[0, 0, 1, 0], [0.5, 0, 0, 0.5], [0, 1, 0, 0], [0.2, 0.4, 0.2, 0.2]])
    assert learn_model("head", [kinds("both gesture")], tagged=True).tags == (), (
        "no tags, no need to write them down"
    )


def test_lengths_are_means_and_deviations_and_one_alone_varies_as_the_others_do() -> None:
    acts = [act(0, 1), act(2, 5), act(6, 10, "both fidget")]
    assert learn_model("head", [acts]).lengths == ((2.0, 1.4142), (4.0, 2.8284))
    assert learn_model("head", [[act(0, 1)]]).lengths == ((1.0, 0.0),)


def test_rests_are_what_lies_between_and_overlaps_are_none() -> None:
    acts = [act(0, 1), act(3, 4), act(3.8, 5), act(5, 6)]
    assert measure_rests([acts, kinds("both gesture")]) == [2, 0, 0]
    assert learn_model("head", [acts]).gap == 0.6667
    assert learn_model("head", [[act(0, 1), act(1, 2)]]).gap == 0.05, (
        "a model never asks for two things at once"
    )


def test_nothing_annotated_is_told() -> None:
    with pytest.raises(ValueError, match="the body layer"):
        learn_model("body", [[], []])


states = st.tuples(
    st.sampled_from(["left", "right", "both"]),
    st.sampled_from(["gesture", "fidget", "transition"]),
    st.sampled_from(["", "positive", "a b"]),
)


@given(
    st.lists(
        st.lists(st.tuples(states, st.floats(0.02, 30), st.floats(0, 30)), max_size=12),
        min_size=1,
        max_size=3,
    ),
    st.booleans(),
    st.floats(0, 3),
)
def test_every_model_that_is_learned_is_sound_and_can_be_saved(some, tagged: bool, smoothing: float) -> None:
    observed = []
    for sequence in some:
        time, acts = 0.0, []
        for (limb, kind, tags), length, rest in sequence:
            acts.append(Act(time, time + length, limb, kind, tuple(tags.split())))
            time += length + rest
        observed.append(acts)
    if not any(observed):
        return
    model = learn_model("arms", observed, tagged, smoothing)
    matrix = np.array(model.matrix)
    assert matrix.shape == (len(model.states),) * 2
    assert np.allclose(matrix.sum(axis=1), 1) and matrix.min() >= 0
    assert len(set(list_model_states(model))) == len(model.states) == len(model.lengths)
    assert decode_markov("arms", encode_markov(model), "markov") == model
    if smoothing == 0:
        moves = {
            pair
            for acts in observed
            for pair in pairwise((a.limb, a.kind, " ".join(a.tags) if tagged else "") for a in acts)
        }
        place = {state: n for n, state in enumerate(list_model_states(model))}
        assert all(matrix[place[a], place[b]] > 0 for a, b in moves)


# --- editing


def test_setting_a_cell_evens_out_its_row_in_proportion_and_leaves_the_others() -> None:
    model = with_cell(ARMS, 0, 0, 0.5)
    assert np.allclose(model.matrix[0][:4], np.array([0.5, 0.25, 1 / 12, 1 / 12]))
    assert model.matrix[1:] == ARMS.matrix[1:]
    assert np.allclose(with_cell(model, 0, 0, 0.25).matrix[0], ARMS.matrix[0]), "and back"


def test_where_nothing_else_could_follow_the_rest_is_shared_evenly() -> None:
    model = Markov(
        "head",
        (("both", "gesture"), ("both", "fidget"), ("both", "transition")),
        ((1.0, 0, 0), (0, 0, 0), (0, 1, 0)),
    )
    assert np.allclose(with_cell(model, 0, 0, 0.4).matrix[0], [0.4, 0.3, 0.3])
    assert np.allclose(with_cell(model, 1, 2, 0.4).matrix[1], [0.3, 0.3, 0.4])
    assert np.allclose(with_cell(model, 0, 1, 7.0).matrix[0], [0, 1, 0])
    assert np.allclose(with_cell(model, 0, 0, -1.0).matrix[0], [0, 0.5, 0.5])
    assert with_cell(Markov("head", (("both", "gesture"),), ((1.0,),)), 0, 0, 0.2).matrix == ((1.0,),)


def test_a_state_can_be_added_and_taken_away_again() -> None:
    model = learn_model("arms", [kinds("left gesture", "right fidget", "left gesture")])
    more = with_state(model, ("right", "gesture", "positive"))
    assert [describe_state(s, "arms") for s in list_model_states(more)] == [
        "left gesture",
        "right gesture, positive",
        "right fidget",
    ]
    assert np.allclose(more.matrix, [[0, 0, 1], [1 / 3] * 3, [1, 0, 0]])
    assert more.lengths[1] == (1.0, 0.0)
    assert with_state(more, ("right", "gesture", "positive")) is more
    assert remove_state(more, 1) == model
    alone = remove_state(model, 0)
    assert alone.matrix == ((1.0,),) and remove_state(alone, 0) is alone


# --- performing


def test_acts_become_asks_with_their_times_and_back() -> None:
    acts = (
        Act(0.5, 1.75, "left", "gesture", ("positive",), 1.0),
        act(2, 3, "right fidget"),
        act(4, 5, "both transition"),
    )
    asks = make_asks_from_acts("arms", acts)
    assert asks == (
        Gesture(id="arms1", at=0.5, layer="arms", tags=("positive",), limb="left", duration=1.25, stroke=1.0),
        Fidget(id="arms2", at=2.0, layer="arms", limb="right", duration=1.0),
        Change(id="arms3", at=4.0, layer="arms", limb="both", duration=1.0),
    )
    assert read_acts_of_asks("arms", asks) == acts
    assert read_acts_of_asks("head", asks) == ()
    assert read_acts_of_asks("arms", [Nod(at=1.0), Gesture(layer="arms")]) == (), (
        "what is asked for otherwise is nobody's act"
    )


def test_only_arms_are_asked_for_by_limb() -> None:
    assert [
        ask.limb
        for ask in make_asks_from_acts("head", kinds("both gesture", "both fidget", "both transition"))
    ] == [None] * 3


def test_a_performance_holds_every_layer_in_order_and_fills_nothing_in() -> None:
    made = as_performance(
        "talk", {"arms": kinds("left gesture", "left fidget"), "head": kinds("both gesture"), "body": []}
    )
    assert [(ask.id, ask.at) for ask in made.asks] == [("arms1", 0.0), ("head1", 0.0), ("arms2", 1.5)]
    assert (made.name, made.length, made.idle, made.seed) == ("talk", 4.0, False, None)
    assert as_performance("nothing", {}).asks == ()
    assert as_performance("nothing", {}).length == 1.0
    assert as_performance("talk", {"head": kinds("both gesture")}, 20.5).length == 21.0


def test_the_sample_annotation_becomes_models_of_three_layers() -> None:
    annotation = read_elan(SAMPLE)
    roles = guess_roles(annotation)
    found = find_act_sequences(annotation, roles, list_labels(annotation, roles))
    assert {layer: len(acts) for layer, acts in found.items()} == {"arms": 52, "head": 46, "body": 12}
    assert sum(a.limb == "both" for a in found["arms"]) == 20, (
        "both hands seldom begin and end together, yet are one act"
    )
    assert [len(learn_model(layer, [acts], tagged=True).states) for layer, acts in found.items()] == [7, 3, 1]
