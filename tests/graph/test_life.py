"""The dials of life: complete, within their ranges, saved with the project."""

from __future__ import annotations

from typing import Any, get_type_hints

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.formats.project.data import decode_struct, encode_struct, from_data, to_data
from metagraph.graph.life import (
    DIALS,
    MANNER_DIALS,
    MANNERS,
    Dial,
    Face,
    FacePose,
    Life,
    Manner,
    get_manner,
    list_limits,
    with_life,
)
from metagraph.graph.model import MODES, Project

TABLES = ((Life, DIALS), (Manner, MANNER_DIALS))


def numbers(kind: type[msgspec.Struct]) -> set[str]:
    """The fields that hold a number."""
    hints = get_type_hints(kind)
    return {f.name for f in msgspec.structs.fields(kind) if hints[f.name] is float}


@pytest.mark.parametrize(("kind", "dials"), TABLES)
def test_every_number_has_one_dial_and_every_dial_a_number(kind: Any, dials: tuple[Dial, ...]) -> None:
    assert sorted(d.name for d in dials) == sorted(numbers(kind))


@pytest.mark.parametrize(("kind", "dials"), TABLES)
def test_dials_have_the_ranges_their_fields_accept(kind: Any, dials: tuple[Dial, ...]) -> None:
    ranges = list_limits(kind)
    for dial in dials:
        assert (dial.low, dial.high) == ranges[dial.name], dial.name
        assert 0 < dial.step < dial.high - dial.low
        assert dial.low <= getattr(kind(), dial.name) <= dial.high
        assert dial.label and dial.tip.endswith(".") and dial.group


@pytest.mark.parametrize(("kind", "dials"), TABLES)
def test_what_turns_a_dial_off_lies_in_its_range_and_is_not_its_default(
    kind: Any, dials: tuple[Dial, ...]
) -> None:
    for dial in dials:
        if dial.off is not None:
            assert dial.low <= dial.off <= dial.high
            assert dial.off != getattr(kind(), dial.name) or dial.name == "stillness"
    assert {d.name for d in dials if d.off is None} <= {
        "blink_close",
        "blink_open",
        "valence",
        "arousal",
        "intensity",
    }, "all others are amounts and can be turned off"


def test_a_blink_lasts_as_long_as_the_paper_says() -> None:
    assert Life().blink_close == 0.07 and Life().blink_open == pytest.approx(0.17 - 0.07)


def test_a_mode_has_the_manner_it_is_given_else_the_default() -> None:
    life = with_life(Life(), mode="talking", blinks=2.0)
    assert get_manner(life, "talking") == msgspec.structs.replace(MANNERS["talking"], blinks=2.0)
    assert get_manner(life, "idle") == MANNERS["idle"]


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"blinks": 61}, "blinks"),
        ({"blinks": -1}, "blinks"),
        ({"stillness": float("nan")}, "stillness"),
        ({"lips": "much"}, "lips"),
        ({"nose": 1.0}, "no dial 'nose'"),
    ],
)
def test_a_value_outside_its_range_is_refused_by_name(changes: dict[str, Any], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        with_life(Life(), **changes)


def test_a_mode_that_does_not_exist_is_refused() -> None:
    with pytest.raises(ValueError, match="no mode 'asleep'"):
        with_life(Life(), mode="asleep", blinks=1)  # type: ignore[arg-type]


def test_life_at_its_defaults_takes_no_room_in_a_file() -> None:
    assert encode_struct(Life()) == {} and encode_struct(Face()) == {}


lives = st.builds(
    Life,
    on=st.booleans(),
    **{
        d.name: st.floats(d.low, d.high)
        .map(lambda x: round(x, 3))
        .filter(lambda x, d=d: d.low <= x <= d.high)
        for d in DIALS
    },
    modes=st.dictionaries(
        st.sampled_from(MODES),
        st.builds(Manner, blinks=st.sampled_from([0.0, 0.5, 1.0, 4.0]), saccades=st.sampled_from([1.0, 2.0])),
    ),
)


@given(lives)
def test_whatever_is_set_comes_back_from_the_file(life: Life) -> None:
    assert decode_struct(encode_struct(life), Life, "life") == life


def test_a_face_comes_back_from_the_file() -> None:
    face = Face(
        channels={"jaw_open": "Chin", "blink": ""},
        poses={"viseme_aa": FacePose(clip="c1", frame=3)},
        morphs=("A", "I"),
    )
    project = Project(face=face, life=with_life(Life(), mode="idle", blinks=0.5))
    again = from_data(to_data(project))
    assert again.face == face and again.life == project.life
