from dataclasses import replace

import numpy as np
import pytest
from msgspec.structs import replace as changed

from metagraph.generation.features import (
    RATE,
    compute_conversation_activity,
    compute_features,
    count_sound_frames,
)
from metagraph.generation.poses import decode_poses, encode_clip, encode_rotations
from metagraph.generation.sampler import make_clip_from_poses, sample_whole
from metagraph.generation.stored import TakeCard
from metagraph.generation.takes import SplitError, Take, TakeMarks, TakeSource, split_takes
from metagraph.research.generation.evaluation import (
    HeldOut,
    SamplingManner,
    find_takes_unseen_by_all,
    find_unseen_takes,
    generate_poses,
    judge_on_takes,
)
from tests.generation.makers import babble, conversation, moving, rig, untrained

SECONDS = 12.0


def take(name: str, seed: int, seconds: float = SECONDS) -> Take:
    own = rig()
    samples = np.stack([babble(seconds, seed), babble(seconds, seed + 50)])
    poses = encode_clip(own, moving(seconds, seed), 25.0)
    count = min(len(poses), count_sound_frames(samples.shape[1]))
    heard = compute_features(samples, compute_conversation_activity(conversation(seconds, seed), 0, count))
    source = TakeSource(name, (f"motion of {name}", f"sound of {name}"))
    return Take(source, poses[:count], heard[:count], TakeMarks((2.0, 5.0), (3.0,), (7.0,)))


TAKES = (take("a", 1), take("b", 2))


def card_of(t: Take) -> TakeCard:
    return TakeCard(name=t.source.name, sha256=t.source.digests, seconds=t.seconds)


def taught(learned, held=()):
    model = untrained("flow-vae")
    card = changed(model.card, takes=tuple(map(card_of, learned)), held_out=tuple(map(card_of, held)))
    return replace(model, card=card)


@pytest.mark.parametrize("kind", ["flow-vae", "cvae", "matching"])
def test_what_is_judged_is_what_a_user_gets(kind):
    model = untrained(kind)
    samples = np.stack([babble(4.0, 1), babble(4.0, 2)])
    count = count_sound_frames(samples.shape[1])
    activity = compute_conversation_activity(conversation(4.0), 0, count)
    clip = sample_whole(model, samples, activity, seed=3, take=0)
    made = generate_poses(model, compute_features(samples, activity), 3, 0, SamplingManner())
    assert made.shape == (count, model.rig.numbers)
    whole_rotations = encode_rotations(model.rig, clip.rotations)
    assert np.allclose(
        encode_rotations(
            model.rig, make_clip_from_poses(model, decode_poses(model.rig, made), "again").rotations
        ),
        whole_rotations,
        atol=1e-5,
    )
    assert RATE == 16000


def test_takes_that_were_learned_from_are_left_out():
    fresh, left = find_unseen_takes(taught([TAKES[0]], [TAKES[1]]), TAKES)
    assert [t.source.name for t in fresh] == ["b"] and left == ("a",)


def test_a_sound_that_was_learned_from_is_enough_to_be_left_out():
    other_side = replace(TAKES[1], source=TakeSource("b", ("other motion", "sound of a")))
    with pytest.raises(SplitError, match="learned from"):
        find_unseen_takes(taught([TAKES[0]]), [other_side])


def test_a_model_is_not_judged_on_what_it_knows():
    with pytest.raises(SplitError, match=r"all 2 takes .* says nothing"):
        find_unseen_takes(taught(TAKES), TAKES)


@pytest.mark.nightly
def test_of_one_recording_the_block_that_was_held_out_is_taken():
    long = take("long", 3, 60.0)
    learned, held = split_takes([long])
    fresh, left = find_unseen_takes(taught(learned, held), [long])
    assert [(t.source.start, t.seconds) for t in fresh] == [(t.source.start, t.seconds) for t in held]
    assert not left


def test_several_models_share_what_none_has_seen():
    third = take("c", 4)
    models = {"x": taught([TAKES[0]]), "y": taught([TAKES[1]])}
    fresh, left = find_takes_unseen_by_all(models, (*TAKES, third))
    assert [t.source.name for t in fresh] == ["c"] and set(left) == {"a", "b"}
    with pytest.raises(SplitError):
        find_takes_unseen_by_all(models, TAKES)


def test_the_table_has_the_truth_what_stands_beside_it_and_each_model():
    told = []
    judged = judge_on_takes(
        rig(),
        {"one": untrained("flow-vae")},
        HeldOut(TAKES, floor=[t.poses[::-1] for t in TAKES]),
        manner=SamplingManner(seeds=2),
        draws=3,
        progress=lambda *x: told.append(x),
    )
    assert [r.name for r in judged.rows] == ["true", "floor", "mismatched", "mean pose", "one"]
    true = judged.rows[0].values
    assert (
        true["speed"] == pytest.approx(1) and true["distance"] == pytest.approx(0) and true["diversity"] > 0
    )
    assert len(judged.made["one"]) == 2 and judged.rows[-1].values["diversity"] > 0
    assert told == [(n, 4) for n in range(4)]


def test_what_a_model_hears_can_be_changed():
    deaf = judge_on_takes(
        rig(),
        {"one": untrained("cvae")},
        HeldOut(TAKES[:1]),
        manner=SamplingManner(seeds=1),
        draws=1,
        hear=lambda _, t: np.repeat(t.features[:1], len(t.features), 0),
    )
    hears = judge_on_takes(
        rig(), {"one": untrained("cvae")}, HeldOut(TAKES[:1]), manner=SamplingManner(seeds=1), draws=1
    )
    assert np.abs(deaf.made["one"][0][0].poses - hears.made["one"][0][0].poses).max() > 1e-4


def test_nothing_to_judge_is_refused_in_words():
    with pytest.raises(ValueError, match="no take"):
        judge_on_takes(rig(), {}, HeldOut(()))
    with pytest.raises(ValueError, match="1 to 100 seeds"):
        judge_on_takes(rig(), {}, HeldOut(TAKES), manner=SamplingManner(seeds=0))
