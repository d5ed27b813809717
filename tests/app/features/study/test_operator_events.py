"""Operators are counted exactly, each once."""

from __future__ import annotations

from app.features.study.operator_events import OperatorEvents

LEFT, RIGHT = 1, 2


def count(operators: OperatorEvents, now: float = 1000.0) -> dict[str, int]:
    return {k: v for k, v in operators.take(now).operators.items() if v}


def test_nothing_is_nothing():
    assert count(OperatorEvents()) == {}


def test_a_key_counts_once_however_many_are_told_of_it():
    o = OperatorEvents()
    for stamp in (1, 1, 1):
        o.key(65, True, stamp)
    o.key(65, False, 2)
    assert count(o) == {"K": 1}


def test_two_keys_held_and_one_struck_again_are_three():
    o = OperatorEvents()
    o.key(1, True, 1)
    o.key(2, True, 2)
    o.key(2, False, 3)
    o.key(2, True, 4)
    assert count(o) == {"K": 3}


def test_a_key_whose_release_went_to_another_program_counts_again():
    o = OperatorEvents()
    o.key(1, True, 10)
    o.key(1, True, 900)
    assert count(o) == {"K": 2}


def test_a_key_that_is_asked_about_and_then_pressed_counts_once():
    o = OperatorEvents()
    for _ in range(2):
        o.key(1, True, 7, asked=True)
        o.key(1, True, 7, asked=True)
        o.key(1, True, 0)
        o.key(1, True, 0)
        o.key(1, False, 8)
    o.key(2, True, 9, asked=True)  # a shortcut: no press follows
    o.key(2, False, 10)
    assert count(o) == {"K": 3}


def test_a_click_where_the_pointer_is_is_two_buttons():
    o = OperatorEvents()
    o.move((5, 5), False, 0.0)
    for _ in range(2):  # first the window gets it, then the widget
        o.press(LEFT, (5, 5), 1.0)
    for _ in range(2):
        o.release(LEFT, (5, 5), 1.1)
    assert count(o) == {"B": 2}


def test_going_somewhere_and_clicking_is_a_pointing_and_two_buttons():
    o = OperatorEvents()
    o.move((0, 0), False, 0.0)
    for n in range(1, 11):
        o.move((n * 10, 0), False, n * 0.02)
    o.press(LEFT, (100, 0), 0.25)
    o.release(LEFT, (102, 0), 0.3)
    assert count(o) == {"P": 1, "B": 2}


def test_a_tremble_is_no_pointing():
    o = OperatorEvents()
    o.move((0, 0), False, 0.0)
    o.move((5, 5), False, 0.1)
    o.press(LEFT, (5, 5), 0.2)
    o.release(LEFT, (5, 5), 0.3)
    assert count(o) == {"B": 2}


def test_a_rest_ends_a_pointing_once():
    o = OperatorEvents()
    o.move((0, 0), False, 0.0)
    o.move((50, 0), False, 0.1)
    o.move((60, 0), False, 1.0)  # rested before
    o.press(LEFT, (60, 0), 1.1)
    o.release(LEFT, (60, 0), 1.2)
    assert count(o) == {"P": 2, "B": 2}
    assert count(o) == {}


def test_a_pointer_on_its_way_when_it_is_counted_is_counted_later():
    o = OperatorEvents()
    o.move((0, 0), False, 0.0)
    o.move((50, 0), False, 0.1)
    assert count(o, 0.2) == {}
    assert count(o, 0.5) == {"P": 1}


def test_a_drag_is_one_with_its_buttons_and_seconds():
    o = OperatorEvents()
    o.move((0, 0), False, 0.0)
    o.press(LEFT, (0, 0), 1.0)
    o.move((30, 0), True, 1.5)
    o.move((2, 0), True, 2.0)  # and back again
    o.release(LEFT, (2, 0), 3.0)
    found = o.take(4.0)
    assert dict(found.operators) == {"B": 2, "D": 1}
    assert (found.drag_s, found.seconds) == (2.0, 4.0)


def test_a_drag_between_programs_ends_with_its_drop():
    o = OperatorEvents()
    o.press(LEFT, (0, 0), 1.0)
    o.move((30, 0), True, 1.5)
    o.drop(2.0)
    o.drop(2.0)
    assert count(o) == {"B": 2, "D": 1}


def test_a_drag_that_nobody_took_ends_when_the_pointer_moves_freely():
    o = OperatorEvents()
    o.press(LEFT, (0, 0), 1.0)
    o.move((30, 0), True, 1.5)
    o.move((31, 0), False, 9.0)
    found = o.take(10.0)
    assert dict(found.operators) == {"B": 2, "D": 1}
    assert found.drag_s == 0.5


def test_two_buttons_at_once_are_four():
    o = OperatorEvents()
    o.press(LEFT, (0, 0), 1.0)
    o.press(RIGHT, (0, 0), 1.0)
    o.release(LEFT, (0, 0), 1.0)
    o.release(RIGHT, (0, 0), 1.0)
    assert count(o) == {"B": 4}


def test_hands_that_change_over_are_counted():
    o = OperatorEvents()
    o.press(LEFT, (0, 0), 1.0)
    o.release(LEFT, (0, 0), 1.0)
    o.key(1, True, 1)
    o.key(2, True, 2)
    o.press(LEFT, (0, 0), 2.0)
    assert count(o) == {"B": 3, "K": 2, "H": 2}
