"""Takes, their troubles, and which are held out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from metagraph.generation.features import RATE
from metagraph.generation.takes import (
    SplitError,
    TakeError,
    TakeMarks,
    TakeSound,
    TakeSource,
    check_split,
    make_take,
    measure_scales,
    mirror_take,
    share_stretch,
    split_takes,
)
from metagraph.motion.clip import Clip
from tests.bodies import column
from tests.generation.makers import babble, conversation, moving, rig


def _take(seconds=12.0, seed=1, name=None, digests=None, talk=True, **given):
    clip = moving(seconds, seed)
    name = name or f"take {seed}"
    sound = np.stack([babble(seconds, 10 + seed), babble(seconds, 20 + seed)])
    told = conversation(seconds, seed) if talk else None
    source = TakeSource(name, (name,) if digests is None else digests, "MIT")
    heard = TakeSound(given.pop("samples", sound), RATE, given.pop("clipped", ()))
    return make_take(rig(), clip, heard, source, told, **given)


def test_a_take_is_as_long_as_the_shorter_of_motion_and_sound():
    take = _take(8)
    assert take.poses.shape == (201, 78)
    assert take.features.shape == (201, 38)
    assert take.notes == ()
    short = _take(8, samples=np.stack([babble(5, 1), babble(5, 2)]))
    assert len(short.poses) == len(short.features) == 126
    assert "8.0 s" in short.notes[0] and "5.0 s" in short.notes[0]


def test_marks_are_what_one_side_moves_with():
    talk = conversation(12, 1)
    own = {s.peak for s in talk.sides[0].segments if s.kind == "clause"}
    take = _take()
    assert set(take.marks.peaks) == own
    assert take.part(50, 200).marks.peaks == tuple(p - 2 for p in sorted(own) if 2 <= p < 8)
    assert TakeMarks((1.0,), (2.0,), (3.0,)).shifted(1.0, 3.0) == TakeMarks((0.0,), (1.0,), ())


@pytest.mark.parametrize(
    ("given", "why"),
    [
        ({"seconds": 2.0}, r"motion lasts 2\.0 s, too short"),
        ({"samples": np.stack([babble(2, 1)] * 2)}, r"sound lasts 2\.0 s, too short"),
        ({"samples": np.zeros((2, 12 * RATE))}, "its sound is silent"),
        ({"samples": np.full((1, 12 * RATE), np.nan)}, "not a number"),
        ({"clipped": (0.001, 0.07)}, r"7 % of its sound is cut off"),
        ({"talk": False, "samples": np.full((1, 12 * RATE), 0.3)}, "nobody speaks in it|silent"),
    ],
)
def test_a_bad_take_says_what_is_wrong_with_it(given, why):
    with pytest.raises(TakeError, match=why) as told:
        _take(**given)
    assert "take 1" in str(told.value)


def test_another_skeleton_and_one_that_does_not_move_are_refused():
    other = column()
    clip = Clip("odd", other, 30, np.repeat(other.rest_rotations[None], 300, 0), np.zeros((300, 1, 3)))
    sound = np.stack([babble(10, 1), babble(10, 2)])
    with pytest.raises(TakeError, match=r"'odd'.*another skeleton"):
        make_take(rig(), clip, TakeSound(sound, RATE), TakeSource("odd"))
    still = moving(10)
    still = replace(still, rotations=np.repeat(still.rotations[:1], still.frames, 0))
    with pytest.raises(TakeError, match="does not move"):
        make_take(rig(), still, TakeSound(sound, RATE), TakeSource("still"), conversation(10))


@pytest.mark.nightly
def test_what_can_be_learned_from_all_the_same_is_told():
    assert "only one voice" in " ".join(_take(samples=babble(12, 1), talk=False).notes)
    assert "one channel" in " ".join(_take(samples=babble(12, 1)).notes)
    assert "no words" in " ".join(_take(talk=False).notes)
    deaf = np.stack([babble(12, 1), np.zeros(12 * RATE)])
    assert "partner's channel is silent" in " ".join(_take(samples=deaf).notes)
    mute = deaf[::-1]
    assert "channels are swapped" in " ".join(_take(samples=mute).notes)
    assert "is clipped" in " ".join(_take(clipped=(0.001,)).notes)


def test_two_tracks_of_one_voice_leave_the_other_silent():
    take = _take(samples=babble(12, 1), tracks=2)
    assert take.features.shape[1] == 65
    assert np.ptp(take.features[:, 27:54]) == 0


@pytest.mark.nightly
def test_whole_takes_are_held_out_with_all_that_shares_a_file():
    takes = [_take(6, n, digests=(f"motion {n}", f"sound {n // 2}")) for n in range(6)]
    learned, held = split_takes(takes, 0.3)
    assert len(held) == 2
    assert {t.source.digests[1] for t in learned}.isdisjoint(t.source.digests[1] for t in held)
    assert {id(t) for t in (*learned, *held)} == {id(t) for t in takes}
    assert split_takes(takes, 0.3)[1] == held
    assert any(split_takes(takes, 0.3, seed)[1] != held for seed in range(2, 9))


@pytest.mark.nightly
def test_one_recording_gives_a_block_with_six_seconds_cut_away():
    take = _take(60)
    learned, held = split_takes([take], 0.2)
    assert len(learned) == len(held) == 1
    assert held[0].seconds == pytest.approx(12, abs=0.1)
    gap = held[0].source.start - (learned[0].source.start + learned[0].seconds)
    assert gap == pytest.approx(6, abs=0.05)
    with pytest.raises(SplitError, match="too short"):
        split_takes([_take(12)])


@pytest.mark.nightly
def test_pieces_of_one_recording_are_cut_at_the_same_moment():
    take = _take(90)
    learned, held = split_takes([take.part(0, 700), take.part(700, 1500), take.part(1500, 2251)], 0.2)
    begin = min(h.source.start for h in held)
    assert all(t.source.start + t.seconds <= begin - 6 + 0.05 for t in learned)
    assert all(len(t.poses) == len(t.features) > 0 for t in (*learned, *held))
    assert len(take.part(300, 100).poses) == 0


@pytest.mark.nightly
def test_a_mirror_twin_goes_where_its_take_goes():
    clip = moving(60, 1)
    take = _take(60)
    twin = mirror_take(rig(), clip, take)
    assert twin.source.mirrored
    assert np.abs(twin.poses - take.poses).max() > 0.05
    learned, held = split_takes([take, twin], 0.2)
    assert len(learned) == len(held) == 2


def test_a_mirror_twin_in_the_other_half_fails():
    take = _take(20)
    twin = mirror_take(rig(), moving(20, 1), take)
    with pytest.raises(SplitError, match="mirror twin"):
        check_split([take], [twin])
    # Also as another file: it sounds and moves alike.
    stranger = replace(twin, source=TakeSource("flipped", ("other", "files"), mirrored=True))
    with pytest.raises(SplitError, match=r"'flipped' .*mirror twin"):
        check_split([take], [stranger])


@pytest.mark.nightly
def test_an_overlapping_window_in_the_other_half_fails():
    take = _take(40)
    with pytest.raises(SplitError, match="a stretch of it"):
        check_split([take.part(0, 500)], [take.part(400, 900)])
    with pytest.raises(SplitError, match="a stretch of it"):  # too near
        check_split([take.part(0, 500)], [take.part(640, 900)])
    check_split([take.part(0, 500)], [take.part(650, 900)])
    # Cut by somebody else, into a file of its own, between two frames.
    clip = moving(40, 1, fps=100.0)
    sound = np.stack([babble(40, 11), babble(40, 21)])
    whole = make_take(rig(), clip, TakeSound(sound, RATE), TakeSource("whole", ("w",)), conversation(40))
    cut = sound[:, round(12.41 * RATE) :], clip.trimmed(1241)
    window = make_take(rig(), cut[1], TakeSound(cut[0], RATE), TakeSource("window", ("v",)))
    with pytest.raises(SplitError, match="'window' is held out"):
        check_split([whole], [window])


@pytest.mark.nightly
def test_the_same_speech_performed_again_is_another_take():
    one, other = _take(20, 1), _take(20, 2)
    again = replace(other, features=one.features)
    assert not share_stretch(one, again)
    assert not share_stretch(one, replace(other, poses=one.poses))
    assert share_stretch(one, one)
    check_split([one], [other])


def test_empty_halves_are_refused():
    with pytest.raises(SplitError, match="empty"):
        check_split([], [_take(6)])
    with pytest.raises(SplitError, match="no take"):
        split_takes([])


def test_scales_are_of_what_is_learned_from():
    takes = [_take(6, 1), _take(8, 2)]
    poses, audio = measure_scales(takes)
    rows = np.concatenate([t.poses for t in takes])
    assert np.abs(poses.apply(rows).mean(0)).max() < 1e-3
    assert audio.mean.shape == (27,)
    assert np.allclose(poses.deviation, np.maximum(rows.std(0), 0.02), atol=1e-5)
