"""Conversations written for ELAN and Praat: files those programs take, and what is read back is what was
written.
"""

from __future__ import annotations

import itertools
import xml.etree.ElementTree as ET
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from metagraph.errors import FileError
from metagraph.formats.conversations.writers import write_elan, write_json, write_textgrid
from metagraph.formats.elan import read_elan
from metagraph.formats.transcripts.reader import read_transcript
from metagraph.graph.conversation.model import EVERYBODY, SPOKEN, Conversation, Segment, Side, Word
from metagraph.speech.textgrid import read_textgrid

WRITERS: dict[str, Callable[[Conversation, Path], None]] = {
    ".eaf": write_elan,
    ".TextGrid": write_textgrid,
    ".json": write_json,
}


def words(*rows: tuple[str, float, float]) -> tuple[Word, ...]:
    return tuple(Word(text=t, start=a, end=b) for t, a, b in rows)


ANN = Side(
    name="Ann",
    audio="sound/talk one.wav",
    channel=0,
    words=words(
        ('"so"', 0.5, 0.7), ("we", 0.7, 0.9), ("left & <ran>", 0.9, 1.4), ("home", 2, 2.2), ("then", 2.2, 3)
    ),
    segments=(
        Segment("clause", 0.5, 1.4, 0.95, '"so" we left & <ran>'),
        Segment("hesitation", 1.4, 1.6, None, "uh"),
        Segment("clause", 2, 3, 2),
    ),
)
BEN = Side(name="Ben", audio="sound/talk one.wav", channel=1, segments=(Segment("response", 3.25, 3.5),))
TALK = Conversation(name="A talk", length=8.5, sides=(ANN, BEN))


@pytest.mark.parametrize("suffix", WRITERS)
def test_a_peak_where_one_clause_ends_is_not_the_nexts(tmp_path: Path, suffix: str) -> None:
    found = (Segment("clause", 0.0, 1.0, 1.0), Segment("clause", 1.0, 2.0, 1.4))
    WRITERS[suffix](
        Conversation(name="x", length=2.0, sides=(Side(name="A", segments=found), Side(name="B"))),
        tmp_path / f"a{suffix}",
    )
    back = read_transcript(tmp_path / f"a{suffix}").segments["A"]
    assert [s.peak for s in back] == [1.0, 1.4]


@pytest.mark.parametrize("suffix", WRITERS)
def test_what_is_written_is_read_back(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"a{suffix}"
    WRITERS[suffix](TALK, path)
    found = read_transcript(path)
    assert list(found.speakers) == ["Ann", "Ben"] and found.speakers["Ben"] == ()
    assert [w.text for w in found.speakers["Ann"]] == ['"so"', "we", "left & <ran>", "home", "then"]
    assert found.segments == {"Ann": TALK.sides[0].segments, "Ben": TALK.sides[1].segments}


def test_elan_gets_its_media_and_ordered_time_slots(tmp_path: Path) -> None:
    write_elan(TALK, tmp_path / "a.eaf", tmp_path)
    root = ET.parse(tmp_path / "a.eaf").getroot()
    assert [e.tag for e in root] == ["HEADER", "TIME_ORDER", *["TIER"] * 6, "LINGUISTIC_TYPE"]
    (media,) = root.findall("HEADER/MEDIA_DESCRIPTOR")
    assert (
        media.get("RELATIVE_MEDIA_URL") == "./sound/talk one.wav" and media.get("MIME_TYPE") == "audio/x-wav"
    )
    assert (media.get("MEDIA_URL") or "").startswith("file:///") and (media.get("MEDIA_URL") or "").endswith(
        "sound/talk%20one.wav"
    )
    slots = {s.get("TIME_SLOT_ID"): int(s.get("TIME_VALUE") or -1) for s in root.iter("TIME_SLOT")}
    assert list(slots.values()) == sorted(slots.values())
    used = [m.get(f"TIME_SLOT_REF{n}") for m in root.iter("ALIGNABLE_ANNOTATION") for n in (1, 2)]
    assert sorted(used) == sorted(slots)  # each once: those that were shared would move together
    for tier in root.iter("TIER"):
        spans = [
            (slots[m.get("TIME_SLOT_REF1")], slots[m.get("TIME_SLOT_REF2")])
            for m in tier.iter("ALIGNABLE_ANNOTATION")
        ]
        assert all(a < b for a, b in spans) and all(x[1] <= y[0] for x, y in itertools.pairwise(spans))
    types = {t.get("LINGUISTIC_TYPE_ID") for t in root.iter("LINGUISTIC_TYPE")}
    assert {t.get("LINGUISTIC_TYPE_REF") for t in root.iter("TIER")} == types
    assert [t.name for t in read_elan(tmp_path / "a.eaf").tiers][:3] == [
        "words@Ann",
        "segments@Ann",
        "peaks@Ann",
    ]


def test_praat_gets_tiers_that_cover_the_whole_time(tmp_path: Path) -> None:
    write_textgrid(TALK, tmp_path / "a.TextGrid")
    grid = read_textgrid(tmp_path / "a.TextGrid")
    assert (grid.start, grid.end) == (0, 8.5)
    assert [t.name for t in grid.tiers] == [
        f"{who} - {what}" for who in ("Ann", "Ben") for what in ("words", "segments", "peaks")
    ]
    for tier in grid.tiers:
        if tier.points:
            assert [i.start for i in tier.intervals] == ([0.95, 2] if tier.name.startswith("Ann") else [])
            continue
        assert tier.intervals[0].start == 0 and tier.intervals[-1].end == 8.5
        assert all(a.end == b.start for a, b in zip(tier.intervals, tier.intervals[1:], strict=False))


def test_two_of_one_name_and_none_are_told_apart(tmp_path: Path) -> None:
    for names, want in ((("Ann", "ann"), ["Ann 1", "ann 2"]), (("", ""), ["Speaker 1", "Speaker 2"])):
        sides = tuple(Side(name=n, words=words(("hi", 1, 2))) for n in names)
        write_textgrid(Conversation(name="x", length=3, sides=sides), tmp_path / "a.TextGrid")
        assert list(read_transcript(tmp_path / "a.TextGrid").speakers) == want


def test_a_place_that_cannot_be_written_says_so(tmp_path: Path) -> None:
    (tmp_path / "a.eaf").mkdir()
    with pytest.raises(FileError):
        write_elan(TALK, tmp_path / "a.eaf")


spoken = st.text(st.characters(codec="utf-8"), max_size=8)
marks = st.lists(
    st.tuples(st.sampled_from(SPOKEN), st.integers(0, 900), st.integers(40, 3000), st.floats(0, 1), spoken),
    max_size=5,
)


@pytest.mark.nightly
@settings(max_examples=80, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(marks, st.lists(st.tuples(spoken, st.integers(0, 9000), st.integers(0, 900)), max_size=5))
def test_any_conversation_keeps_its_segments(
    tmp_path: Path, rows: list[tuple[str, int, int, float, str]], texts: list[tuple[str, int, int]]
) -> None:
    at, found = 0, []
    for kind, gap, length, share, text in rows:
        start, end = at + gap, at + gap + length
        peak = round(start + share * length) / 1000 if kind == "clause" else None
        found.append(Segment(kind, start / 1000, end / 1000, peak, text))
        at = end
    sides = (
        Side(
            name="A",
            segments=tuple(found),
            words=words(*((t, a / 1000, (a + b) / 1000) for t, a, b in texts)),
        ),
        Side(name="B"),
    )
    made = Conversation(name="x", length=max(at / 1000, 1.0), sides=sides)
    for suffix, write in WRITERS.items():
        write(made, tmp_path / f"a{suffix}")
        back = read_transcript(tmp_path / f"a{suffix}")
        for s, t in zip(found, back.segments["A"], strict=True):
            assert (s.kind, s.start, s.end, s.peak) == (t.kind, t.start, t.end, t.peak), suffix


@pytest.mark.parametrize("suffix", WRITERS)
def test_of_three_whom_each_segment_is_said_to_is_read_back(tmp_path: Path, suffix: str) -> None:
    rows = ((1, "you"), (EVERYBODY, "all of you"), (None, ""), (2, "to us: now"))
    ann = Side(
        name="Ann",
        segments=tuple(Segment("clause", n, n + 0.9, n + 0.5, text, to) for n, (to, text) in enumerate(rows)),
    )
    cleo = Side(name="Cleo Day", segments=(Segment("response", 5, 6, None, "yes", 0),))
    made = Conversation(name="t", length=9.0, sides=(ann, BEN, cleo))
    WRITERS[suffix](made, tmp_path / f"a{suffix}")
    found = read_transcript(tmp_path / f"a{suffix}")
    assert found.segments == {"Ann": ann.segments, "Ben": BEN.segments, "Cleo Day": cleo.segments}


def test_three_of_one_name_stay_apart(tmp_path: Path) -> None:
    write_textgrid(Conversation(name="t", length=9.0, sides=(ANN, ANN, BEN, ANN)), tmp_path / "a.TextGrid")
    assert list(read_transcript(tmp_path / "a.TextGrid").speakers) == ["Ann 1", "Ann 2", "Ben", "Ann 4"]
