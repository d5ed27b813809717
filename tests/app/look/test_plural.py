"""Small words."""

from __future__ import annotations

import pytest

from app.look.plural import strip_stance
from app.translation import tr_plural


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
        ("ChrBrad@Idle01_Scratch01", "idle 1", "Scratch01"),
        ("ChrBrad@Idle01_ToIdle03", "idle 1", "ToIdle03"),
        ("ChrBrad@Idle10_Scratch01", "idle 1", "ChrBrad@Idle10_Scratch01"),
        ("Hero|立ち01_頷く", "立ち 1", "頷く"),
        ("wave_idle_left", "idle", "wave_idle_left"),
        ("hands_at_sides__shrug", "", "hands_at_sides__shrug"),
    ],
)
def test_a_stances_name_in_front_of_its_actions_is_left_out(name, stance, expected):
    assert strip_stance(name, stance) == expected


def test_one_is_one_and_thousands_are_grouped():
    assert tr_plural("{count:,} clip", "{count:,} clips", 1) == "1 clip"
    assert tr_plural("{count:,} connection", "{count:,} connections", 2328) == "2,328 connections"
    assert tr_plural("{count:,} state", "{count:,} states", 0) == "0 states"
