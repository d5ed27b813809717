"""Parameters: names, first values, and the requests that setting them makes."""

from __future__ import annotations

import random
from typing import Any

import msgspec
import pytest

from metagraph.graph.parameter import (
    CharacterParameter,
    ParameterChoice,
    ParameterValues,
    describe_parameters,
    get_first_value,
    is_word,
    make_parameter_choices,
    make_word,
)
from metagraph.graph.requests import Behave, Blink, Feel, Gesture, Go, Look, Place, RequestError

PARAMETERS = {
    "mood": CharacterParameter(
        type="enum",
        request=Feel(mood="calm"),
        field="mood",
        choices=(ParameterChoice("calm", "calm"), ParameterChoice("glad", "happy"), ParameterChoice("none")),
    ),
    "energy": CharacterParameter(type="number", request=Feel(), field="intensity", least=0.5, most=1.5),
    "looks_at": CharacterParameter(
        type="enum",
        request=Look(to="ahead"),
        field="to",
        choices=make_parameter_choices([("user", "user"), ("ahead", "ahead")]),
    ),
    "attention": CharacterParameter(type="number", request=Look(amount=0.25), field="amount"),
    "mode": CharacterParameter(
        type="enum",
        request=Behave(),
        field="mode",
        choices=make_parameter_choices([("auto", None), ("idle", "idle")]),
    ),
    "speaking": CharacterParameter(
        type="boolean",
        request=Behave(),
        field="mode",
        choices=(ParameterChoice("off"), ParameterChoice("on", "talking")),
    ),
    "tags": CharacterParameter(
        type="list", request=Gesture(), field="tags", choices=make_parameter_choices([("A", "a"), ("B", "b")])
    ),
    "partner": CharacterParameter(type="point", request=Place(name="user", point=(0, 1, 2)), field="point"),
    "blink": CharacterParameter(type="trigger", request=Blink()),
    "arms": CharacterParameter(
        type="enum",
        request=Go(stance="s1", layer="arms", stay=True),
        field="stance",
        choices=make_parameter_choices([("one", "s1"), ("two", "s2")]),
    ),
}


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("Hands at sides", "hands_at_sides"),
        ("wave_rt_01", "wave_rt01"),
        ("2nd", "nd"),
        ("Größe", "groe"),
        ("話す", "value"),
        ("a__b", "a_b"),
        ("", "value"),
        ("x" * 90, "x" * 55),
    ],
)
def test_any_text_becomes_a_name(text: str, word: str) -> None:
    assert make_word(text) == word and is_word(word)


def test_names_are_never_taken_twice_nor_mistaken_in_another_way_of_writing() -> None:
    draw, taken = random.Random(5), dict[str, None]()
    for _ in range(3000):
        text = "".join(draw.choice("ab 1_-.é") for _ in range(draw.randrange(8)))
        word = make_word(text, taken)
        assert is_word(word) and word not in taken, text
        taken[word] = None
    for write in (
        lambda w: "".join(p.capitalize() for p in w.split("_")),
        lambda w: w.upper(),
        lambda w: w.split("_")[0] + "".join(p.capitalize() for p in w.split("_")[1:]),
    ):
        assert len({write(word) for word in taken}) == len(taken)


@pytest.mark.parametrize("word", ["Mood", "a_", "_a", "a__b", "a_1", "1a", "a b", "ä", "", "a" * 61])
def test_what_is_no_name(word: str) -> None:
    assert not is_word(word)


def test_first_values_are_those_of_the_request() -> None:
    assert {name: get_first_value(p) for name, p in PARAMETERS.items()} == {
        "mood": "calm",
        "energy": 1.0,
        "looks_at": "ahead",
        "attention": 0.25,
        "mode": "auto",
        "speaking": False,
        "tags": [],
        "partner": [0.0, 1.0, 2.0],
        "blink": None,
        "arms": "one",
    }


@pytest.mark.parametrize(
    ("name", "value", "request_made"),
    [
        ("mood", "glad", Feel(mood="happy")),
        ("mood", "none", Feel()),
        ("energy", 9, Feel(intensity=1.5)),
        ("energy", -1.0, Feel(intensity=0.5)),
        ("looks_at", "user", Look()),
        ("attention", 0.5, Look(amount=0.5)),
        ("mode", "auto", Behave()),
        ("speaking", True, Behave(mode="talking")),
        ("tags", ["b", "a"], Gesture(tags=("a", "b"))),
        ("partner", (1, 2, 3), Place(name="user", point=(1, 2, 3))),
        ("blink", None, Blink()),
        ("arms", "two", Go(stance="s2", layer="arms", stay=True)),
    ],
)
def test_setting_makes_a_request(name: str, value: Any, request_made: Any) -> None:
    assert ParameterValues().take(PARAMETERS, name, value) == request_made


@pytest.mark.parametrize(
    ("name", "value", "why"),
    [
        ("none", 1, "no parameter 'none'"),
        ("mood", "sad", "one of calm, glad, none"),
        ("mood", None, "one of calm"),
        ("energy", True, "should be a number"),
        ("energy", float("nan"), "should be a number"),
        ("energy", "1", "should be a number"),
        ("speaking", 1, "true or false"),
        ("tags", "a", "a list of a, b"),
        ("tags", ["c"], "a list of a, b"),
        ("tags", [["a"]], "a list of a, b"),
        ("partner", [1, 2], "three numbers"),
        ("partner", [1, 2, "3"], "three numbers"),
        ("partner", [1, 2, 1e9], "three numbers"),
        ("blink", 0, "a trigger has none"),
    ],
)
def test_what_does_not_fit_is_refused_in_words(name: str, value: Any, why: str) -> None:
    with pytest.raises(RequestError, match=why):
        ParameterValues().take(PARAMETERS, name, value)


def test_parameters_of_one_look_are_kept_together_and_those_of_one_mode_replace_each_other() -> None:
    values = ParameterValues()
    values.take(PARAMETERS, "attention", 0.5)
    assert values.take(PARAMETERS, "looks_at", "user") == Look(to="user", amount=0.5)
    assert values.take(PARAMETERS, "attention", 0.75) == Look(to="user", amount=0.75)
    values.take(PARAMETERS, "speaking", True)
    assert values.get(PARAMETERS, "speaking") is True
    values.take(PARAMETERS, "mode", "idle")
    assert values.get(PARAMETERS, "speaking") is False and values.get(PARAMETERS, "mode") == "idle"
    values.take(PARAMETERS, "arms", "two")
    assert values.get(PARAMETERS, "arms") == "two" and values.get(PARAMETERS, "nobody") is None


def test_they_are_described_as_plain_data() -> None:
    described = describe_parameters(PARAMETERS)
    assert described["blink"] == {"type": "trigger", "about": ""}
    assert described["tags"] == {"type": "list", "about": "", "initial": [], "choices": ["a", "b"]}
    assert described["energy"] == {"type": "number", "about": "", "initial": 1.0, "least": 0.5, "most": 1.5}
    assert msgspec.json.decode(msgspec.json.encode(described)) == described


def test_any_value_makes_a_request_or_is_refused() -> None:
    """Whatever a game sends, it is either a request or an error in words."""
    draw, values = random.Random(3), ParameterValues()
    things: tuple[Any, ...] = (
        *(None, True, False, 0, 1, -1, 1e308, float("inf"), float("nan"), "", "calm", "user", "on", "one"),
        *([], ["a"], ["a", "a"], [1, 2, 3], [None], {}, {"a": 1}, (1, 2, 3), b"a", object()),
    )
    for _ in range(3000):
        name, value = draw.choice([*PARAMETERS, "nobody"]), draw.choice(things)
        try:
            request = values.take(PARAMETERS, name, value)
        except RequestError as error:
            assert str(error).startswith(("name: ", "value: "))
        else:
            assert msgspec.convert(msgspec.to_builtins(request), type(request)) == request
