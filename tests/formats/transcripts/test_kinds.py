"""A file of each tool's: the same words at the same times out of all of them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from metagraph.errors import FileError
from metagraph.formats.transcripts.reader import read_transcript
from metagraph.formats.transcripts.registry import TRANSCRIPT_READERS, find_transcript_reader
from metagraph.formats.transcripts.source import TranscriptSound, TranscriptSource
from metagraph.formats.transcripts.words import Transcript
from tests.formats.transcripts.made_transcripts import JSON_TRANSCRIPTS, WORDS, made_transcripts

FILES = made_transcripts()
# Kinds whose files name both speakers, and what they are called there.
NAMES = {
    **dict.fromkeys(("deepgram v1", "deepgram v1 utterances", "rev ai", "azure fast"), ("0", "1")),
    **dict.fromkeys(("rev.com", "transcriber", "chat wor"), ("Ann", "Ben")),
    **dict.fromkeys(("aws transcribe", "aws transcribe labels"), ("spk_0", "spk_1")),
    **dict.fromkeys(("google v1", "google v1 operation", "google v1 protobuf", "azure batch"), ("1", "2")),
    **dict.fromkeys(("assemblyai v2", "assemblyai v2 utterances", "google v2", "mfa csv"), ("A", "B")),
    **dict.fromkeys(("ttml", "substation"), ("Ann", "Ben")),
    "speechmatics": ("S1", "S2"),
    "gladia": ("0", "1"),
    "aws transcribe channels": ("ch_0", "ch_1"),
    "aws call analytics": ("AGENT", "CUSTOMER"),
    "elevenlabs scribe": ("speaker_0", "speaker_1"),
    "whisperx": ("SPEAKER_00", "SPEAKER_01"),
    "exmaralda": ("ANN", "BEN"),
}


def read(folder: Path, kind: str, text: str | None = None, seconds: float | None = 2.0) -> Transcript:
    name, made = FILES[kind]
    path = folder / name
    path.write_text(made if text is None else text, encoding="utf-8")
    return read_transcript(path, TranscriptSound(seconds, ("talk.wav",)))


@pytest.mark.parametrize("kind", FILES)
def test_every_kind_says_the_same_words_at_the_same_times(tmp_path: Path, kind: str) -> None:
    found = read(tmp_path, kind)
    words = sorted((w.start, w.text, w.end) for some in found.speakers.values() for w in some)
    assert [text for _, text, _ in words] == [word for word, *_ in WORDS]
    for (start, _, end), (_, first, last, _) in zip(words, WORDS, strict=True):
        assert (start, end) == pytest.approx(
            (first, 1.0 if kind == "polly" and last == 0.6 else last), abs=2e-3
        )


@pytest.mark.parametrize("kind", FILES)
def test_speakers_are_told_apart_where_the_file_names_them(tmp_path: Path, kind: str) -> None:
    found = read(tmp_path, kind)
    spoken = {name: [w.text for w in words] for name, words in found.speakers.items() if words}
    if kind in NAMES:
        assert spoken == dict(zip(NAMES[kind], (["so", "we"], ["yes"]), strict=True))
    else:
        assert len(spoken) == 1


@pytest.mark.parametrize("kind", FILES)
def test_every_kind_is_known_by_its_own_reader(tmp_path: Path, kind: str) -> None:
    name, text = FILES[kind]
    reader = find_transcript_reader(TranscriptSource(tmp_path / name, text))
    assert reader is not None
    first = kind.split()[0].split(".")[0].casefold()
    called = {
        "aws": "amazon", "rev": "rev ai", "mfa": "montreal", "partitur": "bas", "webmaus": "praat",
        "kaldi": "ctm", "polly": "amazon polly", "exmaralda": "exmaralda",
    }.get(first, first)  # fmt: skip
    if kind == "whisper tsv":
        called = "tables"
    assert called in reader.name.casefold()


def test_every_reader_in_the_registry_is_tried_by_a_made_file_or_has_tests_of_its_own() -> None:
    known = {find_transcript_reader(TranscriptSource(Path(name), text)) for name, text in FILES.values()}
    elsewhere = {"ELAN", "Metagraph", "IBM Speech to Text", "WebVTT, SubRip", "Chat logs"}
    assert {r.name for r in TRANSCRIPT_READERS} - {r.name for r in known if r is not None} == elsewhere


@pytest.mark.parametrize(
    ("kind", "change", "cause"),
    [
        ("google v1", ('"0.100s"', '"soon"'), "a time is 'soon'"),
        ("google v2", ('"results": {', '"rosults": {'), "not of a known"),
        ("aws transcribe", ('"0.1"', '"x"'), "a time is 'x'"),
        ("elevenlabs speech", ("[0.1, 0.2,", "[0.1,"), "9 characters, 8 starts and 9 ends"),
        ("azure batch", ("1000000.0", "true"), "a time is true or false"),
        ("rev ai", ('"monologues": [', '"monologues": [3, '), "not an object"),
        ("whisper.cpp", ('"offsets"', '"offset"'), "no start and end"),
        ("polly", ('"word"', '"sentence"'), "no marks of words"),
        ("exmaralda", ('start="T0"', 'start="T9"'), "'T9', which is not in the timeline"),
        ("exmaralda", ('type="t"', 'type="d"'), "no tier is a transcription"),
        ("transcriber", ('startTime="0.1"', 'startTime="now"'), "a time is 'now'"),
        ("transcriber", ("</Trans>", ""), "not well-formed XML"),
        ("chat wor", ("\x15", ""), "utterances have no times"),
        ("partitur", ("SAM: 16000", "SAM: 0"), "its sample rate"),
        ("partitur", ("MAU: 16000 6399 2", "MAU: 16000 x 2"), "does not have what belongs there"),
        ("kaldi ctm", ("utt 1 0.10 0.20 so", "SPEAKER utt 1 0.1 0.2 <NA> <NA> A <NA> <NA>"), "but no words"),
        ("cartesia", ('"end": [0.3, ', '"end": ['), "differ in length"),
        ("ttml", ('dur="0.4s"', ""), "a paragraph has no end"),
        ("ttml", ('begin="9f"', 'begin="soon"'), "a time is 'soon'"),
        ("substation", ("0:00:01.40", "0:00:00.40"), "a cue ends at 0.4 s, before it starts"),
        ("substation", ("0:00:00.10", "now"), "no start and end"),
        ("sbv", ("0:00:01.400", "0:00:00.400"), "a cue ends at 0.4 s, before it starts"),
        ("mfa csv", ("0.1,0.3,so", "a,0.3,so"), "no Begin, End, Label"),
        ("mfa json", ('[0.1, 0.3, "so"]', "[0.1]"), "no start, end and label"),
    ],
)
def test_what_is_missing_or_wrong_is_named(
    tmp_path: Path, kind: str, change: tuple[str, str], cause: str
) -> None:
    text = FILES[kind][1]
    assert change[0] in text
    with pytest.raises(FileError) as caught:
        read(tmp_path, kind, text.replace(*change))
    assert cause in str(caught.value) and caught.value.remedy


def test_xml_that_defines_entities_is_refused(tmp_path: Path) -> None:
    bomb = '<!DOCTYPE Trans [<!ENTITY a "so">]><Trans><Turn startTime="0" endTime="1">&a;</Turn></Trans>'
    with pytest.raises(FileError, match="entities"):
        read(tmp_path, "transcriber", bomb)


def test_points_of_a_timeline_without_a_time_lie_between_the_others(tmp_path: Path) -> None:
    found = read(tmp_path, "exmaralda", FILES["exmaralda"][1].replace('id="T1" time="0.3"', 'id="T1"'))
    assert [w.end for w in found.speakers["ANN"]] == pytest.approx([0.35, 0.6])
    assert any("timeline has no time" in note for note in found.notes)


def test_two_who_speak_at_once_in_transcriber_have_each_their_text(tmp_path: Path) -> None:
    said = '<Sync time="0"/><Who nb="1"/>so<Who nb="2"/>no'
    turn = f'<Turn speaker="spk1 spk2" startTime="0" endTime="1">{said}</Turn>'
    people = '<Speakers><Speaker id="spk1" name="Ann"/><Speaker id="spk2" name="Ben"/></Speakers>'
    text = f"<Trans>{people}{turn}</Trans>"
    found = read(tmp_path, "transcriber", text)
    assert {k: [(w.text, w.start, w.end) for w in v] for k, v in found.speakers.items() if v} == {
        "Ann": [("so", 0, 1)],
        "Ben": [("no", 0, 1)],
    }


def test_gentle_words_that_were_not_found_share_the_gap(tmp_path: Path) -> None:
    data = json.loads(FILES["gentle"][1])
    data["words"].insert(2, {"case": "not-found-in-audio", "word": "er"})
    found = read(tmp_path, "gentle", json.dumps(data))
    assert [(w.text, w.start, w.end) for w in found.speakers[""]][2] == ("er", 0.6, 1.0)
    assert any("no times of their own" in note for note in found.notes)


def test_parts_of_a_stream_follow_each_other(tmp_path: Path) -> None:
    part = JSON_TRANSCRIPTS["elevenlabs stream"]
    found = read(tmp_path, "elevenlabs stream", f"{json.dumps(part)}\n{json.dumps(part)}")
    assert [w.start for w in found.speakers[""]] == pytest.approx([0.1, 0.3, 1.0, 1.5, 1.7, 2.4])


def test_deepgram_channels_are_speakers(tmp_path: Path) -> None:
    one = JSON_TRANSCRIPTS["deepgram v1"]["results"]["channels"][0]["alternatives"][0]["words"]
    bare = [{k: v for k, v in w.items() if k != "speaker"} for w in one]
    data = {"results": {"channels": [{"alternatives": [{"words": w}]} for w in (bare[:2], bare[2:])]}}
    assert list(read(tmp_path, "deepgram v1", json.dumps(data)).speakers) == ["0", "1"]
