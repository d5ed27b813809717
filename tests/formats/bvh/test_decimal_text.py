"""Decimal numbers out of text are what `float` makes of each word, to the bit, or are refused as it does."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.formats.bvh import decimal_text
from metagraph.formats.bvh.decimal_text import read_decimals

HEAD = b"MOTION\nFrame Time: 0.1\n"


def read(text: bytes) -> list[float]:
    return read_decimals(HEAD + text, len(HEAD)).tolist()


READ = (
    "0 -0 7 -7 0.5 .5 5. -.25 +3 1e5 1E+05 1.5e-07 -9.8e-1 1.e2 1e22 1e-22 1e23 1e-30 1e300 1e-320 "
    "123456789012345 1234567890123456 0.1234567890123456789 98765432.12345678 00012.5000 0.000000000000001 "
    "179.446 1e0005"
)
REFUSED = ". - -. + e5 1e 1e- 1e+ --1 1-2 1.2.3 1e5e3 1e5.2 1e-5-3 0x10 1,5 half 1\x002 1\x7f 1e1-1 ²"


@pytest.mark.parametrize("word", READ.split())
def test_a_word_is_what_float_makes_of_it(word: str) -> None:
    found = read(f"1.0 {word}\t{word}\r\n{word}".encode())
    assert np.array(found).tobytes() == np.array([1.0, *[float(word)] * 3]).tobytes()


@pytest.mark.parametrize("word", REFUSED.split(" "))
def test_what_is_no_number_is_refused(word: str) -> None:
    with pytest.raises(ValueError):
        read(b"1.0 2.0 " + word.encode("latin-1") + b" 3.0\n")


def test_nothing_and_space_alone_hold_no_numbers() -> None:
    assert read(b"") == [] and read(b" \r\n\t ") == []


WORDS = st.one_of(
    st.floats(allow_nan=False, allow_infinity=False).map(repr),
    st.floats(-1e4, 1e4).map(lambda x: f"{x:.6f}"),
    st.floats(-1e4, 1e4).map(lambda x: f"{x:g}"),
    st.integers(-(10**18), 10**18).map(str),
)


@given(st.lists(WORDS), st.sampled_from([" ", "\n", "\t", "  \r\n"]))
def test_any_numbers_come_back_as_float_reads_them(words: list[str], between: str) -> None:
    found = read(between.join(words).encode())
    assert np.array(found).tobytes() == np.array([float(word) for word in words]).tobytes()


@pytest.mark.nightly
@given(st.lists(st.text("0123456789.eE+-_ ", max_size=9)))
def test_whatever_is_refused_or_read_float_refuses_or_reads(words: list[str]) -> None:
    text = " ".join(words).encode()
    try:
        expected = [float(word) for word in text.split()]
    except ValueError:
        with pytest.raises(ValueError):
            read(text)
    else:
        assert np.array(read(text)).tobytes() == np.array(expected).tobytes()


@pytest.mark.nightly
def test_where_a_text_is_taken_apart_and_by_how_many_threads_does_not_show(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rows = np.random.default_rng(3).normal(size=(500, 7)) * 100
    text = "\n".join(" ".join(f"{x:.5f}" for x in row) for row in rows).encode() + b"\n"
    whole = read(text)
    monkeypatch.setattr(decimal_text, "_PIECE", 50)
    for threads_from in (1, 1 << 30):
        monkeypatch.setattr(decimal_text, "_THREADS_FROM", threads_from)
        assert read(text) == whole
