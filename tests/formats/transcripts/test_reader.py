"""Transcripts of every kind: words, speakers, what is settled and told, and files that are none."""

from __future__ import annotations

import json
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import pytest

from metagraph.errors import FileError
from metagraph.formats.transcripts.reader import read_transcript
from metagraph.formats.transcripts.words import Transcript, settle_words
from metagraph.graph.conversation.model import Segment, Word

Reader = Callable[[str], Transcript]
SPEECH = Path(__file__).resolve().parents[4] / "shared" / "data" / "praatio-speech"


@pytest.fixture
def read(tmp_path: Path) -> Reader:
    def inner(text: str, name: str = "talk.txt") -> Transcript:
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return read_transcript(path)

    return inner


def rows(transcript: Transcript) -> dict[str, list[tuple[str, float, float]]]:
    return {
        name: [(w.text, round(w.start, 3), round(w.end, 3)) for w in words]
        for name, words in transcript.speakers.items()
    }


def grid(*tiers: tuple[str, list[tuple[float, float, str]]]) -> str:
    out = ['File type = "ooTextFile"', 'Object class = "TextGrid"', "0", "10", "<exists>", str(len(tiers))]
    for name, intervals in tiers:
        out += ['"IntervalTier"', f'"{name}"', "0", "10", str(len(intervals))]
        out += [f'{a} {b} "{text}"' for a, b, text in intervals]
    return "\n".join(out)


# --- what is nothing


@pytest.mark.parametrize("text", ["", " \n\n", "\ufeff"])
def test_an_empty_file_is_told(read: Reader, text: str) -> None:
    found = read(text)
    assert found.speakers == {} and found.notes == ("it is empty",)


@pytest.mark.parametrize(
    "text", ["WEBVTT\n", '{"segments": []}', '{"results": []}', "[]", grid(("words", [(0, 10, "")]))]
)
def test_a_transcript_without_words_is_told(read: Reader, text: str) -> None:
    assert any("no words" in n for n in read(text).notes)


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        ("once upon a time", "not a transcript in a known format"),
        ("\0\0\0\0RIFF", "not text"),
        ("{", "not JSON"),
        ('{"a": 1}', "not of a known transcript format"),
        ("[" * 100_000, "too deep"),
        ('{"segments": 3}', "not a list"),
        ('{"segments": [3]}', "not an object"),
        ('{"segments": [{"text": "hi"}]}', "no start and end"),
        ('{"segments": [{"words": [{"word": "a", "start": "x", "end": 1}]}]}', "a time is 'x'"),
        ('{"segments": [{"text": "a", "start": 1e999, "end": 1}]}', "a time is inf"),
        ('{"results": [{"alternatives": [{"timestamps": [["a", 1]]}]}]}', "not a word with its start"),
        ('{"results": [{"alternatives": [{"transcript": "a b"}]}]}', "have no times"),
        ('{"sides": []}', "not a conversation"),
        ("<html></html>", "is XML, but not of a known"),
        ("WEBVTT\n\n00:01 --> later\nhi\n", "not the times of a cue"),
        ("1\n00:00:05,000 --> 00:00:01,000\nhi\n", "before it starts"),
        ("a 1 0.5 0.2 so\na 1 x 0.2 we\n", "no recording, channel"),
        ("a 1 0.5 -0.2 so\n", "lasts -0.2"),
        ("a 1 5e8 0.2 so\n", "time is"),
        (grid(("phones", [(0, 1, "a")])), "no tier contains words"),
        (grid(), "it has no tiers"),
    ],
)
def test_what_is_no_transcript_says_what_place_and_remedy(read: Reader, text: str, cause: str) -> None:
    with pytest.raises(FileError) as caught:
        read(text)
    assert cause in str(caught.value) and caught.value.remedy


# --- words


def test_words_out_of_order_and_overlapping_are_settled_and_told() -> None:
    words = [
        Word(text=t, start=a, end=b) for t, a, b in (("b", 2, 3), ("a", 1, 2.5), ("c", 2.2, 2.9), ("d", 5, 5))
    ]
    found, notes = settle_words(words)
    assert [(w.text, w.start, w.end) for w in found] == [
        ("a", 1, 2),
        ("b", 2, 2.2),
        ("c", 2.2, 2.9),
        ("d", 5, 5.02),
    ]
    assert any("out of order" in n for n in notes) and any("overlapped" in n for n in notes)


def test_a_word_within_another_is_left_out_and_told() -> None:
    found, notes = settle_words([Word(text="a", start=1, end=2), Word(text="b", start=1, end=1.01)])
    assert len(found) == 2 or any("skipped" in n for n in notes)
    assert all(b.start >= a.end - 1e-9 for a, b in pairwise(found))


# --- tiers


def test_textgrid_tiers_are_speakers_and_phones_are_not(read: Reader) -> None:
    found = read(
        grid(
            ("Ann - words", [(0, 1, ""), (1, 1.5, "hello"), (1.5, 2, "sp"), (2, 2.5, "[laughter]")]),
            ("Ann - phones", [(0, 1, ""), (1, 1.2, "HH"), (1.2, 1.5, "AH")]),
            ("Ben - words", [(3, 3.5, "hi")]),
        )
    )
    assert rows(found) == {"Ann": [("hello", 1, 1.5)], "Ben": [("hi", 3, 3.5)]}


def test_tiers_named_after_speakers_hold_their_words(read: Reader) -> None:
    found = read(grid(("Ann", [(1, 2, "so we left")]), ("Ben", [(3, 3.5, "okay")])))
    assert rows(found) == {
        "Ann": [("so", 1, 1.273), ("we", 1.273, 1.546), ("left", 1.546, 2)],
        "Ben": [("okay", 3, 3.5)],
    }
    assert any("sentence" in n for n in found.notes)


def test_overlapping_intervals_of_a_tier_are_settled_and_told(read: Reader) -> None:
    found = read(grid(("words", [(1, 2, "one"), (1.5, 3, "two")])))
    assert rows(found) == {"": [("one", 1, 1.5), ("two", 1.5, 3)]} and any(
        "overlapped" in n for n in found.notes
    )


def test_of_several_tiers_of_a_speaker_the_one_with_most_words_counts(read: Reader) -> None:
    found = read(
        grid(
            ("words", [(1, 2, "one"), (2, 3, "two")]),
            ("text", [(1, 3, "one two")]),
            ("word", [(1, 3, "eins")]),
        )
    )
    assert rows(found) == {"": [("one", 1, 2), ("two", 2, 3)]} and any(
        "tier 'word' skipped" in n for n in found.notes
    )


def test_segments_of_ours_are_read_and_others_left_out(read: Reader) -> None:
    found = read(
        grid(
            ("Ann - words", [(1, 2, "hi")]),
            (
                "Ann - segments",
                [
                    (1, 2, "clause: hi"),
                    (2, 3, "idle"),
                    (2.5, 3, "Response"),
                    (2.8, 4, "hesitation: uh"),
                    (4, 5, "laugh"),
                ],
            ),
            ("Ann - peaks", [(1.25, 1.27, "peak")]),
            ("Ben - segments", [(0, 1, "gesture")]),
        )
    )
    assert found.segments == {
        "Ann": (
            Segment("clause", 1, 2, 1.25, "hi"),
            Segment("response", 2.5, 3),
            Segment("hesitation", 3, 4, None, "uh"),
        )
    }
    assert any("'laugh' is none of" in n for n in found.notes) and any("overlapped" in n for n in found.notes)


def test_elan_tiers_are_speakers_and_gestures_are_not(tmp_path: Path) -> None:
    path = tmp_path / "a.eaf"
    marks = {"words@Ann": "hello", "gestures@Ann": "beat", "Ben": "okay then"}
    slots = "".join(f'<TIME_SLOT TIME_SLOT_ID="t{n}" TIME_VALUE="{t}"/>' for n, t in enumerate((1000, 1500)))
    tiers = "".join(
        f'<TIER TIER_ID="{name}"><ANNOTATION><ALIGNABLE_ANNOTATION ANNOTATION_ID="a{n}" TIME_SLOT_REF1="t0" '
        'TIME_SLOT_REF2="t1">'
        f"<ANNOTATION_VALUE>{text}</ANNOTATION_VALUE></ALIGNABLE_ANNOTATION></ANNOTATION></TIER>"
        for n, (name, text) in enumerate(marks.items())
    )
    path.write_text(
        f"<ANNOTATION_DOCUMENT><HEADER/><TIME_ORDER>{slots}</TIME_ORDER>{tiers}</ANNOTATION_DOCUMENT>"
    )
    assert rows(read_transcript(path)) == {
        "Ann": [("hello", 1, 1.5)]
    }  # a tier named so beats one that is not


@pytest.mark.skipif(not SPEECH.is_dir(), reason="the recordings of praatIO are not here")
def test_real_textgrids_give_words() -> None:
    assert [w.text for w in read_transcript(SPEECH / "mary.TextGrid").speakers[""]] == [
        "mary",
        "rolled",
        "the",
        "barrel",
    ]
    assert len(read_transcript(SPEECH / "bobby_words.TextGrid").speakers[""]) >= 4


# --- subtitles


def test_webvtt_voices_are_speakers(read: Reader) -> None:
    found = read(
        "WEBVTT - a talk\n\nSTYLE\n::cue {}\n\nNOTE hello\n\nintro\n00:01.000 --> 00:02.000 align:start\n<v "
        "Ann>Hi &amp; hello\n\n"
        "00:00:03.000 --> 00:00:04.000\n<v.loud Ben Low>Oh</v>\n\n00:05.000 --> 00:06.000\n<i>still</i>\n"
    )
    assert rows(found) == {
        "Ann": [("Hi", 1, 1.333), ("hello", 1.333, 2)],
        "Ben Low": [("Oh", 3, 4), ("still", 5, 6)],
    }


def test_word_times_inside_cues_count_and_rolling_captions_are_said_once(read: Reader) -> None:
    found = read(
        "WEBVTT\n\n00:01.000 --> 00:03.000\nso<00:00:01.500><c> we</c><00:00:02.000><c> "
        "left</c>\n\n00:03.000 --> 00:03.010\nso we left\n\n"
        "00:03.010 --> 00:05.000\nso we left\nand<00:00:04.000><c> then</c>\n"
    )
    assert rows(found) == {
        "": [("so", 1, 1.5), ("we", 1.5, 2), ("left", 2, 3), ("and", 3.01, 4), ("then", 4, 5)]
    }


def test_lines_of_blanks_are_part_of_a_webvtt_cue(read: Reader) -> None:
    text = (
        "WEBVTT\n\n00:00.080 --> 00:01.990\n \nthis<00:00.480> morning\n\n"
        "00:01.990 --> 00:02.000\nthis morning\n \n\n"
        "00:02.000 --> 00:03.990\nthis morning\nwe<00:02.400> left\n\n"
    )
    assert rows(read(text)) == {
        "": [("this", 0.08, 0.48), ("morning", 0.48, 1.99), ("we", 2.0, 2.4), ("left", 2.4, 3.99)]
    }
    subtitles = text.removeprefix("WEBVTT\n\n").replace(".", ",")
    assert [w.text for w in read(subtitles).speakers[""]][:1] == ["this"]


def test_srt_names_before_colons_are_speakers(read: Reader) -> None:
    found = read(
        "1\r\n00:00:01,000 --> 00:00:02,000\r\nANN: Hi\r\n\r\n2\r\n00:00:02,500 --> 00:00:03,000\r\n{\\an8}- "
        "Ben: Yes\r\n\r\n"
    )
    assert rows(found) == {"ANN": [("Hi", 1, 2)], "Ben": [("Yes", 2.5, 3)]}


@pytest.mark.parametrize(
    ("first", "second"),
    [("王：", "李："), ("田中: ", "鈴木: "), ("प्रिया: ", "रवि: "), ("Zoe\u0301: ", "I\u00f1igo: ")],
)
def test_names_in_any_writing_are_speakers(read: Reader, first: str, second: str) -> None:
    cues = [
        f"{n}\n00:00:0{n},000 --> 00:00:0{n},900\n{(first, second)[n % 2]}えーと、それは\n" for n in range(4)
    ]
    got = read("\n".join(cues))
    assert set(got.speakers) == {first.strip(" ：:"), second.strip(" ：:")}
    assert [w.text for w in got.speakers[second.strip(" ：:")]] == ["えーと、", "それは"] * 2


def test_stops_part_what_has_no_blanks_and_wide_brackets_hold_noise(read: Reader) -> None:
    text = (
        "1\n00:00:01,000 --> 00:00:03,000\n那个，我觉得还不错。\n\n2\n00:00:04,000 --> 00:00:05,000\n（笑）\n"
    )
    assert [t for t, *_ in rows(read(text))[""]] == ["那个，", "我觉得还不错。"]


def test_one_colon_makes_no_speaker(read: Reader) -> None:
    found = read("1\n00:00:01,000 --> 00:00:02,000\nNote: this\n2\n00:00:03,000 --> 00:00:04,000\nis all\n")
    assert [w.text for w in found.speakers[""]] == ["Note:", "this", "is", "all"]


# --- JSON


def test_whisper_words_and_segments_without_words(read: Reader) -> None:
    data = {
        "text": "x",
        "segments": [
            {
                "start": 0,
                "end": 1,
                "text": " Hi there",
                "words": [
                    {"word": " Hi", "start": 0.1, "end": 0.4, "probability": 1},
                    {"word": " there.", "start": 0.5, "end": 0.9},
                ],
            },
            {"start": 2, "end": 3, "text": " we left"},
        ],
    }
    assert rows(read(json.dumps(data))) == {
        "": [("Hi", 0.1, 0.4), ("there.", 0.5, 0.9), ("we", 2, 2.375), ("left", 2.375, 3)]
    }


def test_whisperx_speakers_and_words_without_times(read: Reader) -> None:
    data = {"segments": [{"start": 0, "end": 2, "speaker": "A", "words": [
        {"word": "in", "start": 0.2, "end": 0.4, "speaker": "A"}, {"word": "2014"},
        {"word": "we", "start": 1.0, "end": 1.2, "speaker": "B"}, {"word": "7"},
    ]}], "word_segments": []}  # fmt: skip
    assert rows(read(json.dumps(data))) == {
        "A": [("in", 0.2, 0.4), ("2014", 0.4, 1.0), ("7", 1.2, 2)],
        "B": [("we", 1.0, 1.2)],
    }


@pytest.mark.parametrize("key", ["words", "word_segments", None])
def test_words_alone_are_read(read: Reader, key: str | None) -> None:
    words = [{"word": "so", "start": 1, "end": 1.5}]
    assert rows(read(json.dumps({key: words} if key else words))) == {"": [("so", 1, 1.5)]}


def test_whole_milliseconds_are_told_from_seconds_by_how_long_words_would_last(read: Reader) -> None:
    words = [("so", 0, 380), ("today", 500, 880), ("we", 2_400_000, 2_400_300)]
    data = {"words": [{"text": w, "start": a, "end": b} for w, a, b in words]}
    texts = [{**word, "start": str(word["start"]), "end": str(word["end"])} for word in data["words"]]
    for some in (data, {"words": texts}):
        found = read(json.dumps(some))
        assert rows(found) == {"": [("so", 0, 0.38), ("today", 0.5, 0.88), ("we", 2400, 2400.3)]}
        assert any("milliseconds" in note for note in found.notes)


@pytest.mark.parametrize(
    "words",
    [
        [("so", 1, 2), ("today", 2, 3), ("we", 40, 45)],  # one word that goes on, in whole seconds
        [("so", 0.5, 380), ("today", 500, 880)],  # no whole number
        [("now", 5, 5), ("then", 6, 6)],
        [("Thanks", 0.0, 30.0)],  # one word in a window of 30 s, in milliseconds impossibly short
    ],
)
def test_whole_seconds_stay_seconds(read: Reader, words: list[tuple[str, float, float]]) -> None:
    found = read(json.dumps({"words": [{"text": w, "start": a, "end": b} for w, a, b in words]}))
    assert not any("milliseconds" in note for note in found.notes)
    assert [w.start for w in found.speakers[""]] == [a for _, a, _ in words]


def test_ibm_speakers_come_by_their_labels(read: Reader) -> None:
    data = {
        "result_index": 0,
        "results": [
            {
                "final": True,
                "alternatives": [
                    {
                        "transcript": "so %HESITATION",
                        "timestamps": [["so", 0.1, 0.3], ["%HESITATION", 0.3, 0.6]],
                    }
                ],
            },
            {"final": False, "alternatives": [{"timestamps": [["no", 9, 10]]}]},
            {"final": True, "alternatives": [{"timestamps": [["yes", 1.0, 1.2]]}]},
        ],
        "speaker_labels": [
            {"from": 0.1, "to": 0.3, "speaker": 0},
            {"from": 0.3, "to": 0.6, "speaker": 0},
            {"from": 1.0, "to": 1.2, "speaker": 1},
        ],
    }
    assert rows(read(json.dumps(data))) == {
        "0": [("so", 0.1, 0.3), ("%HESITATION", 0.3, 0.6)],
        "1": [("yes", 1.0, 1.2)],
    }
    assert rows(read(json.dumps([data])))["1"] == [("yes", 1.0, 1.2)]


# --- CTM


def test_ctm_channels_are_speakers(read: Reader) -> None:
    found = read(";; made by hand\nsw1 A 0.50 0.20 so 0.9\nsw1 B 1.00 0.30 yes\nsw1 A 0.70 0.10 we\n")
    assert rows(found) == {"A": [("so", 0.5, 0.7), ("we", 0.7, 0.8)], "B": [("yes", 1, 1.3)]}
    assert rows(read("a 1 0.5 0.2 so\n")) == {"": [("so", 0.5, 0.7)]}
    assert set(read("a 1 0.5 0.2 so\nb 1 0.5 0.2 no\n").speakers) == {"a", "b"}
