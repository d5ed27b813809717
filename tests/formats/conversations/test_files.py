"""Conversations from files: channels, files and transcripts brought together; what is wrong with them is said
with a remedy.
"""

from __future__ import annotations

import json
import shutil
from concurrent.futures import CancelledError
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest

from metagraph.errors import FileError
from metagraph.formats.conversations.files import Read, read_conversation
from metagraph.formats.conversations.languages import Speaking
from metagraph.formats.conversations.writers import write_elan, write_json, write_textgrid
from metagraph.formats.transcripts.reader import read_transcript
from metagraph.graph.conversation.edits import add_conversation
from metagraph.graph.conversation.model import Segment, Side
from metagraph.graph.model import Project
from metagraph.speech.addressing import list_addressed_turns
from sample_clips.make import three as maker
from sample_clips.make.talk import MissingError
from tests.speech import group, talk

SPEECH = Path(__file__).resolve().parents[4] / "shared" / "data" / "praatio-speech"
RATE = 16000


@pytest.fixture
def files(tmp_path: Path) -> tuple[Path, Path]:
    return talk.make_conversation(tmp_path)


def said(read: Read, *parts: str) -> bool:
    """Whether one of the notes has all the parts, and a remedy or reason besides."""
    return any(all(p in note for p in parts) and note.endswith(".") for note in read.notes)


def counts(side: Side) -> dict[str, int]:
    return {kind: sum(s.kind == kind for s in side.segments) for kind in ("clause", "response", "hesitation")}


def buzz(seconds: float, rate: int = RATE) -> Any:
    at = np.arange(int(seconds * rate)) / rate
    return (
        0.2
        * sum(np.sin(2 * np.pi * k * 130 * at) / k for k in range(1, 12))
        * (np.sin(2 * np.pi * 0.5 * at) > 0)
    )


def sound(path: Path, *channels: Any, rate: int = RATE) -> Path:
    talk.write_sound(path, np.array(channels), rate)
    return path


# --- what is brought together


@pytest.mark.nightly
def test_two_channels_and_one_transcript_make_two_sides(files: tuple[Path, Path]) -> None:
    read = read_conversation([files[0]], [files[1]], files[0].parent)
    made, spoken = read.conversation, talk.speak()
    assert (
        not read.notes
        and made.name == "talk"
        and made.length == pytest.approx(spoken.samples.shape[1] / spoken.rate, abs=0.01)
    )
    for n, side in enumerate(made.sides):
        assert (side.audio, side.channel, side.name) == ("talk.wav", n, f"SPEAKER_0{n}")
        assert [(w.text, w.start, w.end) for w in side.words] == [
            (t, pytest.approx(a, abs=1e-3), pytest.approx(b, abs=1e-3)) for t, a, b in spoken.words[n]
        ]
    assert counts(made.sides[0])["response"] == 2 and counts(made.sides[0])["hesitation"] == 2
    assert counts(made.sides[1])["response"] == 4 and counts(made.sides[1])["hesitation"] == 1
    assert msgspec.json.decode(msgspec.json.encode(made), type=type(made)) == made
    assert add_conversation(Project(), made)[0].conversations


def test_conversations_have_seeds_of_their_own_and_the_same_one_the_same(files: tuple[Path, Path]) -> None:
    """With one seed for all, all would fidget at the same places."""
    first, again = (read_conversation([files[0]], [files[1]]).conversation.seed for _ in range(2))
    other = read_conversation([files[0]], [files[1]], name="Another").conversation.seed
    assert first == again != other


def test_speakers_are_brought_to_the_channel_they_are_heard_in(files: tuple[Path, Path]) -> None:
    spoken = talk.speak()
    sound(files[0], spoken.samples[1], spoken.samples[0], rate=spoken.rate)
    made = read_conversation([files[0]], [files[1]]).conversation
    assert [s.name for s in made.sides] == ["SPEAKER_01", "SPEAKER_00"] and [
        s.channel for s in made.sides
    ] == [0, 1]


def test_two_files_and_a_textgrid(tmp_path: Path) -> None:
    spoken = talk.speak()
    audio = [
        sound(tmp_path / f"{n}.flac", s, rate=spoken.rate) for n, s in zip("ab", spoken.samples, strict=True)
    ]
    talk.write_textgrid(tmp_path / "t.TextGrid", spoken)
    made = read_conversation(audio, [tmp_path / "t.TextGrid"], tmp_path.parent, "A talk").conversation
    assert made.name == "A talk" and [s.audio for s in made.sides] == [
        f"{tmp_path.name}/a.flac",
        f"{tmp_path.name}/b.flac",
    ]
    assert [s.name for s in made.sides] == ["Ann", "Ben"] and [len(s.words) for s in made.sides] == [
        len(w) for w in spoken.words
    ]


def test_a_transcript_a_side(files: tuple[Path, Path], tmp_path: Path) -> None:
    for name, words in zip(("ann.ctm", "ben.ctm"), talk.speak().words, strict=True):
        (tmp_path / name).write_text("".join(f"x 1 {a} {b - a} {t}\n" for t, a, b in words))
    read = read_conversation([files[0]], [tmp_path / "ann.ctm", tmp_path / "ben.ctm"])
    assert [s.name for s in read.conversation.sides] == ["ann", "ben"] and not read.notes
    swapped = read_conversation([files[0]], [tmp_path / "ben.ctm", tmp_path / "ann.ctm"])
    assert said(swapped, "better than the other way round")


def test_one_channel_is_shared_when_a_transcript_names_the_speakers(
    files: tuple[Path, Path], tmp_path: Path
) -> None:
    spoken = talk.speak()
    mono = sound(tmp_path / "mono.wav", spoken.samples.sum(0), rate=spoken.rate)
    read = read_conversation([mono], [files[1]])
    assert [s.channel for s in read.conversation.sides] == [None, None] and said(read, "all sides share it")
    assert counts(read.conversation.sides[1])["response"] == 4
    double = sound(tmp_path / "double.wav", spoken.samples.sum(0), spoken.samples.sum(0), rate=spoken.rate)
    for path, why in ((mono, "one channel"), (double, "same sound in both")):
        alone = read_conversation([path])
        speaker, listener = alone.conversation.sides
        assert speaker.segments and speaker.audio is not None and said(alone, why, "add a channel")
        assert not listener.segments and listener.audio is None


def test_words_without_speakers_go_to_the_louder_channel(files: tuple[Path, Path], tmp_path: Path) -> None:
    words = sorted((a, b, t) for side in talk.speak().words for t, a, b in side)
    (tmp_path / "all.ctm").write_text("".join(f"x 1 {a} {b - a} {t}\n" for a, b, t in words))
    read = read_conversation([files[0]], [tmp_path / "all.ctm"])
    assert said(read, "does not name two speakers", "louder")
    for side, own in zip(read.conversation.sides, talk.speak().words, strict=True):
        right = {t for t, *_ in own}
        assert sum(w.text in right for w in side.words) >= 0.9 * len(side.words) > 0.8 * 0.9 * len(own)


def test_one_speakers_words_leave_the_other_to_loudness(files: tuple[Path, Path], tmp_path: Path) -> None:
    (tmp_path / "ben.ctm").write_text("".join(f"x 1 {a} {b - a} {t}\n" for t, a, b in talk.speak().words[1]))
    read = read_conversation([files[0]], [tmp_path / "ben.ctm"])
    assert said(read, "words of one speaker only, talk.wav, right channel")
    assert not read.conversation.sides[0].words and counts(read.conversation.sides[0])["clause"] >= 5
    assert len(read.conversation.sides[1].words) == len(talk.speak().words[1])


def test_the_lists_are_kept_with_the_conversation(files: tuple[Path, Path]) -> None:
    made = read_conversation(
        [files[0]], [files[1]], speaking=Speaking(lists=((("wow",), ()),) * 2)
    ).conversation
    assert (made.responses, made.hesitations) == (("wow",), ()) and counts(made.sides[1])["response"] == 1


@pytest.mark.parametrize("suffix", [".eaf", ".TextGrid", ".json"])
def test_what_was_corrected_by_hand_is_read_back(
    files: tuple[Path, Path], tmp_path: Path, suffix: str
) -> None:
    made = read_conversation([files[0]], [files[1]], tmp_path).conversation
    first = made.sides[0]
    segments = (
        Segment("response", 0.61, 1.5, None, "so I was"),
        Segment("clause", 1.5, 3.312, 2.9, "moved"),
        *first.segments[3:],
    )
    made = msgspec.structs.replace(
        made, sides=(msgspec.structs.replace(first, segments=segments), made.sides[1])
    )
    path = tmp_path / f"out{suffix}"
    {
        ".eaf": lambda: write_elan(made, path, tmp_path),
        ".TextGrid": lambda: write_textgrid(made, path),
        ".json": lambda: write_json(made, path),
    }[suffix]()
    back = read_conversation([files[0]], [path], tmp_path, made.name)
    assert not back.notes
    for a, b in zip(made.sides, back.conversation.sides, strict=True):
        assert a.name == b.name and [w.text for w in a.words] == [w.text for w in b.words]
        assert [(s.kind, s.text) for s in a.segments] == [(s.kind, s.text) for s in b.segments]
        for s, t in zip(a.segments, b.segments, strict=True):
            assert (t.start, t.end) == (pytest.approx(s.start, abs=6e-4), pytest.approx(s.end, abs=6e-4))
            assert (s.peak is None) == (t.peak is None) and (
                s.peak is None or t.peak == pytest.approx(s.peak, abs=6e-4)
            )


def test_a_cancelled_reading_ends(files: tuple[Path, Path]) -> None:
    with pytest.raises(CancelledError):
        read_conversation([files[0]], cancelled=lambda: True)


# --- what is wrong


def test_silence_says_so(tmp_path: Path) -> None:
    read = read_conversation([sound(tmp_path / "a.wav", np.zeros(3 * RATE), 1e-6 * buzz(3))])
    assert all(not s.segments for s in read.conversation.sides)
    for quiet in ((np.zeros(3 * RATE),), (np.zeros(3 * RATE), np.zeros(3 * RATE))):
        with pytest.raises(FileError, match=r"is silent.*microphone"):
            read_conversation([sound(tmp_path / "b.wav", *quiet)])
    both = read_conversation([sound(tmp_path / "b.wav", buzz(3), buzz(3))])
    assert said(both, "same sound in both channels", "another one listens")
    one = read_conversation([sound(tmp_path / "c.wav", np.zeros(6 * RATE), buzz(6))])
    assert said(one, "left channel is silent", "transcript") and said(
        one, "c.wav, left channel: it is silent", "microphone"
    )
    assert one.conversation.sides[1].segments and not one.conversation.sides[0].segments


def test_noise_says_so(tmp_path: Path) -> None:
    noise = 0.1 * np.random.default_rng(1).standard_normal((2, 4 * RATE))
    read = read_conversation([sound(tmp_path / "a.wav", *noise)])
    assert said(read, "left channel: the recording is a steady noise") and said(
        read, "right channel: the recording is a steady noise"
    )
    assert all(not s.segments for s in read.conversation.sides)


def test_clipping_says_how_much(tmp_path: Path) -> None:
    read = read_conversation([sound(tmp_path / "a.wav", np.clip(20 * buzz(4), -1, 1), buzz(4)[::-1])])
    assert said(read, "left channel:", "% of the samples clip") and not said(
        read, "right channel:", "cut off"
    )


@pytest.mark.nightly
def test_an_mp3_named_wav_is_read_as_what_it_is(files: tuple[Path, Path], tmp_path: Path) -> None:
    spoken = talk.speak()
    sound(tmp_path / "a.mp3", *spoken.samples, rate=spoken.rate)
    shutil.move(tmp_path / "a.mp3", tmp_path / "a.wav")
    made = read_conversation([tmp_path / "a.wav"], [files[1]]).conversation
    assert [counts(s)["response"] for s in made.sides] == [2, 4]


@pytest.mark.parametrize("content", [b"", b"once upon a time", b"RIFF\0\0\0\0WAVE", b"ID3\x03" + bytes(200)])
def test_what_is_no_sound_says_so(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "a.wav").write_bytes(content)
    with pytest.raises(FileError) as caught:
        read_conversation([tmp_path / "a.wav"])
    assert caught.value.remedy
    with pytest.raises(FileError, match="does not exist"):
        read_conversation([tmp_path / "gone.wav"])


def test_more_channels_than_may_talk_are_refused_with_a_remedy(tmp_path: Path) -> None:
    some = [np.roll(buzz(2), 100 * n) for n in range(9)]
    with pytest.raises(FileError, match=r"9 channels.*up to 8"):
        read_conversation([sound(tmp_path / "a.wav", *some)])
    with pytest.raises(FileError, match=r"3 channels.*conversation of two"):
        read_conversation([sound(tmp_path / "b.wav", *some[:3])], most=2)


def test_rates_and_lengths_that_differ_are_told(tmp_path: Path) -> None:
    audio = [sound(tmp_path / "a.wav", buzz(6)), sound(tmp_path / "b.wav", buzz(4, 44100)[::-1], rate=44100)]
    read = read_conversation(audio)
    assert said(read, "a.wav has 16000", "b.wav 44100") and said(read, "a.wav lasts 6.0 s and b.wav 4.0 s")
    assert read.conversation.length == pytest.approx(6.0)
    stereo = read_conversation([sound(tmp_path / "c.wav", buzz(6), buzz(6)), audio[0]])
    assert said(stereo, "c.wav has 2 channels", "mixed") and stereo.conversation.sides[0].channel is None


def test_words_past_the_end_are_left_out_and_told(files: tuple[Path, Path], tmp_path: Path) -> None:
    (tmp_path / "t.ctm").write_text("x A 1 0.5 so\nx A 30.2 0.5 over\nx A 40 1 gone\nx B 11 0.4 yes\n")
    read = read_conversation([files[0]], [tmp_path / "t.ctm"])
    # What the voice says is some hundredths of a second longer where it spoke another language before.
    end = f"past the end of the sound at {read.conversation.length:.1f} s"
    assert said(read, "1 word skipped and 1 word cut", end)
    assert read.conversation.sides[0].words[-1].end <= read.conversation.length
    (tmp_path / "u.ctm").write_text("x A 100 0.5 so\nx B 110 1 gone\n")
    with pytest.raises(FileError, match=r"u\.ctm, A: .*1 word"):
        read_conversation([files[0]], [tmp_path / "u.ctm"])


def test_an_empty_transcript_leaves_it_to_loudness(files: tuple[Path, Path], tmp_path: Path) -> None:
    (tmp_path / "t.vtt").write_text("")
    read = read_conversation([files[0]], [tmp_path / "t.vtt"])
    assert (
        said(read, "t.vtt: it is empty")
        and said(read, "no words, so the loudness was used")
        and read.conversation.sides[0].segments
    )


def test_more_speakers_than_there_may_be_are_told(files: tuple[Path, Path], tmp_path: Path) -> None:
    (tmp_path / "t.ctm").write_text(
        "x A 1 0.5 so\nx A 2 0.5 we\nx B 11 0.4 yes\nx B 12 0.4 no\nx C 3 0.5 me\n"
    )
    read = read_conversation([files[0]], [tmp_path / "t.ctm"], most=2)
    assert said(read, "3 speakers", "'C'") and [s.name for s in read.conversation.sides] == ["A", "B"]


def test_words_where_nothing_is_heard_are_told(files: tuple[Path, Path], tmp_path: Path) -> None:
    (tmp_path / "t.ctm").write_text(
        "".join(f"x A {29.6 + 0.08 * n} 0.08 so\n" for n in range(8))
        + "x B 23.5 0.4 she\nx B 24.1 0.4 takes\n"
    )
    assert said(read_conversation([files[0]], [tmp_path / "t.ctm"]), "are where nothing is heard")


@pytest.mark.skipif(not SPEECH.is_dir(), reason="the recordings of praatIO are not here")
def test_real_recordings_make_sides() -> None:
    read = read_conversation(
        [SPEECH / "mary.wav", SPEECH / "bobby.wav"],
        [SPEECH / "mary.TextGrid", SPEECH / "bobby_words.TextGrid"],
    )
    mary, bobby = read.conversation.sides
    assert [s.text for s in mary.segments] == ["mary rolled the barrel"] and mary.segments[
        0
    ].peak == pytest.approx(0.6, abs=0.1)
    assert bobby.segments and all(s.kind == "clause" for s in bobby.segments)


# --- more than two


@pytest.fixture(scope="module")
def three() -> talk.Talk:
    return group.spoken()


def named_cues(path: Path, spoken: talk.Talk, way: str, head: str = "") -> Path:
    """Write what was said as subtitles. way: how a name stands before words."""
    rows = sorted(spoken.said, key=lambda s: s.start)
    cues = [
        f"{int(s.start // 60):02d}:{s.start % 60:06.3f} --> {int(s.end // 60):02d}:{s.end % 60:06.3f}\n"
        + way.format(group.NAMES[s.side])
        + s.text
        for s in rows
    ]
    path.write_text(head + "\n\n".join(cues) + "\n")
    return path


def heard_of(read: Read) -> list[tuple[str, int | None, int]]:
    return [(s.name, s.channel, len(s.words)) for s in read.conversation.sides]


def test_three_channels_are_three_who_talk_by_loudness(tmp_path: Path, three: talk.Talk) -> None:
    read = read_conversation([sound(tmp_path / "a.wav", *three.samples, rate=three.rate)])
    assert [s.channel for s in read.conversation.sides] == [0, 1, 2]
    for n, side in enumerate(read.conversation.sides):
        own = [(s.start, s.end) for s in three.said if s.side == n]
        middles = [(s.start + s.end) / 2 for s in side.segments]
        assert middles and all(any(a - 0.3 < m < b + 0.3 for a, b in own) for m in middles)


def test_a_file_for_each_of_three_with_one_transcript_or_one_for_each(
    tmp_path: Path, three: talk.Talk
) -> None:
    audio = [sound(tmp_path / f"{n}.wav", three.samples[n], rate=three.rate) for n in range(3)]
    whole = named_cues(tmp_path / "all.vtt", three, "<v {}>", "WEBVTT\n\n")
    read = read_conversation(audio[::-1], [whole])
    assert [s.name for s in read.conversation.sides] == ["Cleo", "Ben", "Ann"], (
        "whose words are whose is heard"
    )
    each = []
    for n in range(3):
        path = tmp_path / f"words {n}.ctm"
        path.write_text("".join(f"x A {a} {b - a} {w}\n" for w, a, b in three.words[n]))
        each.append(path)
    read = read_conversation(audio, each)
    assert [s.name for s in read.conversation.sides] == ["words 0", "words 1", "words 2"] and not read.notes
    turned = read_conversation(audio, [each[1], each[2], each[0]])
    assert said(turned, "better than the other way round", "Give them in the order of the sides")
    with pytest.raises(ValueError, match="3 sounds and 2 transcripts"):
        read_conversation(audio, each[:2])


@pytest.mark.parametrize("way", ["<v {}>", "{}: ", "[{}] ", "({}) ", "[{}]: "])
def test_one_channel_is_shared_by_three_whom_a_transcript_names(
    tmp_path: Path, three: talk.Talk, way: str
) -> None:
    mono = sound(tmp_path / "mono.wav", three.samples.sum(0), rate=three.rate)
    head = "WEBVTT\n\n" if way.startswith("<") else ""
    read = read_conversation([mono], [named_cues(tmp_path / "a.vtt", three, way, head)])
    counted = [(name, None, len(words)) for name, words in zip(group.NAMES, three.words, strict=False)]
    assert heard_of(read) == counted
    kinds = [[s.kind for s in side.segments] for side in read.conversation.sides]
    assert "hesitation" in kinds[1] and "response" in kinds[2]


def test_three_named_in_a_diarised_transcript_of_two_channels_share_one(
    tmp_path: Path, three: talk.Talk
) -> None:
    two = np.stack([three.samples[0] + three.samples[2], three.samples[1]])
    path = tmp_path / "a.json"
    rows = [
        {"start": s.start, "end": s.end, "text": s.text, "speaker": f"SPEAKER_0{s.side}"}
        for s in sorted(three.said, key=lambda s: s.start)
    ]
    path.write_text(json.dumps({"segments": rows}))
    read = read_conversation([sound(tmp_path / "a.wav", *two, rate=three.rate)], [path])
    assert [s.channel for s in read.conversation.sides] == [0, 1, 0]
    assert said(read, "names 3 speakers for 2 channels", "Some share a channel")


def test_channels_in_which_nothing_is_heard_are_left_out_of_more_than_two(
    tmp_path: Path, three: talk.Talk
) -> None:
    quiet = np.zeros_like(three.samples[0])
    some = (three.samples[0], quiet, three.samples[1], quiet)
    read = read_conversation([sound(tmp_path / "a.wav", *some, rate=three.rate)])
    assert [s.channel for s in read.conversation.sides] == [0, 2]
    assert said(read, "channel 2, channel 4 skipped")


def test_of_more_speakers_than_may_talk_those_who_say_most_are_kept(tmp_path: Path) -> None:
    rows = [(f"S{n}", n + 0.1 * k) for n in range(10) for k in range(2 + (n > 1))]
    (tmp_path / "a.ctm").write_text("".join(f"x {who} {at:.2f} 0.08 so\n" for who, at in rows))
    read = read_conversation([sound(tmp_path / "a.wav", buzz(11))], [tmp_path / "a.ctm"])
    assert [s.name for s in read.conversation.sides] == [f"S{n}" for n in range(2, 10)]
    assert said(read, "10 speakers", "'S0', 'S1'")


@pytest.mark.nightly
def test_three_who_speak_a_language_each_are_read_each_in_theirs_and_name_each_other(tmp_path: Path) -> None:
    try:
        spoken = maker.three()
    except MissingError as error:
        pytest.skip(str(error))
    maker.write_cues(tmp_path / "a.vtt", spoken.said)
    audio = sound(tmp_path / "a.wav", *spoken.samples, rate=spoken.rate)
    made = read_conversation([audio], [tmp_path / "a.vtt"]).conversation
    assert [(s.name, s.language) for s in made.sides] == [("Ann", "en"), ("Uwe", "de"), ("Zoé", "fr")]
    kinds = [{s.text for s in side.segments if s.kind == "response"} for side in made.sides]
    assert kinds == [{"great"}, {"genau"}, {"d'accord", "oui"}]
    assert [(t.side, t.to) for t in list_addressed_turns(made)] == [(0, 1), (1, 0), (2, 0), (0, 2), (2, 0)]


@pytest.mark.skipif(not SPEECH.is_dir(), reason="the recordings of praatIO are not here")
def test_three_real_voices_one_after_another_are_told_apart_in_channels_and_by_names_in_one(
    tmp_path: Path,
) -> None:
    import soundfile

    voices = [("bobby_16bit_16khz", "bobby_words"), ("mary", "mary"), ("damon_set_test", "damon_set_test")]
    heard, at = np.zeros((3, 0)), 0.0
    lines = []
    for n, (name, words) in enumerate(voices):
        samples, rate = soundfile.read(str(SPEECH / f"{name}.wav"), always_2d=True)
        one = samples[:, 0][:: max(1, rate // RATE)][: 4 * RATE]
        part = np.zeros((3, len(one) + RATE // 2))
        part[n, : len(one)] = one
        (found,) = read_transcript(SPEECH / f"{words}.TextGrid").speakers.values()
        lines += [f"x {group.NAMES[n]} {at + w.start:.3f} {w.end - w.start:.3f} {w.text}" for w in found]
        heard, at = np.concatenate([heard, part], 1), at + part.shape[1] / RATE
    (tmp_path / "all.ctm").write_text("\n".join(lines))
    apart = read_conversation([sound(tmp_path / "a.wav", *heard)], [tmp_path / "all.ctm"])
    assert [(s.name, s.channel) for s in apart.conversation.sides] == [("Ann", 0), ("Ben", 1), ("Cleo", 2)]
    mono = read_conversation([sound(tmp_path / "b.wav", heard.sum(0))], [tmp_path / "all.ctm"])
    for one, other in zip(apart.conversation.sides, mono.conversation.sides, strict=True):
        assert [s.text for s in one.segments] == [s.text for s in other.segments] and one.segments
        for a, b in zip(one.segments, other.segments, strict=True):
            assert a.peak is not None and b.peak == pytest.approx(a.peak, abs=0.05)
    alone = read_conversation([tmp_path / "a.wav"])
    starts = [side.segments[0].start for side in alone.conversation.sides]
    assert starts == sorted(starts) and starts[0] < 1.0, "by loudness, each where it speaks"
