"""Canonical text is read without YAML as YAML reads it, and any other text is left to YAML."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.formats.project.canonical_text import read_canonical
from metagraph.formats.project.text import TextError, parse_yaml, read_text_data, to_text
from tests.formats.project.test_text import values
from tests.projects import words

ROOT = Path(__file__).resolve().parents[3]
TEXT = """# A Metagraph project.
metagraph: 1
name: sample it
base:
  clip: c82
settings: {}
roles: {a: b, "c:d": [1, 2.5, -3, 1.0e-05]}
clips:
- {id: c1, name: arms_crossed__beat small, path: clips/a-b (1).glb, many: 68, "on": true, off_: null}
- {id: c2, x: [[1, 2], [3, 4]], "yes": "no", z: {inner: {x: {}}}}
layers:
  arms:
    stances:
    - {id: s1, pose: {"time": 0.5}}
    actions: []
    deep: 3
  head:
    stances:
    - {id: s3, name: "\\u007f \\"q\\" \\n"}
end: last
"""
PIECES = [
    *"{}[],:\"'#-&*!|>%@`~?=+.\\/ \n\t\r0123e_Né",
    *(
        "  ",
        "- ",
        ": ",
        ", ",
        "{}",
        "[]",
        "null",
        "yes",
        "True",
        "1e3",
        ".inf",
        "0x1",
        "1_0",
        "01",
        "1.",
        "+1",
    ),
    *("1234567890123456", "? ", "---\n", "...\n", "\n  ", "\n    ", "\n- ", "# c", "a: b", "{k:v}", "[a b]"),
    *("\\u0041", "\\x41", "\\ud83d", "\u2028", "\x7f", "\x01", "\ufeff"),
]
PROJECTS = sorted((ROOT / "sample_clips").rglob("*.metagraph.yaml"))


def altered(text: str, r: random.Random) -> str:
    """Return the text with something put in, taken out or moved, once or a few times."""
    for _ in range(r.choice((1, 1, 1, 2, 3))):
        at, way = r.randrange(len(text) + 1), r.random()
        if way < 0.7:
            text = text[:at] + r.choice(["", *PIECES]) + text[at + r.choice((0, 0, 1, 2)) :]
        else:
            lines = text.split("\n")
            line = r.choice(("", " ", "  ", "    ")) + r.choice(lines).strip()
            lines.insert(r.randrange(len(lines)), line)
            text = "\n".join(lines)
    return text


@pytest.mark.parametrize("letter", ["\x00", "\x0b", "\x1f", "\x7f", "\ufeff"])
def test_what_no_yaml_may_hold_is_left_to_it_to_refuse_in_comments_too(letter: str) -> None:
    assert read_canonical(f"#{letter} A project\nmetagraph: 1\n") is None


@pytest.mark.nightly
@settings(max_examples=100, deadline=None)
@given(st.dictionaries(words, values, min_size=1, max_size=4))
def test_data_comes_back_from_its_text_or_is_left_to_yaml(data: dict[str, Any]) -> None:
    assert read_canonical(to_text(data)) in (data, None)


@settings(max_examples=50, deadline=None)
@given(st.integers(0, 2**32))
def test_whatever_is_changed_by_hand_is_read_as_yaml_reads_it_or_left_to_it(seed: int) -> None:
    r = random.Random(seed)
    for _ in range(20):
        text = altered(TEXT, r)
        found = read_canonical(text)
        if found is not None:
            assert repr(found) == repr(parse_yaml(text)[0]), text


@pytest.mark.parametrize(
    "path", sorted((ROOT / "sample_clips").rglob("*.metagraph.yaml")), ids=lambda p: p.stem
)
def test_projects_are_canonical(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    found = read_canonical(text)
    assert found is not None and found == parse_yaml(text)[0]


@pytest.mark.parametrize(
    "text",
    [
        "",
        "# only words\n",
        "a:\n",  # null, which is not written so
        "a: yes\n",
        "a: 1234567890123456\n",  # a float
        "a: {b:c}\n",  # one word
        "a: 1\na: 2\n",
        "a: {b: 1, b: 2}\n",
        "a: 'b'\n",
        "a: b # c\n",
        "a: b\n  c\n",
        "a:\r\n- {b: 1}\r\n",
        'a: "\\ud83d\\ude00"\n',
        "a: " + "[" * 20 + "]" * 20 + "\n",
        "a: " + "[" * 100_000 + "\n",
        "".join(f"{'  ' * n}a:\n" for n in range(20)) + "  " * 20 + "a: 1\n",
        'a: {b: "\\x41, c: d}\n',  # words in quotes that do not end
        "a: &b c\n",
        "- 1\n",
    ],
    ids=lambda text: ascii(text[:30]),
)
def test_what_is_said_otherwise_is_left_to_yaml(text: str) -> None:
    assert read_canonical(text) is None


def test_the_line_of_a_field_is_known_where_it_is_asked_for() -> None:
    data, lines = read_text_data(TEXT)
    assert data == read_canonical(TEXT) and lines()["layers.arms.deep"] == 16


def test_a_text_that_is_neither_is_told_of() -> None:
    with pytest.raises(TextError, match="twice"):
        read_text_data("a: 1\na: 2\n")
