"""Small words."""

from __future__ import annotations

import pytest

from app.look.plural import many, short


@pytest.mark.parametrize(
    ("name", "stance", "expected"),
    [
        ("", "idle", ""),
        ("idle", "idle", "idle"),
        ("hands_at_sides__shrug_01", "hands at sides", "shrug_01"),
        ("IdleSeatedBack01_Shrug01", "IdleSeatedBack01", "Shrug01"),
        ("idler_shrug", "idle", "idler_shrug"),
        ("shrug", "idle", "shrug"),
        ("idle__", "idle", "idle__"),
        ("Idle - wave", "idle", "wave"),
    ],
)
def test_a_stances_name_in_front_of_its_actions_is_left_out(name, stance, expected):
    assert short(name, stance) == expected


def test_one_is_one_and_thousands_are_grouped():
    assert many(1, "clip") == "1 clip"
    assert many(2328, "connection") == "2,328 connections"
    assert many(0, "state") == "0 states"
