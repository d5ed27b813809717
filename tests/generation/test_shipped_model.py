"""The model that comes with Metagraph, on sounds that are no voice of those it learned from."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.generation.features import OWN_STRESS, RATE, compute_features, tell_conversation
from metagraph.generation.landmarks import WRISTS, place_landmarks
from metagraph.generation.networks import FPS
from metagraph.generation.offered import SHIPPED
from metagraph.generation.sampler import generate_recording_poses
from metagraph.generation.stored import read_model
from metagraph.graph.conversation.model import Conversation, Segment, Side
from tests.generation.makers import babble

SECONDS, NEAR = 60.0, 0.25


@pytest.fixture(scope="module")
def model():
    return read_model(SHIPPED)


def _speeds(model, features):
    poses = generate_recording_poses(model, features, 1)
    hands = place_landmarks(model.rig, poses)[:, list(WRISTS)]
    return np.linalg.norm(np.diff(hands, axis=0), axis=-1).mean(1)


def _near(speeds, moments):
    at = (np.arange(len(speeds)) + 0.5) / FPS
    return speeds[(np.abs(at[:, None] - np.asarray(moments)) < NEAR).any(1)].mean() / speeds.mean()


def test_hands_move_when_somebody_stresses_whatever_the_voice(model):
    chance = np.random.default_rng(4)
    starts = np.cumsum(chance.uniform(2.2, 4.0, 17))
    peaks = [float(s + chance.uniform(0.2, 1.5)) for s in starts if s + 2 < SECONDS]
    said = tuple(Segment("clause", s, s + 1.8, p) for s, p in zip(starts.tolist(), peaks, strict=False))
    talk = Conversation(name="t", length=SECONDS, sides=(Side(segments=said), Side()))
    sound = np.stack([babble(SECONDS, 7), np.zeros(round(SECONDS * RATE))])
    told = tell_conversation(talk, 0, round(SECONDS * FPS) + 1)
    speeds = _speeds(model, compute_features(sound, told))
    assert _near(speeds, peaks) > 1.5
    elsewhere = told.copy()
    elsewhere[:, OWN_STRESS] = np.roll(told[:, OWN_STRESS], 30)  # so it is the marks that it follows
    assert _near(_speeds(model, compute_features(sound, elsewhere)), peaks) < 1.3
