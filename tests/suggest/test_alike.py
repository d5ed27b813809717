"""What is labelled teaches: words and motion vote, confidence is how often such guesses were right, few
examples stay unsure.
"""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.suggest.alike import LEAST, Alike, LabelledExample, decode_example

NONE = np.zeros(0)


def labelled(words: str, kind: str, *measures: float) -> LabelledExample:
    return LabelledExample(tuple(words.split()), np.array(measures), {"kind": kind})


def of_words(count: int = 6) -> list[LabelledExample]:
    return [labelled(f"shrug {n}", "gesture") for n in range(count)] + [
        labelled(f"idle {n}", "stance") for n in range(count)
    ]


def test_nothing_is_said_of_nothing_or_of_too_few() -> None:
    assert Alike([]).guess(("shrug",), NONE) == {}
    assert Alike(of_words()[: LEAST - 1]).guess(("shrug",), NONE) == {}


def test_words_tell_alone() -> None:
    found = Alike(of_words()).guess(("shrug", "99"), NONE)["kind"]
    assert found.value == "gesture" and found.confidence > 0.75 and "shrug" in found.reason


def test_motion_tells_alone() -> None:
    chance = np.random.default_rng(1)
    quick = [labelled(f"a{n}", "gesture", *chance.normal(5, 0.3, 3)) for n in range(10)]
    calm = [labelled(f"b{n}", "stance", *chance.normal(0, 0.3, 3)) for n in range(10)]
    alike = Alike(quick + calm)
    assert alike.guess((), np.array([5.0, 5.1, 4.9]))["kind"].value == "gesture"
    assert alike.guess((), np.array([0.1, np.nan, 0.0]))["kind"].value == "stance"


def test_a_motion_unlike_all_that_is_labelled_is_not_judged_by_it() -> None:
    chance = np.random.default_rng(3)
    alike = Alike([labelled(f"rest {n}", "stance", *chance.normal(0, 0.1, 3)) for n in range(12)])
    assert alike.guess(("look", "down"), np.array([0.0, 0.1, 0.0]))["kind"].confidence > 0.8
    assert alike.guess(("look", "down"), np.array([3.0, 4.0, 2.0]))["kind"].confidence < 0.1


def test_labels_that_nothing_tells_are_not_believed() -> None:
    chance = np.random.default_rng(2)
    noise = [
        labelled(f"clip {n}", str(chance.choice(["gesture", "fidget"])), *chance.normal(0, 1, 4))
        for n in range(60)
    ]
    found = Alike(noise).guess(("clip", "7"), chance.normal(0, 1, 4))["kind"]
    assert found.confidence < 0.8


def test_measures_of_another_length_are_passed_over() -> None:
    examples = [*of_words(), labelled("odd", "gesture", 1.0, 2.0)]
    assert Alike(examples).guess(("idle",), np.array([1.0, 2.0, 3.0]))["kind"].value == "stance"


def test_one_more_correction_changes_the_guess() -> None:
    before = Alike([*of_words(), labelled("wobble 1", "gesture")])
    after = Alike([*before.examples, *(labelled(f"wobble {n}", "fidget") for n in range(2, 5))])
    assert (
        after.guess(("wobble", "9"), NONE)["kind"].value
        == "fidget"
        != before.guess(("wobble", "9"), NONE)["kind"].value
    )


examples_ = st.lists(
    st.builds(
        labelled,
        st.text("ab c", max_size=6),
        st.sampled_from(["gesture", "stance", "fidget"]),
        st.floats(-1e6, 1e6),
        st.floats(-1e6, 1e6) | st.just(float("nan")),
    ),
    max_size=12,
)


@given(examples_, st.lists(st.text("abc", max_size=3), max_size=3), st.floats(-1e6, 1e6))
@settings(max_examples=60, deadline=None)
def test_whatever_is_labelled_a_guess_is_one_of_its_labels_and_surely_between_0_and_1(
    examples: list[LabelledExample], words: list[str], x: float
) -> None:
    for belief in Alike(examples).guess(words, np.array([x, x])).values():
        assert belief.value in {e.labels["kind"] for e in examples}
        assert 0 < belief.confidence < 1


@given(examples_)
@settings(max_examples=30, deadline=None)
def test_examples_come_back_from_their_data(examples: list[LabelledExample]) -> None:
    for example in examples:
        back = decode_example(json.loads(json.dumps(example.to_data(), allow_nan=False)))
        assert back.words == example.words and back.labels == example.labels
        assert np.allclose(back.measures, example.measures, atol=1e-5, equal_nan=True)


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (3, "should be an object"),
        ({"words": "a"}, "words"),
        ({"words": [], "measures": ["x"], "labels": {}}, "measures"),
        ({"words": [], "measures": [True], "labels": {}}, "measures"),
        ({"words": [], "labels": {"kind": 3}}, "labels"),
    ],
)
def test_broken_examples_are_told(data: object, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        decode_example(data)
