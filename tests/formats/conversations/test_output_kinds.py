"""Conversations are written as captions and mouth shapes, too, and what is read back is what was written."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.cli.speech_command import OUT
from metagraph.errors import FileError
from metagraph.formats.conversations.captions import MOST
from metagraph.formats.conversations.output_kinds import CONVERSATION_OUTPUTS, write_conversation
from metagraph.formats.transcripts.reader import read_transcript
from metagraph.graph.conversation.model import Conversation, Side, Word
from metagraph.speech.mouth_files.registry import read_mouth_file


def words(text: str, begin: float, each: float = 0.3) -> tuple[Word, ...]:
    return tuple(
        Word(text=word, start=round(begin + each * n, 3), end=round(begin + each * (n + 0.9), 3))
        for n, word in enumerate(text.split())
    )


ANN = Side(name="Ann", words=words('Well, "so" we left if a<b home', 0.5))
BEN = Side(name="Ben > Co", words=(*words("Did you?", 3.1), *words("I see.", 6.0)))
TALK = Conversation(name="A talk", length=8.0, sides=(ANN, BEN))


def test_the_command_line_offers_what_can_be_written() -> None:
    assert [kind.ending for kind in CONVERSATION_OUTPUTS] == list(OUT)


def test_webvtt_keeps_speakers_words_and_when_each_begins(tmp_path: Path) -> None:
    path = tmp_path / "talk.vtt"
    write_conversation(TALK, path)
    assert path.read_text().startswith("WEBVTT\n\n00:00:00.500 --> ")
    read = read_transcript(path)
    assert list(read.speakers) == ["Ann", "Ben Co"]
    for said, written in zip(read.speakers.values(), TALK.sides, strict=True):
        assert [w.text for w in said] == [w.text for w in written.words]
        assert [w.start for w in said] == pytest.approx([w.start for w in written.words], abs=0.002)


def test_subrip_names_speakers_where_there_are_several(tmp_path: Path) -> None:
    path = tmp_path / "talk.srt"
    write_conversation(TALK, path)
    lines = path.read_text().splitlines()
    assert lines[:2] == ["1", "00:00:00,500 --> 00:00:02,570"]
    assert lines[2] == 'Ann: Well, "so" we left if a<b home'
    write_conversation(Conversation(name="x", length=8.0, sides=(ANN,)), path)
    assert path.read_text().splitlines()[2] == 'Well, "so" we left if a<b home'


def test_captions_end_at_pauses_and_stay_short(tmp_path: Path) -> None:
    long = Side(name="Ann", words=words("and so on " * 40, 0.0))
    path = tmp_path / "long.srt"
    write_conversation(Conversation(name="x", length=40.0, sides=(long, BEN)), path)
    lines = [line for line in path.read_text().split("\n") if line.startswith("Ann: ")]
    assert len(lines) > 4 and max(map(len, lines)) <= MOST + len("Ann: ")
    assert sum(line.startswith("Ben > Co: ") for line in path.read_text().split("\n")) == 2


@pytest.mark.parametrize("ending", [".vtt", ".srt", ".tsv"])
def test_what_needs_words_is_refused_without_them(tmp_path: Path, ending: str) -> None:
    silent = Conversation(name="x", length=3.0, sides=(Side(name="Ann"), Side(name="Ben")))
    with pytest.raises(FileError, match=r"this conversation has none|of one speaker; 0 have words"):
        write_conversation(silent, tmp_path / f"a{ending}")
    assert not (tmp_path / f"a{ending}").exists()


def test_an_ending_that_nothing_writes_is_refused_with_those_that_are(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"not written as '\.doc'.*\.vtt"):
        write_conversation(TALK, tmp_path / "a.doc")


def test_rhubarbs_shapes_close_lips_for_m_and_rest_at_the_end(tmp_path: Path) -> None:
    spoken_words = Word(text="mama", start=1.0, end=1.8), Word(text="fee", start=2.2, end=2.6)
    said = Side(name="Ann", words=spoken_words)
    path = tmp_path / "ann.tsv"
    write_conversation(Conversation(name="x", length=4.0, sides=(said, Side(name="Ben"))), path)
    rows = [line.split("\t") for line in path.read_text().splitlines()]
    times, shapes = [float(r[0]) for r in rows], [r[1] for r in rows]
    assert times == sorted(times) and shapes[0] == shapes[-1] == "X"
    spoken = [s for t, s in zip(times, shapes, strict=True) if 0.9 <= t < 1.9]
    assert spoken.count("A") >= 2 and spoken.count("D") >= 2, "m, a, m, a"
    assert "G" in [s for t, s in zip(times, shapes, strict=True) if 2.0 <= t < 2.5], "f"
    read = read_mouth_file(path, 4.0)
    assert read.pieces and any("Rhubarb" in note for note in read.notes)


def test_two_speakers_have_no_mouth_in_common(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="of one speaker; 2 have words"):
        write_conversation(TALK, tmp_path / "a.tsv")
