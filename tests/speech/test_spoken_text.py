"""What of a language model's text is said: whole, and in pieces of any size alike."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.speech.spoken_text import (
    ADDRESSES,
    CODE,
    LONGEST_BREAK,
    PICTURES,
    THINKING,
    SpokenText,
    read_spoken,
    read_spoken_line,
)

CASES = {
    "": ("", []),
    "It is there.": ("It is there.", []),
    "<think>No! <b>Big</b> idea.</think>It is there.": ("It is there.", [THINKING]),
    "<THINKING a='1'>x</thinking> Yes.": ("Yes.", [THINKING]),
    "<think>never ends": ("", [THINKING]),
    "Look:\n```python\nprint('bye')\n```\nDone.": ("Look: Done.", [CODE]),
    "Look:\n```\nnever ends": ("Look:", [CODE]),
    "Call `open_it` now.": ("Call open_it now.", []),
    "It is [over there](https://a.b/bye).": ("It is over there.", [ADDRESSES]),
    "See https://a.b/hello-bye?x=1, or mail me@a.org!": ("See , or mail !", [ADDRESSES]),
    "![a big heart](x.png) Nice.": ("Nice.", [PICTURES]),
    "# Title\n\n- **one**\n- *two*\n1. __three__\n> four": ("Title one two 1. three four", []),
    "<speak>It is <emphasis level='strong'>there</emphasis>.</speak>": ("It is there.", []),
    "3 < 4 and snake_case and 2*3": ("3 < 4 and snake_case and 2*3", []),
    "---\nYes.": ("Yes.", []),
}


def joined(parts: list[str]) -> str:
    return " ".join("".join(parts).split())


@pytest.mark.parametrize("text", CASES)
@pytest.mark.parametrize("size", [1, 2, 3, 7, 1000])
def test_text_is_read_alike_in_pieces_of_any_size(text: str, size: int) -> None:
    reader = SpokenText()
    parts = [
        part.text
        for n in range(0, max(len(text), 1), size)
        for part in reader.take(text[n : n + size], n + size >= len(text))
    ]
    assert (joined(parts), reader.left_out) == CASES[text]


@pytest.mark.parametrize(
    ("mark", "seconds"),
    [
        ('<break time="2s"/>', 2.0),
        ("<break time='350ms'/>", 0.35),
        ("<break strength=strong>", 0.8),
        ("<break/>", 0.5),
        ('<break time="90s"/>', LONGEST_BREAK),
        ('<break time="..s"/>', 0.5),
    ],
)
def test_a_break_is_a_pause_and_in_one_line_a_comma(mark: str, seconds: float) -> None:
    (one, other), left_out = read_spoken(f"It is on {mark} the shelf.")
    assert (one.text.strip(), one.pause, other.text.strip()) == (
        "It is on",
        pytest.approx(seconds),
        "the shelf.",
    )
    assert left_out == [] and read_spoken_line(f"It is on {mark} the shelf.") == ("It is on, the shelf.", [])


@given(st.text("<>/think`[]()*_#! a.\n-1sbre=\"'", max_size=80), st.integers(1, 9))
def test_any_text_is_read_and_ends(text: str, size: int) -> None:
    reader = SpokenText()
    for n in range(0, len(text), size):
        reader.take(text[n : n + size])
    reader.take("", over=True)
    assert reader.take("Over.", over=True)[-1].text == "Over."


def test_what_never_ends_does_not_wait_for_ever() -> None:
    reader = SpokenText()
    reader.take("<think>")
    held = [reader.take("word " * 1000) for _ in range(10)]
    assert any(held) or reader.left_out == [THINKING]
