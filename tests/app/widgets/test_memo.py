"""Things are made again only when what they are made of has changed."""

from __future__ import annotations

from app.widgets.memo import Once


def test_equal_values_and_the_same_objects_make_nothing_new():
    made: list[int] = []
    once: Once[int] = Once()
    big = [1]

    def get(value: float, thing: object) -> int:
        return once.of((value,), (thing,), lambda: made.append(0) or len(made))

    assert [get(1.0, big), get(1.0, big)] == [1, 1]
    assert get(2.0, big) == 2
    assert get(2.0, [1]) == 3, "an equal object is another one"
