"""Many decimal numbers as text at once: the same as one by one."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from metagraph.formats.decimal_lines import Lines, number

Array = NDArray[Any]

DIGITS = (6, 4, 1)
LINES = Lines(["at ", " ä ", "|", "\n"], DIGITS)


def one_by_one(numbers: Array) -> str:
    return "".join(
        "at {} ä {}|{}\n".format(*map(number, row, DIGITS)) for row in np.asarray(numbers, float).tolist()
    )


def test_no_lines_are_no_text() -> None:
    assert LINES.write(np.zeros((0, 3)), []) == []
    assert LINES.write(np.zeros((0, 3)), [0, 0]) == ["", ""]


def test_numbers_have_no_needless_digits_and_no_exponent() -> None:
    written = LINES.write(np.array([[1.5, -0.25, 3], [1e-5, 10, 100], [-1e-9, 0, -0.0]]), [3])
    assert written == ["at 1.5 ä -0.25|3\nat 0.00001 ä 10|100\nat 0 ä 0|0\n"]


@pytest.mark.parametrize("scale", [1e-6, 1e-3, 1, 1e3, 1e5])
def test_lines_are_those_of_each_number_by_itself(scale: float) -> None:
    numbers = np.random.default_rng(1).normal(size=(3000, 3)) * scale
    numbers[:500] = numbers[:500].round(3)
    numbers[500:600] = numbers[500:600].round()
    first, none, rest = LINES.write(numbers, [1000, 0, 2000])
    assert first == one_by_one(numbers[:1000]) and none == "" and rest == one_by_one(numbers[1000:])


def test_what_lies_between_two_numbers_is_rounded_as_exact_arithmetic_would() -> None:
    middles = (np.arange(-4000, 4000)[:, None] + 0.5) / 10.0 ** np.array(DIGITS)
    near = np.concatenate([middles, np.nextafter(middles, np.inf), np.nextafter(middles, -np.inf)])
    assert LINES.write(near, [len(near)]) == [one_by_one(near)]


@pytest.mark.parametrize("large", [999_998.9999996, 999_999.4, 1e6, -1e15, 1e300, np.inf, -np.inf, np.nan])
def test_numbers_of_any_size_are_written(large: float) -> None:
    numbers = np.array([[0.5, large, 1], [large, 0.5, large]])
    assert LINES.write(numbers, [1, 1]) == [one_by_one(numbers[:1]), one_by_one(numbers[1:])]
