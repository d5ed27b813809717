"""Corpora of two who talk, in the layouts they are published in: files of the same form, made here."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from metagraph.errors import FileError
from metagraph.formats.bvh.file import write_bvh
from metagraph.formats.corpora import CorpusReading, _as_long, _early_words, read_corpus
from metagraph.graph.conversation.model import Conversation, Side, Word, list_segments_heard_by
from metagraph.graph.face.takes import FACE_SKELETON
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.synthesis.cooccurrence import count_cooccurrence
from tests.synthesis.talking import speech, talking
from tests.wavs import wav

SECONDS = 12.0
RATE = 16000


def voice(chunks: list[tuple[float, float]], pitch: float = 120.0) -> np.ndarray:
    """A buzz where somebody speaks, silence elsewhere."""
    t = np.arange(round(SECONDS * RATE)) / RATE
    on = np.zeros(len(t))
    for a, b in chunks:
        on[(t >= a) & (t < b)] = 1.0
    buzz = sum(np.sin(2 * np.pi * pitch * k * t) / k for k in range(1, 12))
    noise = np.random.default_rng(round(pitch)).standard_normal(len(t))
    return (0.08 * on * buzz + 1e-4 * noise).astype(np.float32)


WORDS = {
    0: [
        (1.0, 1.4, "so"),
        (1.4, 1.8, "that"),
        (1.8, 2.4, "was"),
        (2.4, 3.0, "big"),
        (6.0, 6.3, "um"),
        (7.0, 8.0, "then"),
    ],
    1: [(3.3, 3.7, "yeah"), (8.6, 9.2, "i"), (9.2, 9.9, "know"), (9.9, 10.6, "them")],
}


def sound(path: Path, *sides: int) -> None:
    tracks = [voice([(a, b) for a, b, _ in WORDS[s]], 110.0 + 70 * s) for s in sides]
    samples = (np.stack(tracks, axis=1) * 32000).astype("<i2")
    wav(path, RATE, samples.tobytes(), len(sides))


def motion(path: Path, seed: int = 1) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    write_bvh(talking(path.stem, speech(SECONDS, seed), SECONDS, seed), path)


def text(path: Path, content: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(content, encoding="utf-8")


def rows(side: int) -> str:
    return "".join(f"{a}\t{b}\t{w}\n" for a, b, w in WORDS[side])


def grid(side: int) -> str:
    """A TextGrid as forced aligners write them."""
    marks, at = [], 0.0
    for a, b, w in WORDS[side]:
        marks += [(at, a, ""), (a, b, w)]
        at = b
    marks.append((at, SECONDS, ""))
    body = "".join(f'{a}\n{b}\n"{w}"\n' for a, b, w in marks if b > a)
    count = sum(b > a for a, b, _ in marks)
    head = 'File type = "ooTextFile"\nObject class = "TextGrid"\n\n'
    head += f'0\n{SECONDS}\n<exists>\n1\n"IntervalTier"\n"words"\n'
    return f"{head}0\n{SECONDS}\n{count}\n{body}"


def kinds(talk: Conversation, side: int) -> list[str]:
    return [s.kind for s in talk.sides[side].segments]


def test_no_folder_and_no_motion_say_so(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="no such folder"):
        read_corpus(tmp_path / "gone")
    with pytest.raises(FileError, match="it holds no motion"):
        read_corpus(tmp_path)


def test_motion_without_sound_says_what_is_missing(tmp_path: Path) -> None:
    motion(tmp_path / "18_08.bvh")
    with pytest.raises(FileError, match="no sound"):
        read_corpus(tmp_path)


def test_genea_has_two_folders_and_a_table_of_words_each(tmp_path: Path) -> None:
    for n, who in enumerate(("main-agent", "interloctr")):
        stem = f"trn_2023_v0_000_{who}"
        motion(tmp_path / "trn" / who / "bvh" / f"{stem}.bvh", n + 1)
        sound(tmp_path / "trn" / who / "wav" / f"{stem}.wav", n)
        text(tmp_path / "trn" / who / "tsv" / f"{stem}.tsv", rows(n))
    found = read_corpus(tmp_path)
    assert found.layout == "genea" and not found.failures
    (one,) = found.recorded
    assert one.name == "trn_2023_v0_000" and all(c is not None for c in one.clips)
    assert kinds(one.conversation, 0) == ["clause", "hesitation", "clause"]
    assert kinds(one.conversation, 1) == ["response", "clause"]
    assert "hesitation" in [s.kind for s in list_segments_heard_by(one.conversation, 1)]


def test_talking_with_hands_tells_persons_by_their_marks(tmp_path: Path) -> None:
    for n, who in enumerate(("deep5", "shallow12")):
        motion(
            tmp_path / "mocap_data" / "session3" / "take7" / f"take7_noFingers_{who}_scale_local.bvh", n + 1
        )
        sound(tmp_path / "audio_data" / "session3" / "take7" / f"take7_{who}.wav", n)
    found = read_corpus(tmp_path)
    assert found.layout == "talking-with-hands"
    (one,) = found.recorded
    assert one.name == "session3 take7" and all(c is not None for c in one.clips)
    assert any("loudness tells clauses" in note for note in one.notes)
    assert kinds(one.conversation, 0) and kinds(one.conversation, 1)


@pytest.mark.parametrize(
    ("factor", "share", "words"), [(5.0, 1.0, "at which it is as long"), (1.0, 0.55, "check"), (1.0, 1.0, "")]
)
def test_motion_of_another_length_than_its_sound_is_put_right_where_a_usual_rate_fits_and_said(
    tmp_path: Path, factor: float, share: float, words: str
) -> None:
    stem = "1_ann_0_1_1"
    clip = talking(stem, speech(SECONDS, 1), SECONDS, 1)
    clip = clip.trimmed(0, round(share * clip.frames))
    write_bvh(replace(clip, fps=clip.fps / factor), tmp_path / f"{stem}.bvh")
    sound(tmp_path / f"{stem}.wav", 0)
    text(tmp_path / f"{stem}.TextGrid", grid(0))
    found = read_corpus(tmp_path)
    (one,) = found.recorded
    read = one.clips[0]
    assert read is not None and read.fps == pytest.approx(30.0, rel=1e-3)
    told = [note for note in one.notes if "its motion lasts" in note]
    assert [words in note for note in told] == ([True] if words else [])


def test_of_beat_one_side_is_heard_and_its_face_is_no_transcript(tmp_path: Path) -> None:
    stem = tmp_path / "1" / "1_wayne_0_1_1"
    motion(stem.with_suffix(".bvh"))
    sound(stem.with_suffix(".wav"), 0)
    text(stem.with_suffix(".TextGrid"), grid(0))
    text(stem.with_suffix(".json"), '{"names": [], "frames": []}')
    found = read_corpus(tmp_path)
    assert found.layout == "beat"
    (one,) = found.recorded
    assert one.clips[0] is not None and one.clips[1] is None
    assert kinds(one.conversation, 0) == ["clause", "hesitation", "clause"]
    assert kinds(one.conversation, 1) == []


def test_pairs_share_one_sound_of_two_channels(tmp_path: Path) -> None:
    for n in (0, 1):
        motion(tmp_path / f"talk_{n + 1}.bvh", n + 1)
        text(tmp_path / f"talk_{n + 1}.tsv", rows(n))
    sound(tmp_path / "talk.wav", 0, 1)
    (one,) = read_corpus(tmp_path).recorded
    assert one.name == "talk" and all(c is not None for c in one.clips)
    assert kinds(one.conversation, 1) == ["response", "clause"]


@pytest.mark.nightly
def test_a_number_that_tells_no_side_is_part_of_the_name(tmp_path: Path) -> None:
    for name in ("job interview 1", "job interview 2"):
        motion(tmp_path / f"{name}_female.bvh")
        motion(tmp_path / f"{name}_male.bvh", 2)
        sound(tmp_path / f"{name}.wav", 0, 1)
    names = [r.name for r in read_corpus(tmp_path).recorded]
    assert names == ["job interview 1", "job interview 2"]
    motion(tmp_path / "alone_1.bvh")
    sound(tmp_path / "alone_1.wav", 0)
    text(tmp_path / "alone_1.tsv", rows(0))
    assert "alone_1" in [r.name for r in read_corpus(tmp_path).recorded]


def test_one_name_in_two_folders_is_two_conversations(tmp_path: Path) -> None:
    for day in ("monday", "tuesday"):
        for n in (1, 2):
            motion(tmp_path / day / f"talk_{n}.bvh", n)
        sound(tmp_path / day / "talk.wav", 0, 1)
    (tmp_path / ".trash").mkdir()
    sound(tmp_path / ".trash" / "talk.wav", 0)
    found = read_corpus(tmp_path).recorded
    assert [r.name for r in found] == ["monday/talk", "tuesday/talk"]
    assert all(r.clips[1] is not None and {p.parent for p in r.files} == {tmp_path / d} for r, d in
               zip(found, ("monday", "tuesday"), strict=True))  # fmt: skip


def test_two_clips_of_one_side_are_not_taken_for_both_and_that_is_told(tmp_path: Path) -> None:
    place = tmp_path / "mocap_data" / "session1" / "take2"
    for name in ("hasFingers_deep1", "noFingers_deep1", "noFingers_shallow9"):
        motion(place / f"take2_{name}_scale_local.bvh")
    sound(tmp_path / "audio_data" / "session1" / "take2" / "both.wav", 0, 1)
    (one,) = read_corpus(tmp_path).recorded
    assert all(c is not None for c in one.clips)
    assert any("noFingers_deep1_scale_local.bvh" in note for note in one.notes)


def test_a_bad_conversation_fails_alone(tmp_path: Path) -> None:
    for name in ("good", "bad"):
        motion(tmp_path / f"{name}_1.bvh")
        motion(tmp_path / f"{name}_2.bvh", 2)
        sound(tmp_path / f"{name}.wav", 0, 1)
    (tmp_path / "bad_2.bvh").write_bytes(b"HIERARCHY\nnothing")
    found = read_corpus(tmp_path)
    assert [r.name for r in found.recorded] == ["good"]
    assert len(found.failures) == 1 and "bad_2.bvh" in found.failures[0]


def test_what_is_read_is_counted_as_the_paper_counts(tmp_path: Path) -> None:
    for n, who in enumerate(("main-agent", "interloctr")):
        stem = f"val_2023_v0_001_{who}"
        motion(tmp_path / who / "bvh" / f"{stem}.bvh", n + 1)
        sound(tmp_path / who / "wav" / f"{stem}.wav", n)
        text(tmp_path / who / "tsv" / f"{stem}.tsv", rows(n))
    found: CorpusReading = read_corpus(tmp_path)
    (one,) = found.recorded
    clip = one.clips[0]
    assert clip is not None
    counted = {
        r.hypothesis: r.total
        for r in count_cooccurrence([clip], [list_segments_heard_by(one.conversation, 0)], 3)
    }
    assert counted["clause with either hand"] == 2 and counted["partner's hesitation with a nod"] == 0


# --- lengths of motion, sound and words


def still(frames: int, fps: float) -> Clip:
    places = np.zeros((frames, 1, 3))
    return Clip("a", FACE_SKELETON, fps, rotation.make_identity_rotations((frames, 3)), places, (0,))


@pytest.mark.parametrize(
    ("frames", "said", "sound", "rate"),
    [
        (4800, 24.0, 40.0, 120.0),
        (5040, 24.0, 40.0, 120.0),  # the motion goes on for 2 s
        (600, 30.0, 40.0, 15.0),
        (1200, 30.0, 40.0, 30.0),
        (1200, 120.0, 40.0, 30.0),
    ],
)
def test_motion_is_read_at_the_rate_at_which_it_is_as_long_as_its_sound(
    frames: int, said: float, sound: float, rate: float
) -> None:
    found, told = _as_long(still(frames, said), sound)
    assert found.fps == rate and bool(told) == (said != rate)


def test_motion_that_fits_its_sound_at_no_rate_is_told() -> None:
    found, told = _as_long(still(10, 30.0), 40.0)
    assert found.fps == 30 and "check that they belong together" in told[0]


def test_words_that_end_long_before_their_sound_are_told() -> None:
    def talk(last: float) -> Conversation:
        return Conversation(
            name="t", length=40, sides=(Side(words=(Word(text="so", start=0, end=last),)), Side())
        )

    assert "its words end at 9 s" in _early_words(talk(9.0))[0]
    assert not _early_words(talk(35.0))
