"""Motion from what is heard."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace as changed

from metagraph.generation.features import (
    OWN_STRESS,
    RATE,
    compute_conversation_activity,
    count_audio,
    count_sound_frames,
    encode_activity,
    tell_conversation,
)
from metagraph.generation.networks import Control, FlowSizes, make_sizes
from metagraph.generation.noise import draw_noise
from metagraph.generation.poses import PoseError
from metagraph.generation.sampler import (
    TakeSampler,
    hear_activity,
    make_clip_from_poses,
    make_conversation_motion,
    read_first_pose,
    sample_whole,
)
from metagraph.generation.stored import Model
from metagraph.motion import rotation
from tests.generation.makers import babble, conversation, moving, stance, untrained

KINDS = ("flow-vae", "moglow", "cvae", "matching")
MODELS = {kind: untrained(kind) for kind in KINDS}
SOUND = np.stack([babble(3, 1), babble(3, 2)])
TOLD = compute_conversation_activity(conversation(3), 0, count_sound_frames(SOUND.shape[1]))


def _made(kind, **given):
    return sample_whole(MODELS[kind], SOUND, TOLD, **given)


@pytest.mark.parametrize("kind", KINDS)
def test_the_same_seed_gives_the_same_bytes_and_another_others(kind):
    one, again, other = _made(kind, seed=3), _made(kind, seed=3), _made(kind, seed=4)
    assert one.rotations.tobytes() == again.rotations.tobytes()
    assert np.abs(one.rotations - other.rotations).max() > 1e-4
    assert np.abs(one.rotations - _made(kind, seed=3, take=1).rotations).max() > 1e-4
    assert one.frames == 76
    assert one.fps == 25


@pytest.mark.parametrize("kind", KINDS)
def test_without_temperature_nothing_happens_by_chance(kind):
    cold = [_made(kind, seed=s, temperature=0.0).rotations for s in (1, 2)]
    assert cold[0].tobytes() == cold[1].tobytes()
    assert cold[0].std(0).sum() < _made(kind, temperature=1.0).rotations.std(0).sum()


@pytest.mark.nightly
@pytest.mark.parametrize("kind", KINDS)
@settings(max_examples=8)
@given(cuts=st.lists(st.integers(0, SOUND.shape[1]), max_size=6), lookahead=st.sampled_from([None, 0, 3]))
def test_in_pieces_motion_is_the_same_to_the_bit(kind, cuts, lookahead):
    def run(edges):
        sampler = TakeSampler(MODELS[kind], 5, lookahead=lookahead)
        out = []
        for a, b in pairwise(edges):
            before, now = (min(len(TOLD), -(-x // 640)) for x in (a, b))
            out.append(sampler.push(SOUND[:, a:b], TOLD[before:now]))
        out.append(sampler.push(SOUND[:, :0], TOLD[min(len(TOLD), -(-edges[-1] // 640)) :]))
        return np.concatenate([*out, sampler.finish()])

    end = SOUND.shape[1]
    assert run([0, *sorted(cuts), end]).tobytes() == run([0, end]).tobytes()


@pytest.mark.nightly
@pytest.mark.parametrize("kind", [*KINDS, "window"])
@pytest.mark.parametrize("lookahead", [None, 0, 9])
def test_of_the_sizes_in_use_too_frames_one_by_one_are_the_same_to_the_bit(kind, lookahead):
    """Products of larger arrays are made in other ways; so are those of the paper's windows."""
    if kind == "window":
        sizes = FlowSizes(pose=78, control=Control(kind="window"), dims=35, steps=2, units=150, layers=2)
    else:
        sizes = make_sizes(kind)
    model = untrained("flow-vae" if kind == "window" else kind, sizes=sizes)
    pushed, at_once, fed = (TakeSampler(model, 5, lookahead=lookahead, start=3) for _ in range(3))
    out, made = [], []
    for n in range(75):
        out.append(pushed.push(SOUND[:, n * 640 : (n + 1) * 640], TOLD[n : n + 1]))
        fed.feed(SOUND[:, n * 640 : (n + 1) * 640], TOLD[n : n + 1])
        while (ready := fed.advance()) is not None:
            made.append(ready)
    for sampler, parts in ((pushed, out), (fed, made)):
        parts.append(sampler.push(SOUND[:, :0], TOLD[75:]))
        parts.append(sampler.finish())
    whole = np.concatenate([at_once.push(SOUND, TOLD), at_once.finish()])
    assert len(whole) == 76
    assert np.concatenate(out).tobytes() == whole.tobytes()
    assert np.concatenate(made).tobytes() == whole.tobytes()


@pytest.mark.parametrize("kind", KINDS)
def test_poses_come_out_no_later_than_the_delay_says(kind):
    for lookahead in (0, 5, None):
        sampler = TakeSampler(MODELS[kind], lookahead=lookahead)
        heard = made = 0
        for n in range(60):
            made += len(sampler.push(SOUND[:, n * 640 : (n + 1) * 640], TOLD[n : n + 1]))
            heard = max(0, n * 640 + 128) // 640 + 1 if n else 1
            assert made >= heard - sampler.delay - 1
        assert made < 60 or sampler.delay == 0


@pytest.mark.parametrize("kind", ["flow-vae", "cvae", "matching"])
def test_what_is_not_yet_said_changes_nothing(kind):
    """With a look-ahead of 4, what comes 5 frames later is not heard."""
    other = SOUND.copy()
    other[:, 40 * 640 :] = np.stack([babble(3, 8), babble(3, 9)])[:, 40 * 640 :]
    made = [sample_whole(MODELS[kind], s, TOLD, lookahead=4, smooth=0) for s in (SOUND, SOUND)]
    sampler = [TakeSampler(MODELS[kind], lookahead=4, smooth=0) for _ in range(2)]
    made = [
        np.concatenate([p.push(s, TOLD), p.finish()]) for p, s in zip(sampler, (SOUND, other), strict=True)
    ]
    # The window of frame 39 reaches 512 samples into what differs; pieces wait for their neighbours.
    sure = 40 - 1 - sampler[0].delay
    assert sure >= 40 - 1 - 4 - 4
    assert (made[0][:sure] == made[1][:sure]).all()
    assert (made[0] != made[1]).any()


@pytest.mark.parametrize("kind", ["flow-vae", "moglow", "matching"])
def test_it_goes_on_from_a_stance(kind):
    """Poses before the first frame are heard, and what the model does not move stays as the stance has it."""
    raised = moving(2, seed=9)
    first = read_first_pose(raised, 1.0)
    own, mean = _made(kind, first=first), _made(kind)
    assert np.abs(own.rotations[0] - mean.rotations[0]).max() > 1e-5
    rig = MODELS[kind].rig
    others = [j for j in range(len(rig.skeleton)) if j not in rig.joints]
    assert np.degrees(rotation.measure_angle_between(own.rotations[:, others], first[others]).max()) < 0.05


@pytest.mark.parametrize("kind", KINDS)
def test_who_speaks_and_what_is_said_matter(kind):
    listening = np.roll(TOLD, 1, axis=1)
    assert np.abs(_made(kind).rotations - sample_whole(MODELS[kind], SOUND, listening).rotations).max() > 1e-6
    assert (
        np.abs(_made(kind).rotations - sample_whole(MODELS[kind], SOUND[::-1] * 0, TOLD).rotations).max()
        > 1e-6
    )


def test_marks_matter_to_a_model_that_is_told_them_and_to_no_other():
    told = tell_conversation(conversation(3), 0, count_sound_frames(SOUND.shape[1]))
    other = told.copy()
    other[:, OWN_STRESS] = np.roll(told[:, OWN_STRESS], 20)
    hears = changed(MODELS["matching"].card.sizes, audio=count_audio("matching"))
    for model, matters in ((untrained("matching", sizes=hears), True), (MODELS["matching"], False)):
        made = [sample_whole(model, SOUND, t).rotations for t in (told, other)]
        assert (np.abs(made[0] - made[1]).max() > 1e-6) == matters
        sampler = TakeSampler(model, channels=2)  # live, nobody tells them
        sampler.push(SOUND, told[:, -4:])
        assert np.isfinite(sampler.finish()).all()


def test_closer_to_the_speech_is_another_motion():
    plain, close = _made("matching", guidance=1.0), _made("matching", guidance=3.0)
    assert np.abs(plain.rotations - close.rotations).max() > 1e-5


@pytest.mark.parametrize("guided", [True, False])
def test_a_flow_is_guided_if_it_has_learned_to_be(guided):
    sizes = FlowSizes(
        control=Control(width=8, past=2),
        between=16,
        dims=7,
        steps=3,
        units=6,
        span=4,
        guess=True,
        guided=guided,
    )
    model = untrained("flow-vae", 0.05, sizes)
    none, plain, close = (sample_whole(model, SOUND, TOLD, guidance=w).rotations for w in (0.0, 1.0, 3.0))
    assert (np.abs(plain - close).max() > 1e-5) == guided
    # Without any, nothing that is said matters: only who speaks does.
    other = sample_whole(model, 0 * SOUND, TOLD, guidance=0.0).rotations
    assert (np.abs(none - other).max() < 1e-6) == guided


@pytest.mark.parametrize("kind", KINDS)
def test_weights_that_run_away_give_rotations_all_the_same(kind):
    wild = untrained(kind, by=3.0)
    clip = sample_whole(wild, SOUND, TOLD, temperature=1.2)
    assert np.isfinite(clip.rotations).all()
    assert np.abs(np.linalg.norm(clip.rotations, axis=-1) - 1).max() < 1e-5


def test_a_conversation_gives_a_clip_of_its_length_on_the_models_skeleton():
    talk = conversation(3)
    clip = make_conversation_motion(MODELS["flow-vae"], talk, 1, SOUND[::-1], seed=2)
    assert clip.skeleton == stance().skeleton
    assert clip.duration == pytest.approx(3.0)
    assert clip.name == "talk, side 2"
    assert "seed 2" in clip.notes[0]
    legs = [clip.skeleton.index(n) for n in clip.skeleton.names if "leg" in n.lower()]
    assert legs
    assert np.ptp(clip.rotations[:, legs], axis=0).max() == 0


def test_the_shortest_sounds_are_moved_to():
    for samples in (1, 639, 640, 1000):
        for kind in KINDS:
            sound = SOUND[:, :samples]
            assert sample_whole(
                MODELS[kind], sound, TOLD[: count_sound_frames(samples)]
            ).frames == count_sound_frames(samples)
    with pytest.raises(ValueError, match="no sound"):
        sample_whole(MODELS["cvae"], SOUND[:, :0], TOLD[:0])
    assert len(TakeSampler(MODELS["cvae"]).finish()) == 0


def test_one_voice_alone_will_do():
    told = hear_activity(SOUND[0])
    assert told.shape == (count_sound_frames(SOUND.shape[1]), 9)
    assert sample_whole(MODELS["flow-vae"], SOUND[0], told).frames == 76


def test_what_cannot_be_sampled_is_told():
    model = MODELS["flow-vae"]
    with pytest.raises(ValueError, match=r"1\.2, not 2"):
        TakeSampler(model, temperature=2)
    with pytest.raises(ValueError, match="whole numbers from 0"):
        TakeSampler(model, -1)
    with pytest.raises(ValueError, match="finite"):
        TakeSampler(model, guidance=np.nan)
    with pytest.raises(PoseError, match="another skeleton"):
        TakeSampler(model, first=np.zeros((3, 4)))


def test_noise_is_of_seed_take_and_frame_alone():
    assert (draw_noise(1, 2, 3, 9) == draw_noise(1, 2, 3, 9)).all()
    assert (draw_noise(1, 2, 3, 5)[:2] == draw_noise(1, 2, 3, 5)[:2]).all()
    rows = [
        draw_noise(s, t, f, 64) for s, t, f in ((1, 2, 3), (2, 2, 3), (1, 3, 3), (1, 2, 4), (2**64 - 1, 0, 0))
    ]
    for n, one in enumerate(rows):
        assert all(abs(np.corrcoef(one, other)[0, 1]) < 0.5 for other in rows[n + 1 :])
    many = np.concatenate([draw_noise(7, 0, f, 101) for f in range(1000)])
    assert abs(many.mean()) < 0.01
    assert abs(many.std() - 1) < 0.01
    assert abs((many**4).mean() - 3) < 0.1
    assert draw_noise(1, 1, 1, 3)[:3] == pytest.approx(draw_noise(1, 1, 1, 3))


def test_what_begins_later_has_the_chance_of_its_own_frames():
    """A model that hears nothing and remembers nothing makes the same frames from wherever it begins."""
    model = MODELS["cvae"]
    deaf = {n: w * (0 if "_hh_" in n or n.startswith("control") else 1) for n, w in model.weights.items()}
    for name in (n for n in deaf if n.startswith("decoder.") and "bias" in n):
        deaf[name] = deaf[name].copy()
        deaf[name].reshape(4, -1)[1] -= 100  # forgets
    made = [
        np.concatenate([s.push(SOUND[:, a * 640 :], TOLD[a:]), s.finish()])
        for a in (0, 20)
        for s in [TakeSampler(Model(model.card, deaf), 3, start=a)]
    ]
    assert np.abs(made[0][20:] - made[1]).max() < 1e-5
    assert np.abs(made[0][:-20] - made[1]).max() > 1e-3


def test_nobody_speaking_is_a_take_too():
    quiet = encode_activity(np.zeros(26, bool), np.zeros(26, bool))
    clip = sample_whole(MODELS["flow-vae"], np.zeros((2, RATE)), quiet)
    assert clip.frames == 26
    assert make_clip_from_poses(MODELS["flow-vae"], np.zeros((1, 13, 4)) + rotation.IDENTITY, "x").frames == 1
