"""Poses as engines get them."""

from __future__ import annotations

import json

import numpy as np
import pytest

from metagraph.graph.model import Project
from metagraph.graph.requests import RequestError
from metagraph.live.live_session import LiveSession
from metagraph.live.messages import Poses
from metagraph.live.pose_stream import HEADER, Stream, collect_due_frames, encode_pose_frame
from tests.posing import pose_at


def test_streams_of_one_rate_get_the_same_bytes_once(sample: Project) -> None:
    session = LiveSession(sample)
    streams = [(n, Stream.of(Poses(rate=30), sample, 0.01 * n)) for n in range(3)] + [
        (9, Stream.of(Poses(rate=30, format="binary"), sample, 0.0))
    ]
    frames = collect_due_frames(0.1, session.evaluator, streams)
    assert [f.clients for f in frames] == [(0, 1, 2), (9,)] and [f.binary for f in frames] == [False, True]
    assert collect_due_frames(0.11, session.evaluator, streams) == []
    assert len(collect_due_frames(0.1 + 1 / 30, session.evaluator, streams)) == 2


def test_after_a_pause_one_pose_comes_not_all_that_were_missed(sample: Project) -> None:
    session = LiveSession(sample)
    streams = [(1, Stream.of(Poses(rate=60), sample, 0.0))]
    assert len(collect_due_frames(5.0, session.evaluator, streams)) == 1
    assert collect_due_frames(5.001, session.evaluator, streams) == []


def test_joints_come_in_the_order_they_were_named(sample: Project) -> None:
    assert sample.skeleton is not None
    names = ("Head", "Hips", "Spine")
    stream = Stream.of(Poses(joints=names, format="binary"), sample, 0.0)
    session = LiveSession(sample)
    pose = pose_at(session.plan, sample, 1.0)
    data = encode_pose_frame(stream, 1.0, pose, None, {})
    numbers = np.frombuffer(data, "<f4", offset=HEADER.size)
    places = [sample.skeleton.names.index(n) for n in names]
    np.testing.assert_array_equal(numbers[3:15].reshape(3, 4), pose.rotations[places].astype(np.float32))
    np.testing.assert_array_equal(numbers[:3], pose.translations[0].astype(np.float32))


def test_weights_of_morph_targets_come_in_the_order_of_the_greeting(sample: Project) -> None:
    stream = Stream.of(Poses(joints=(), format="binary"), sample, 0.0)
    stream.morphs = ("a", "b", "c")
    data = encode_pose_frame(
        stream, 2.5, pose_at(LiveSession(sample).plan, sample, 1.0), None, {"b": 0.5, "other": 1.0}
    )
    assert HEADER.unpack_from(data)[1:] == (0, 0, 3, 0, 2.5)
    assert np.frombuffer(data, "<f4", offset=HEADER.size)[3:].tolist() == [0.0, 0.5, 0.0]


def test_weights_are_there_at_rest_too(sample: Project) -> None:
    stream = Stream.of(Poses(joints=()), sample, 0.0)
    stream.morphs = ("a", "b")
    pose = pose_at(LiveSession(sample).plan, sample, 1.0)
    assert json.loads(encode_pose_frame(stream, 2.5, pose, None, {"b": 0.5}))["weights"] == {
        "a": 0.0,
        "b": 0.5,
    }
    stream.wish = Poses(joints=(), format="osc")
    assert b"/metagraph/weight\0\0\0,sf\0a" in encode_pose_frame(stream, 2.5, pose, None, {})


def test_what_is_not_there_cannot_be_streamed(sample: Project) -> None:
    with pytest.raises(RequestError, match="no joint 'Tail'"):
        Stream.of(Poses(joints=("Tail",)), sample, 0.0)
    with pytest.raises(RequestError, match="no clips"):
        Stream.of(Poses(), Project(), 0.0)
