from dataclasses import replace

import pytest

from metagraph.motion.contact_spans import ContactKey, ContactSpan, contact_key, contact_weight

STILL = (0.0, 0.0, 0.0, 1.0)
ROUND = (0.0, 1.0, 0.0, 0.0)
SPAN = ContactSpan(
    "right", "palm", "Chest", 1.0, 3.0,
    (ContactKey(1.0, (0.0, 0.0, 0.0), STILL), ContactKey(2.0, (0.1, 0.0, 0.2), (0.0, 0.6, 0.0, 0.8))),
    0.5, 0.2,
)  # fmt: skip


def test_a_hand_comes_and_goes_within_the_span() -> None:
    weights = [contact_weight(SPAN, t, 0.0, 4.0) for t in (0.9, 1.0, 1.25, 1.5, 2.7, 2.85, 3.0, 3.1)]
    assert weights == pytest.approx([0, 0, 0.5, 1, 1, 0.5, 0, 0])


def test_a_hand_takes_the_time_that_a_short_contact_leaves_it() -> None:
    short = replace(SPAN, start=1.0, end=1.4, ease_in=0.1, ease_out=0.1)
    assert contact_weight(short, 1.1, 0.0, 4.0) == pytest.approx(0.5)  # 0.2 s each way
    assert contact_weight(short, 1.2, 0.0, 4.0) == 1
    assert contact_weight(short, 1.15, 0.0, 1.4) == pytest.approx(0.5)  # 0.3 s, it stays to the end
    assert contact_weight(replace(short, ease_in=0.0), 1.0, 0.0, 1.4) == 1


def test_a_hand_that_is_there_from_the_beginning_or_to_the_end_does_not_come_or_go() -> None:
    assert contact_weight(SPAN, 1.0, 1.0, 4.0) == 1
    assert contact_weight(SPAN, 3.0, 0.0, 3.0) == 1


def test_between_keys_a_hand_goes_straight_and_beyond_them_it_stays() -> None:
    half = contact_key(SPAN, 1.5)
    assert half.at == pytest.approx((0.05, 0.0, 0.1))
    assert half.turn[1] / half.turn[3] == pytest.approx(0.6 / 1.8)
    assert contact_key(SPAN, 0.0).at == (0.0, 0.0, 0.0)
    assert contact_key(SPAN, 9.0) == SPAN.keys[1]


def test_turns_on_opposite_sides_are_joined_by_the_shorter_way() -> None:
    there = ContactKey(1.0, (0.0, 0.0, 0.0), (0.0, -0.6, 0.0, -0.8))
    span = ContactSpan("left", "back", "Head", 0.0, 1.0, (ContactKey(0.0, (0.0, 0.0, 0.0), STILL), there))
    assert contact_key(span, 0.5).turn[1] / contact_key(span, 0.5).turn[3] == pytest.approx(0.6 / 1.8)
