"""Captions, chat logs and units of time as programs write them: each word once, no name among the words."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from metagraph.formats.transcripts.reader import read_transcript
from metagraph.formats.transcripts.source import TranscriptSound
from metagraph.formats.transcripts.units import infer_time_unit
from metagraph.formats.transcripts.words import Transcript


def read(
    folder: Path, text: str, name: str = "a.srt", seconds: float | None = None, sound: str = "talk.wav"
) -> Transcript:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return read_transcript(path, TranscriptSound(seconds, (sound,)))


def said(found: Transcript) -> dict[str, str]:
    return {name: " ".join(w.text for w in words) for name, words in found.speakers.items() if words}


def starts(found: Transcript) -> list[float]:
    return [round(w.start, 2) for words in found.speakers.values() for w in words]


def srt(*cues: tuple[float, float, str]) -> str:
    def clock(seconds: float) -> str:
        return f"00:00:{seconds:06.3f}".replace(".", ",")

    return "\n".join(f"{n}\n{clock(a)} --> {clock(b)}\n{text}\n" for n, (a, b, text) in enumerate(cues, 1))


# --- captions that repeat


def test_rolling_captions_with_times_inside_say_each_word_once(tmp_path: Path) -> None:
    text = (
        "WEBVTT\nKind: captions\nLanguage: de\n\n00:00:01.000 --> 00:00:02.500 align:start\n \n"
        "heute<00:00:01.500><c> morgen</c><00:00:02.000><c> kam</c>\n\n"
        "00:00:02.500 --> 00:00:02.510\nheute morgen kam\n \n\n"
        "00:00:02.510 --> 00:00:04.000\nheute morgen kam\nniemand<00:00:03.000><c> nach</c>\n\n"
        "00:00:04.000 --> 00:00:04.010\nniemand nach\n \n\n"
        "00:00:04.010 --> 00:00:05.000\nniemand nach\nHause\n"
    )
    found = read(tmp_path, text, "a.vtt")
    assert said(found) == {"": "heute morgen kam niemand nach Hause"}
    assert starts(found) == [1.0, 1.5, 2.0, 2.51, 3.0, 4.01]
    assert any("4 cues show again" in note for note in found.notes)


def test_rolling_captions_without_times_inside_say_each_word_once(tmp_path: Path) -> None:
    lines = ["this morning", "nobody came", "because of rain", "that fell"]
    cues = [(0, 2, lines[0])] + [(2.0 * n, 2.0 * n + 2, f"{lines[n - 1]}\n{lines[n]}") for n in (1, 2, 3)]
    found = read(tmp_path, srt(*cues))
    assert said(found) == {"": " ".join(lines)}
    assert [starts(found)[n] for n in (0, 2, 4, 7)] == [0, 2, 4, 6]


def test_lines_that_grow_word_by_word_say_each_word_once(tmp_path: Path) -> None:
    words = ["this", "morning", "nobody", "came"]
    cues = [(float(n), n + 1.0, " ".join(words[: n + 1])) for n in range(4)]
    found = read(tmp_path, srt(*cues))
    assert said(found) == {"": " ".join(words)} and starts(found) == [0, 1, 2, 3]


def test_words_that_are_marked_one_after_the_other_have_the_times_of_their_mark(tmp_path: Path) -> None:
    cues = [
        (0, 0.3, "<u>So</u> we left"),
        (0.3, 0.4, "So we left"),
        (0.4, 0.6, "So <u>we</u> left"),
        (0.6, 1, "So we <u>left</u>"),
    ]
    found = read(tmp_path, srt(*cues))
    assert said(found) == {"": "So we left"} and starts(found) == [0, 0.4, 0.6]


@pytest.mark.parametrize(
    "cues",
    [
        [(0, 1, "no"), (3, 4, "no"), (6, 7, "no")],
        [(0, 1, "no"), (1, 2, "no"), (2, 3, "no")],
        [(0, 1, "we went"), (1, 2, "we went home"), (5, 6, "and back")],
    ],
)
def test_what_people_say_again_is_kept(tmp_path: Path, cues: list[tuple[float, float, str]]) -> None:
    assert said(read(tmp_path, srt(*cues))) == {"": " ".join(text for *_, text in cues)}


# --- a single speaker's name


@pytest.mark.parametrize(
    ("lines", "name"),
    [
        (("Ann: so we left", "and then came back"), "Ann"),
        (("ANN: so we left", "ANN: and then came back"), "ANN"),
        (("Dr. Müller (host): so we left", "Dr. Müller (host): and then came back"), "Dr. Müller"),
        (("Speaker 1: so we left", "and then came back"), "Speaker 1"),
        (("SPEAKER_00: so we left", "SPEAKER_00: and then came back"), "SPEAKER_00"),
        (("[Ann Lee] so we left", "[Ann Lee] and then came back"), "Ann Lee"),
        (("(Ann) so we left", "(Ann) and then came back"), "Ann"),
        (("Ann:so we left", "Ann:and then came back"), "Ann"),
        (("ANN:\nso we left", "and then came back"), "ANN"),
        (("田中：so we left", "and then came back"), "田中"),
        (("Αλίκη: so we left", "and then came back"), "Αλίκη"),
        (("- Ann: so we left", "and then came back"), "Ann"),
    ],
)
def test_one_name_is_the_speaker_and_no_word(tmp_path: Path, lines: tuple[str, str], name: str) -> None:
    found = read(tmp_path, srt((1, 2, lines[0]), (3, 4, lines[1])))
    assert said(found) == {name: "so we left and then came back"}
    assert starts(found)[0] == 1.0


@pytest.mark.parametrize(
    "lines",
    [
        ("Note: the door is open", "and then"),
        ("well: it is open", "and then"),
        ("Remember what he said: go", "and then"),
        ("It is 10:30 now", "and then"),
        ("Rain: the rain fell", "and then"),
    ],
)
def test_a_word_before_a_colon_stays_a_word(tmp_path: Path, lines: tuple[str, str]) -> None:
    assert said(read(tmp_path, srt((1, 2, lines[0]), (3, 4, lines[1])))) == {"": " ".join(lines)}


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("[00:00:01] Ann: so we\n[00:00:03] Ann: and then\n", "Ann"),
        ("00:00:01 Ann: so we\nand then\n", "Ann"),
        (
            "09:15:01\t From Ann Lee to Everyone : so we\n09:15:03\t From Ann Lee to Everyone : and then\n",
            "Ann Lee",
        ),
        ("Ann Lee  0:01\nso we\n\nAnn Lee  0:03\nand then\n", "Ann Lee"),
        ("12/01/2026, 10:15:01 - Ann: so we\n12/01/2026, 10:15:03 - Ann: and then\n", "Ann"),
        ("[12.01.26, 22:15:01] Ann: so we\n[12.01.26, 22:15:03] Ann: and then\n", "Ann"),
    ],
)
def test_chat_logs_of_one_name_are_read(tmp_path: Path, text: str, name: str) -> None:
    found = read(tmp_path, text, "a.txt", 6.0)
    assert said(found) == {name: "so we and then"}
    assert any("how long they last is estimated" in note for note in found.notes)


def test_a_name_in_a_table_or_a_segment_is_no_word(tmp_path: Path) -> None:
    assert said(read(tmp_path, "0.5\t1.5\tAnn: so we\n2\t3\tAnn: left\n", "a.tsv")) == {"Ann": "so we left"}
    data = {
        "segments": [{"start": 0, "end": 1, "text": "Ann: so we"}, {"start": 1, "end": 2, "text": "left"}]
    }
    assert said(read(tmp_path, json.dumps(data), "a.json")) == {"Ann": "so we left"}


# --- units


@pytest.mark.parametrize(
    ("scale", "name"),
    [
        (1, None),
        (100, "hundredths"),
        (1e3, "milliseconds"),
        (1e6, "microseconds"),
        (1e7, "ticks"),
        (1e9, "nanoseconds"),
    ],
)
def test_the_length_of_the_sound_tells_the_unit(tmp_path: Path, scale: float, name: str | None) -> None:
    rows = [("so", 0.0, 0.38), ("today", 0.5, 0.88), ("we", 1.0, 1.3)]
    data = {"words": [{"text": w, "start": a * scale, "end": b * scale} for w, a, b in rows]}
    found = read(tmp_path, json.dumps(data), "a.json", 2.0)
    assert [(w.text, w.start, w.end) for w in found.speakers[""]] == [
        (w, pytest.approx(a), pytest.approx(b)) for w, a, b in rows
    ]
    assert [n for n in found.notes if "read as" in n] == (
        [] if name is None else [n for n in found.notes if name in n and "the sound lasts 2.0 s" in n]
    )
    assert bool([n for n in found.notes if "read as" in n]) == (name is not None)


def test_slow_words_in_a_long_sound_stay_seconds() -> None:
    assert infer_time_unit([(0.0, 30.0, "hm")], 600.0) == (1.0, None)
    assert infer_time_unit([], 5.0) == (1.0, None)


def test_names_of_times_that_say_milliseconds_are_believed(tmp_path: Path) -> None:
    data = [{"word": "so", "start_ms": 0, "end_ms": 3}, {"word": "we", "startMs": 500, "endMs": 900}]
    assert starts(read(tmp_path, json.dumps(data), "a.json", 2.0)) == [0.0, 0.5]


# --- ELAN's time origins


def eaf(*media: tuple[str, int | None], extracted: str = "") -> str:
    def one(url: str, origin: int | None) -> str:
        more = f' TIME_ORIGIN="{origin}"' if origin is not None else ""
        more += f' EXTRACTED_FROM="{extracted}"' if extracted and url.endswith(".wav") else ""
        return f'<MEDIA_DESCRIPTOR MEDIA_URL="{url}" MIME_TYPE="x"{more}/>'

    return (
        '<ANNOTATION_DOCUMENT><HEADER TIME_UNITS="milliseconds">'
        + "".join(one(*m) for m in media)
        + '</HEADER><TIME_ORDER><TIME_SLOT TIME_SLOT_ID="a" TIME_VALUE="500"/>'
        '<TIME_SLOT TIME_SLOT_ID="b" TIME_VALUE="900"/></TIME_ORDER>'
        '<TIER TIER_ID="words"><ANNOTATION><ALIGNABLE_ANNOTATION ANNOTATION_ID="x" TIME_SLOT_REF1="a" '
        'TIME_SLOT_REF2="b"><ANNOTATION_VALUE>so</ANNOTATION_VALUE></ALIGNABLE_ANNOTATION></ANNOTATION></TIER>'
        "</ANNOTATION_DOCUMENT>"
    )


@pytest.mark.parametrize(
    ("media", "extracted", "start"),
    [
        ([("file:///d/talk.wav", 4000)], "", 4.5),
        ([("file:///d/talk.wav", None)], "", 0.5),
        ([("file:///d/cam.mp4", 2500), ("file:///C:/d/talk.wav", 4000)], "", 4.5),
        ([("file:///d/cam.mp4", 4000), ("file:///d/talk.wav", None)], "file:///d/cam.mp4", 4.5),
        ([("file:///d/talk.wav", -300)], "", 0.2),
        ([("file:///d/other.mp4", 2500), ("file:///d/own.wav", 4000)], "", 4.5),
        ([("file:///d/other.mp4", 2500)], "", 3.0),
    ],
)
def test_words_of_elan_lie_where_its_time_origin_puts_them(
    tmp_path: Path, media: list[tuple[str, int | None]], extracted: str, start: float
) -> None:
    found = read(tmp_path, eaf(*media, extracted=extracted), "a.eaf", 60.0)
    assert starts(found) == [start]
    assert any("time origin" in note for note in found.notes) == (start != 0.5)


def test_media_that_begin_at_different_times_and_are_called_otherwise_are_told(tmp_path: Path) -> None:
    found = read(tmp_path, eaf(("a.mp4", 1000), ("b.wav", 2000)), "a.eaf", 60.0)
    assert any("none has the name of the sound" in note for note in found.notes)
