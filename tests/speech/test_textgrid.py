"""Praat's TextGrid: real files of both formats, broken ones with a reason, anything at all without a
crash.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from metagraph.errors import FileError
from metagraph.speech.textgrid import TextGrid, read_textgrid

SHORT = """File type = "ooTextFile"
Object class = "TextGrid"

0
1.5
<exists>
2
"IntervalTier"
"phones"
0
1.5
2
0
0.5
""
0.5
1.5
"a ""b"" c"
"TextTier"
"stress"
0
1.5
1
0.7
"H*"
"""
LONG = """File type = "ooTextFile"
Object class = "TextGrid"

xmin = 0
xmax = 1.5
tiers? <exists>
size = 2
item []:
    item [1]:
        class = "IntervalTier"
        name = "phones"
        xmin = 0
        xmax = 1.5
        intervals: size = 2
        intervals [1]:
            xmin = 0
            xmax = 0.5
            text = ""
        intervals [2]:
            xmin = 0.5
            xmax = 1.5
            text = "a ""b"" c"
    item [2]:
        class = "TextTier"
        name = "stress"
        xmin = 0
        xmax = 1.5
        points: size = 1
        points [1]:
            number = 0.7
            mark = "H*"
"""


def read(tmp_path: Path, text: str | bytes, encoding: str = "utf-8") -> TextGrid:
    path = tmp_path / "line.TextGrid"
    path.write_bytes(text if isinstance(text, bytes) else text.encode(encoding))
    return read_textgrid(path)


@pytest.mark.parametrize("text", [SHORT, LONG], ids=["short", "long"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_both_formats_say_the_same_in_any_encoding(tmp_path: Path, text: str, encoding: str) -> None:
    grid = read(tmp_path, text, encoding)
    phones, stress = grid.tiers
    assert (grid.start, grid.end) == (0, 1.5)
    assert [(i.start, i.end, i.text) for i in phones.intervals] == [(0, 0.5, ""), (0.5, 1.5, 'a "b" c')]
    assert stress.points and [(i.start, i.end, i.text) for i in stress.intervals] == [(0.7, 0.7, "H*")]


def test_windows_lines_and_the_systems_own_encoding_are_read(tmp_path: Path) -> None:
    grid = read(tmp_path, SHORT.replace("\n", "\r\n").replace("H*", "\xfc").encode("latin-1"))
    assert grid.tiers[1].intervals[0].text == "ü"


def test_a_grid_without_tiers_is_empty(tmp_path: Path) -> None:
    assert read(tmp_path, 'File type = "ooTextFile"\nObject class = "TextGrid"\n0 1 <absent>').tiers == ()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "line 1"),
        ("hello", "ends before its file type"),
        (SHORT.replace("TextGrid", "Pitch 1"), "not a TextGrid but 'ooTextFile', 'Pitch 1'"),
        (SHORT[: SHORT.index("0.5")], "ends before its interval's end"),
        (SHORT.replace("IntervalTier", "SoundTier"), "no tier of class 'SoundTier'"),
        (SHORT.replace('0.5\n""', '-2\n""'), "ends at -2 s, before it starts at 0 s"),
        (SHORT.replace("<exists>\n2", "<exists>\n2.5"), "number of tiers is 2.5"),
        (SHORT.replace("<exists>\n2", "<exists>\n-1"), "number of tiers is -1"),
        (SHORT.replace("0.7", "1e300"), "interval's start is 1e300"),
        (b"ooBinaryFile\x08TextGrid", "binary Praat file"),
    ],
)
def test_what_is_wrong_is_said_with_the_line_and_the_remedy(
    tmp_path: Path, text: str | bytes, words: str
) -> None:
    with pytest.raises(FileError, match=r"line\.TextGrid") as told:
        read(tmp_path, text)
    assert words in str(told.value) and "Praat" in str(told.value)


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"none\.TextGrid"):
        read_textgrid(tmp_path / "none.TextGrid")


@pytest.mark.nightly
@settings(max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.data())
def test_a_damaged_file_is_read_or_refused(tmp_path: Path, data: st.DataObject) -> None:
    whole = bytearray(
        (SHORT if data.draw(st.booleans()) else LONG).encode(data.draw(st.sampled_from(["utf-8", "utf-16"])))
    )
    for _ in range(data.draw(st.integers(1, 6))):
        at = data.draw(st.integers(0, len(whole)))
        if data.draw(st.booleans()):
            whole[at : at + data.draw(st.integers(0, 40))] = data.draw(st.binary(max_size=20))
        else:
            del whole[at:]
    try:
        read(tmp_path, bytes(whole))
    except FileError as error:
        assert "line.TextGrid" in str(error)


def test_real_files_are_read(shared_data: Path) -> None:
    found = sorted((shared_data / "praatio-speech").glob("*.TextGrid"))
    assert len(found) > 10
    for path in found:
        grid = read_textgrid(path)
        assert grid.end > 0 and grid.tiers, path.name
    mary = read_textgrid(shared_data / "praatio-speech" / "mary_longfile.TextGrid")
    assert [t.name for t in mary.tiers] == ["phone", "word", "pitch"] and mary.tiers[1].intervals[
        1
    ].text == "mary"
