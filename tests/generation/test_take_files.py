"""Folders of takes."""

from __future__ import annotations

from concurrent.futures import CancelledError
from pathlib import Path

import numpy as np
import pytest
import soundfile

from metagraph.errors import FileError
from metagraph.formats.bvh.file import write_bvh
from metagraph.formats.clips import digest
from metagraph.formats.conversations.writers import write_json
from metagraph.formats.gltf.writer import write_glb
from metagraph.generation.features import RATE
from metagraph.generation.take_files import (
    UNLICENSED,
    TakeFiles,
    find_takes,
    read_licence,
    read_speech,
    read_take_batch,
)
from tests.bodies import column
from tests.generation.makers import babble, conversation, moving


def _write(folder: Path, name: str, seconds: float = 6.0, seed: int = 1, sides: int = 2) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    write_bvh(moving(seconds, seed), folder / f"{name}.bvh")
    sound = np.stack([babble(seconds, seed + n) for n in range(sides)])
    soundfile.write(folder / f"{name}.wav", sound.T, RATE)


def test_a_clip_goes_with_the_sound_of_its_name(tmp_path):
    _write(tmp_path / "a", "talk", seed=1)
    _write(tmp_path / "b", "talk", seed=2)
    write_bvh(moving(5), tmp_path / "a" / "alone.bvh")
    found, without = find_takes([tmp_path])
    assert [(f.clip.parent.name, f.sounds[0].parent.name, f.side) for f in found] == [
        ("a", "a", 0),
        ("b", "b", 0),
    ]
    assert len(without) == 1
    assert without[0].startswith("alone.bvh: there is no sound")


def test_two_clips_are_the_sides_of_one_conversation(tmp_path):
    _write(tmp_path, "talk")
    (tmp_path / "talk.bvh").unlink()
    write_bvh(moving(6, 1), tmp_path / "talk_1.bvh")
    write_bvh(moving(6, 2), tmp_path / "Talk_2.bvh")
    found, without = find_takes([tmp_path])
    assert [f.side for f in found] == [0, 1]
    assert without == []
    batch = read_take_batch(found)
    assert not batch.failures
    one, two = batch.takes
    assert np.abs(one.features[:100, :27] - two.features[:100, :27]).max() < 1e-3  # both voices mixed
    assert (one.activity[:, 0] == two.activity[:, 1]).all()
    assert one.activity[:, 0].any()


def test_a_sound_of_each_side_is_heard_as_one_of_two_channels(tmp_path):
    _write(tmp_path, "talk")
    for n in range(2):
        soundfile.write(tmp_path / f"voice {n}.wav", babble(6 - n, 1 + n), RATE)
    together = TakeFiles(tmp_path / "talk.bvh", (tmp_path / "talk.wav",), side=1)
    apart = TakeFiles(tmp_path / "talk.bvh", (tmp_path / "voice 0.wav", tmp_path / "voice 1.wav"), side=1)
    one, two = read_speech(together).samples, read_speech(apart).samples
    assert np.abs(one[:, : 5 * RATE] - two[:, : 5 * RATE])[1].max() < 1e-3
    assert one.shape == two.shape
    assert not two[0, 5 * RATE :].any()


def test_speech_may_lie_elsewhere(tmp_path):
    _write(tmp_path / "motion", "talk")
    (tmp_path / "speech").mkdir()
    (tmp_path / "motion" / "talk.wav").rename(tmp_path / "speech" / "talk.wav")
    assert find_takes([tmp_path / "motion"])[0] == []
    found, _ = find_takes([tmp_path / "motion"], [tmp_path / "speech"])
    assert found[0].sounds[0].parent.name == "speech"


def test_of_several_animations_the_longest_is_taken_and_that_is_told(tmp_path):
    write_glb(tmp_path / "talk.glb", [moving(5.0, 1).renamed("short"), moving(9.0, 2).renamed("long")])
    soundfile.write(tmp_path / "talk.wav", babble(9.0), RATE)
    batch = read_take_batch(find_takes([tmp_path])[0])
    assert batch.takes[0].seconds == pytest.approx(9.0, abs=0.1)
    (note,) = [n for n in batch.notes if "animations" in n]
    assert note.startswith("talk.glb: holds 2 animations") and "'long', 9.0 s" in note


@pytest.mark.nightly
def test_a_bad_take_spoils_no_other(tmp_path):
    _write(tmp_path, "good", seed=1)
    _write(tmp_path, "short", seconds=2.0, seed=2)
    _write(tmp_path, "mute", seed=3)
    soundfile.write(tmp_path / "mute.wav", np.zeros((6 * RATE, 2)), RATE)
    _write(tmp_path, "broken", seed=4)
    (tmp_path / "broken.bvh").write_text("HIERARCHY\nROOT")
    _write(tmp_path, "noise", seed=5)
    (tmp_path / "noise.wav").write_bytes(b"RIFF nothing")
    _write(tmp_path, "crowd", seed=6, sides=3)
    loud = np.clip(np.stack([babble(6, 7, 40.0)] * 2).T, -1, 1)
    _write(tmp_path, "loud", seed=7)
    soundfile.write(tmp_path / "loud.wav", loud, RATE, subtype="FLOAT")
    other = moving(6, 8)
    rest = column()
    other = type(other)(
        "other", rest, 30, np.repeat(rest.rest_rotations[None], 180, 0), np.zeros((180, 1, 3))
    )
    _write(tmp_path, "other", seed=8)
    write_bvh(other, tmp_path / "other.bvh")
    found, _ = find_takes([tmp_path])
    batch = read_take_batch(found)
    assert [t.source.name for t in batch.takes] == ["good"]
    words = {
        name: next(f for f in batch.failures if name in f) for name in ("short", "mute", "broken", "noise")
    }
    assert "too short" in words["short"]
    assert "silent" in words["mute"]
    assert any("3 channels" in f for f in batch.failures)
    assert any("cut off" in f and "loud" in f for f in batch.failures)
    assert any("another skeleton" in f for f in batch.failures)
    assert len(batch.failures) == 7


def test_words_tell_who_says_what(tmp_path):
    _write(tmp_path, "talk", 12.0)
    talk = conversation(12)
    write_json(talk, tmp_path / "talk.json")
    found, _ = find_takes([tmp_path])
    assert found[0].transcripts
    take = read_take_batch(found).takes[0]
    assert take.marks.peaks
    assert not any("speech is detected from loudness" in note for note in take.notes)


def test_both_voices_in_one_channel_are_told_apart_by_words(tmp_path):
    _write(tmp_path, "talk", 12.0, sides=1)
    write_json(conversation(12), tmp_path / "talk.json")
    take = read_take_batch(find_takes([tmp_path])[0]).takes[0]
    assert take.activity[:, 0].any()
    assert take.activity[:, 1].any()
    assert "one channel" in " ".join(take.notes)


def test_where_a_take_is_from_is_kept(tmp_path):
    _write(tmp_path / "deep" / "er", "talk")
    (tmp_path / "LICENSE.txt").write_text("\n  CC BY-NC 4.0  \nmore")
    take = read_take_batch(find_takes([tmp_path])[0]).takes[0]
    folder = tmp_path / "deep" / "er"
    assert take.source.digests == (digest(folder / "talk.bvh"), digest(folder / "talk.wav"))
    assert take.source.licence == "LICENSE.txt: CC BY-NC 4.0"
    (tmp_path / "LICENSE.txt").unlink()
    assert read_licence(folder) == UNLICENSED


def test_reading_can_be_stopped_and_a_missing_folder_is_told(tmp_path):
    _write(tmp_path, "talk")
    with pytest.raises(CancelledError):
        read_take_batch(find_takes([tmp_path])[0], cancelled=lambda: True)
    with pytest.raises(FileError, match="no such folder"):
        find_takes([tmp_path / "nowhere"])
    assert read_take_batch([]).takes == ()


def test_skeletons_without_roles_are_told_once(tmp_path):
    rest = column()
    odd = moving(6, 8)
    odd = type(odd)("odd", rest, 30, np.repeat(rest.rest_rotations[None], 180, 0), np.zeros((180, 1, 3)))
    _write(tmp_path, "odd")
    write_bvh(odd, tmp_path / "odd.bvh")
    batch = read_take_batch(find_takes([tmp_path])[0])
    assert batch.rig is None
    assert "has no" in batch.failures[0]
