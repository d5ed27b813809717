"""Names we write, taken by Windows, macOS and Linux alike; Windows' rules are asked of `PureWindowsPath`."""

from __future__ import annotations

import sys
from pathlib import PureWindowsPath

import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.common.budgets import NAME_BYTES
from metagraph.common.file_names import fold_file_name, make_file_stem, make_file_stems

DEVICES = ("CON", "nul", "Aux", "PRN", "COM1", "lpt9", "COM¹", "CONIN$")


def reserved(name: str) -> bool:
    if sys.version_info >= (3, 13):
        import ntpath

        return ntpath.isreserved(name)
    return PureWindowsPath(name).is_reserved()


def sound(stem: str) -> None:
    for ending in ("", ".json", ".controller.meta"):
        path = PureWindowsPath(stem + ending)
        assert path.name == stem + ending and len(path.parts) == 1  # no drive, no folder
        assert not reserved(stem + ending)
    assert not set(stem) & set('<>:"/\\|?*') and stem[-1] not in ". " and stem.isprintable()
    assert len(stem.encode()) <= NAME_BYTES + 2


@pytest.mark.parametrize("text", ["talk", "Wave 1", "été", "手を振る", "a.b-c_d", "console", "con man", "~x"])
def test_a_good_name_stays_as_it_is(text: str) -> None:
    assert make_file_stem(text) == text


@pytest.mark.parametrize("text", DEVICES)
def test_devices_of_windows_are_no_files(text: str) -> None:
    for name in (text, f"{text}.glb", f"{text}.tar.gz", f"{text} "):
        sound(make_file_stem(name))
        assert make_file_stem(name) != name


@pytest.mark.parametrize(
    "text",
    [
        "",
        ".",
        "..",
        "   ",
        "...",
        "a:b",
        "a/../b",
        "C:\\x",
        "x.",
        "x ",
        "\ud800",
        "a\0b",
        "\u202etxt",
        "n" * 400,
        "ü" * 200,
        "e\u0301" * 300,
    ],
)
def test_what_no_system_takes_gets_another_name(text: str) -> None:
    sound(make_file_stem(text))
    assert make_file_stem(text) != text or text == "~"


@given(st.text())
def test_any_text_is_a_name(text: str) -> None:
    stem = make_file_stem(text)
    assert stem and len(stem.encode()) <= NAME_BYTES + 2 and len(PureWindowsPath(stem).parts) == 1
    assert not reserved(stem) and stem[-1] not in ". "


def test_cut_names_stay_apart() -> None:
    a, b = make_file_stem("n" * 400 + "1"), make_file_stem("n" * 400 + "2")
    assert a != b and a[:50] == b[:50]


def test_names_that_some_system_cannot_tell_apart_get_numbers() -> None:
    assert make_file_stems(["Wave", "wave", "WAVE", "wave-2", "bow"]) == [
        "Wave",
        "wave-2",
        "WAVE-3",
        "wave-2-2",
        "bow",
    ]
    composed, apart = "\u00e9", "e\u0301"
    assert (
        fold_file_name(composed) == fold_file_name(apart)
        and len(set(make_file_stems([composed, apart]))) == 2
    )
    assert make_file_stems(["a:", "a?"]) == ["a_", "a_-2"]


@given(st.lists(st.text(max_size=8), max_size=20))
def test_names_of_many_are_apart_on_any_disk(texts: list[str]) -> None:
    names = make_file_stems(texts)
    assert len({fold_file_name(n) for n in names}) == len(texts)
