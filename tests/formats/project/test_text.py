"""Plain data as YAML text: every word survives, hostile text is refused, every field has its line."""

from __future__ import annotations

import math
from typing import Any

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.formats.project.text import HEADER, TextError, parse_yaml, to_text
from tests.projects import NASTY, words

numbers = st.integers(-(10**15) + 1, 10**15 - 1) | st.floats(-1e15, 1e15, allow_nan=False)
values = st.recursive(
    st.none() | st.booleans() | numbers | words,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(words, inner, max_size=3),
    max_leaves=8,
)


@pytest.mark.nightly
@settings(max_examples=200, deadline=None)
@given(st.dictionaries(words, values, min_size=1, max_size=4))
def test_data_comes_back_from_its_text(data: dict[str, Any]) -> None:
    assert parse_yaml(to_text(data))[0] == data


@pytest.mark.nightly
@settings(max_examples=150, deadline=None)
@given(st.dictionaries(words, values, min_size=1, max_size=4))
def test_other_yaml_readers_read_the_same(data: dict[str, Any]) -> None:
    assert yaml.safe_load(to_text(data)) == data


@pytest.mark.parametrize("word", NASTY, ids=ascii)
def test_every_nasty_word_survives_as_key_and_value(word: str) -> None:
    whole = word.encode(errors="replace").decode() if word == "\ud83d" else word
    data = parse_yaml(to_text({"name": word, "words": [word], "deep": {"x": {word: word}}}))[0]
    if word == "\ud83d":
        whole = "\ufffd"  # half a character is none
    assert data == {"name": whole, "words": [whole], "deep": {"x": {whole: whole}}}


def test_the_text_begins_by_saying_what_it_is() -> None:
    assert to_text({"metagraph": 1}).startswith(HEADER)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("yes", "yes"), ("off", "off"), ("~", None), ("", None), ("null", None), ("true", True),
        ("1e3", 1000.0), ("0x1F", "0x1F"),
        ("010", 10), ("1_000", "1_000"), ("12:30:00", "12:30:00"), ("2024-01-01", "2024-01-01"),
        ("+.5", 0.5), ("-.inf", -math.inf),
        ("'null'", "null"), ("\"1\"", "1"), ("1" * 40, float("1" * 40)), ("-7", -7), ("1.", 1.0),
        ("e5", "e5"), ("٣", "٣"),
    ],
)  # fmt: skip
def test_what_people_write_by_hand_means_what_it_looks_like(text: str, value: Any) -> None:
    assert parse_yaml(f"a: {text}")[0] == {"a": value}


def test_not_a_number_is_understood_so_that_it_can_be_refused_by_name() -> None:
    assert math.isnan(parse_yaml("a: .nan")[0]["a"])


def test_every_field_has_its_line() -> None:
    lines = parse_yaml("a: 1\nb:\n- {c: 2,\n   d: 3}\n- [4]\n\ne: {'x.y': {z: 5}}\n")[1]
    assert lines == {
        "": 1,
        "a": 1,
        "b": 3,
        "b[0]": 3,
        "b[0].c": 3,
        "b[0].d": 4,
        "b[1]": 5,
        "b[1][0]": 5,
        "e": 7,
        "e.x.y": 7,
        "e.x.y.z": 7,
    }


def test_windows_line_ends_and_block_style_are_read_alike() -> None:
    flow = parse_yaml("a:\r\n- {b: 1, c: [x, y]}\r\n")[0]
    assert (
        flow
        == parse_yaml("a:\n  - b: 1\n    c:\n    - x\n    - y\n")[0]
        == {"a": [{"b": 1, "c": ["x", "y"]}]}
    )


LAUGHS = "a: &a [x, x]\n" + "".join(
    f"{b}: &{b} [*{a}, *{a}, *{a}, *{a}, *{a}, *{a}]\n"
    for a, b in zip("abcdefghij", "bcdefghijk", strict=True)
)
HOSTILE = {
    "billion laughs": (LAUGHS, 1, "anchors and aliases"),
    "an alias": ("a: 1\nb: *a", 2, "anchors and aliases"),
    "a python object": (
        "a: 1\nb: !!python/object/apply:os.system ['true']",
        2,
        "the tag tag:yaml.org,2002:python/object/apply:os.system",
    ),
    "a tag of one's own": ("a: !x y", 1, "the tag !x"),
    "binary": ("a: !!binary aGk=", 1, "the tag"),
    "merge keys": ("a: &x {b: 1}\nc:\n  <<: *x", 1, "anchors"),
    "deep lists": ("[" * 100_000, 1, "nested too deep"),
    "deep fields": ("{a: " * 100_000, 1, "nested too deep"),
    "deep blocks": ("- " * 100_000, 1, "nested too deep"),
    "two documents": ("a: 1\n---\nb: 2", 2, "a second document"),
    "a field twice": ("a: 1\nb: {c: 1,\n  c: 2}", 3, "'c' is there twice"),
    "a list for a name": ("? [a]\n: b", 1, "a name of a field should be text"),
    "a merge conflict": ("a: 1\n<<<<<<< HEAD\nb: 2\n=======\nb: 3\n>>>>>>> x\n", 3, ""),
    "a tab": ("a:\n\t- b", 2, "cannot start any token"),
    "a control character": ("a: 1\nb: \x01", 2, "control characters"),
    "half a character": ("a: 1\nb: \ud83d", 0, ""),
    "an open quote": ('a: "x\nb: 1\n', 3, ""),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_text_is_refused_at_its_line(name: str) -> None:
    text, line, words = HOSTILE[name]
    with pytest.raises(TextError, match=words or None) as caught:
        parse_yaml(text)
    assert caught.value.line == line


def test_an_empty_text_holds_nothing() -> None:
    assert parse_yaml("")[0] is None
    assert parse_yaml("# only words\n")[0] is None


@pytest.mark.nightly
@settings(max_examples=300, deadline=None)
@given(st.text(max_size=60))
def test_any_text_at_all_is_read_or_refused(text: str) -> None:
    try:
        parse_yaml(text)
    except TextError as error:
        assert error.line >= 0
