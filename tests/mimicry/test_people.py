"""Following one of several people."""

from __future__ import annotations

import numpy as np

from metagraph.mimicry.people import SeenPerson, follow_person


def person(x: float, size: float = 1.0, ident: int | None = None) -> SeenPerson:
    points = np.array([[x, 0, 0], [x, size, 0], [x + 0.3 * size, size / 2, 0], [x - 0.3 * size, size / 2, 0]])
    return SeenPerson(points, np.ones(4), ident)


def followed(
    frames: list[list[SeenPerson]], times: list[float] | None = None, middle: float | None = None
) -> list[float | None]:
    times = [n / 25 for n in range(len(frames))] if times is None else times
    return [None if p is None else float(p.points[0, 0]) for p in follow_person(times, frames, middle)]


def test_nobody_is_followed_where_nobody_is() -> None:
    assert followed([[], []]) == [None, None]
    assert followed([]) == []


def test_too_few_points_or_all_in_one_place_are_nobody() -> None:
    few = SeenPerson(np.ones((4, 3)), np.array([1.0, 1.0, 0, 0]))
    one = SeenPerson(np.ones((4, 3)), np.ones(4))
    assert followed([[few], [one]]) == [None, None]


def test_the_largest_is_followed_and_of_those_the_one_in_the_middle() -> None:
    assert followed([[person(1, 1.0), person(5, 2.0)]]) == [5]
    assert followed([[person(0.5, 1.1), person(5, 1.0)]], middle=5.0) == [5]


def test_somebody_is_followed_while_others_cross_and_change_places_in_the_list() -> None:
    frames = [[person(0.1 * n), person(4 - 0.1 * n, 1.3)][:: 1 if n % 2 else -1] for n in range(15)]
    assert np.allclose(np.array(followed(frames), float), 4 - 0.1 * np.arange(15))


def test_numbers_that_the_file_gives_are_believed_before_places() -> None:
    frames = [[person(0, 2.0, 7), person(1, 1.0, 8)], [person(0, 2.0, 8), person(1, 1.4, 7)]]
    assert followed(frames) == [0, 1]


def test_nobody_else_is_taken_for_somebody_who_is_lost_for_a_moment() -> None:
    frames = [[person(0, 2.0), person(9)], [person(9)], [person(9)], [person(0, 2.0), person(9)]]
    assert followed(frames, [0, 0.3, 0.6, 0.9]) == [0, None, None, 0]


def test_after_a_while_somebody_else_is_followed() -> None:
    frames = [[person(0, 2.0)], *[[person(9)]] * 3]
    assert followed(frames, [0, 0.5, 1.01, 1.1]) == [0, None, 9, 9]


def test_somebody_of_quite_another_size_is_somebody_else() -> None:
    assert followed([[person(0, 1.0)], [person(0, 3.0)]]) == [0, None]
