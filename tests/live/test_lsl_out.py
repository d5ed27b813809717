"""LSL out: events, pose and face as streams of the Lab Streaming Layer, with the time at which they hold."""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sample_clips
from metagraph.graph.model import Project
from metagraph.live.hub import Hub
from metagraph.live.live_session import LiveSession
from metagraph.live.lsl_out import LslOutLine, find_moment, plan_outlets
from metagraph.live.wire import exchange
from tests.lab_streams import make_layer, require_lsl


def play(project: Project, layer: Any, asks: list[dict[str, Any]], seconds: float = 3.0) -> LiveSession:
    """Play requests to a session whose clock stands at 7 s + its own seconds."""
    session, hub, now = LiveSession(project, idle=False), Hub(), [0.0]
    line = LslOutLine(layer, project, lambda: 7.0 + now[0], lambda: 7.0)
    line.join(hub)
    session.receive(99, json.dumps(asks))
    while now[0] < seconds:
        hub.give(exchange(session, now[0], hub.take()))
        now[0] += 1 / 60
    return session


def named(layer: Any, kind: str) -> Any:
    return next(outlet for outlet in layer.opened if outlet.info.type() == kind)


def test_each_channel_of_the_pose_says_which_joint_number_and_unit_it_is(sample: Project) -> None:
    plan = plan_outlets(sample)["pose"]
    assert len(plan.channels) == 7 * len(sample.skeleton.names)
    first = plan.channels[:7]
    assert [x.kind for x in first] == [
        "PositionX", "PositionY", "PositionZ", "OrientationA", "OrientationB", "OrientationC", "OrientationD",
    ]  # fmt: skip
    assert {x.object for x in first} == {sample.skeleton.names[0]}
    assert {x.unit for x in first} == {"meters", "quaternion"}
    layer = make_layer()
    LslOutLine(layer, sample, lambda: 0.0, lambda: 0.0)
    channel = named(layer, "MoCap").info.desc().child("channels").child("channel")
    assert channel.child_value("type") == "PositionX" and channel.child_value("unit") == "meters"
    assert named(layer, "MoCap").info.desc().child("acquisition").child_value("manufacturer") == "Metagraph"


def test_a_sample_of_the_pose_has_places_and_turns_of_the_joints_and_the_time_at_which_it_is_shown(
    sample: Project,
) -> None:
    layer = make_layer(clock=1000.0)
    session = play(sample, layer, [{"do": "nod"}], 1.0)
    sent = named(layer, "MoCap").sent
    assert len(sent) == 60
    values, stamp = sent[30]
    # The clock of LSL stands at 1000 while the tick at 30/60 s is sent: the pose is of that tick.
    assert stamp == pytest.approx(1000.0, abs=1e-6)
    pose = session.evaluator.at(0.5)
    turns, places = sample.skeleton.globals(pose)
    numbers = np.asarray(values).reshape(-1, 7)
    np.testing.assert_allclose(numbers[:, :3], places, atol=1e-3)
    np.testing.assert_allclose(numbers[:, 3], turns[:, 3], atol=1e-3)
    np.testing.assert_allclose(numbers[:, 4:], turns[:, :3], atol=1e-3)


def test_a_pose_that_is_sent_late_keeps_the_time_of_its_own_moment(sample: Project) -> None:
    layer = make_layer(clock=1000.0)
    line = LslOutLine(layer, sample, lambda: 12.25, lambda: 2.0)
    assert line.find_time(10.0) == pytest.approx(999.75), "10.25 s have passed, the pose is of 10 s"


def test_the_face_is_sent_by_the_names_of_its_morph_targets() -> None:
    from app.project.opening import open_whole

    project = open_whole(Path(sample_clips.__file__).with_name("sample.metagraph.yaml")).project
    names = [channel.label for channel in plan_outlets(project)["face"].channels]
    layer = make_layer()
    play(project, layer, [{"do": "say", "text": "Hello and welcome."}], 2.0)
    sent = np.array([values for values, _ in named(layer, "Face").sent])
    assert sent.shape[1] == len(names) and len(sent) >= 120 and "jawOpen" in names
    assert sent[:, names.index("jawOpen")].max() > 0.1 and sent.min() >= 0


def test_what_begins_and_ends_is_a_marker_at_the_time_at_which_it_does(sample: Project) -> None:
    layer = make_layer(clock=1000.0)
    play(sample, layer, [{"do": "say", "text": "Good morning to you.", "id": "a"}], 4.0)
    told = [(json.loads(values[0]), stamp) for values, stamp in named(layer, "Markers").sent]
    speech = [(event, stamp) for event, stamp in told if event.get("text") or event.get("line")]
    assert [event["event"] for event, _ in speech] == ["started", "ended"]
    (began, at), (_, end) = speech
    assert at == pytest.approx(1000.0 + began["at"] - began["t"], abs=1e-3) and at <= 1000.0 >= end


def test_an_event_that_was_told_before_it_happens_has_the_time_at_which_it_is_told() -> None:
    assert find_moment(b'{"event":"started","t":2.0,"at":1.99}') == 1.99
    assert find_moment(b'{"event":"ended","t":2.0,"until":3.0}') == 2.0
    assert find_moment(b'{"event":"ended","t":2.0}') == 2.0
    assert find_moment(b'{"event":"changed","t":2.0,"at":5.0}') == 2.0


def test_a_project_without_a_character_has_events_alone() -> None:
    assert list(plan_outlets(Project())) == ["events"]


def test_a_recorder_on_this_machine_finds_the_streams_and_their_descriptions(
    sample: Project, tmp_path: Path
) -> None:
    pylsl = require_lsl(tmp_path)
    begin = time.monotonic()
    session, hub = LiveSession(sample, idle=False), Hub()
    line = LslOutLine(pylsl, sample, time.monotonic, lambda: begin)
    line.join(hub)
    inlets = {}
    for what, plan in plan_outlets(sample).items():
        (found, *_) = pylsl.resolve_byprop("source_id", plan.source, timeout=10.0) or pytest.fail(what)
        inlets[what] = pylsl.StreamInlet(found, recover=False)
        inlets[what].open_stream(timeout=10.0)
    info = inlets["pose"].info(timeout=10.0)
    assert info.get_channel_types()[:4] == ["PositionX", "PositionY", "PositionZ", "OrientationA"]
    assert info.get_channel_units()[0] == "meters" and info.nominal_srate() == 60.0
    session.receive(99, '{"do": "say", "text": "Hello."}')
    slowest = 0.0
    for _ in range(90):
        now = time.monotonic()
        result = exchange(session, now - begin, hub.take())
        sending = time.monotonic()
        hub.give(result)
        slowest = max(slowest, time.monotonic() - sending)
        time.sleep(max(0.0, 1 / 60 - (time.monotonic() - now)))
    time.sleep(0.3)
    poses, stamps = inlets["pose"].pull_chunk(timeout=1.0)
    events, _ = inlets["events"].pull_chunk(timeout=1.0)
    line.close(1001, "")
    inlets.clear()
    assert len(poses) > 80 and len(poses[0]) == 7 * len(sample.skeleton.names)
    assert np.all(np.diff(stamps) > 0) and abs(stamps[-1] - pylsl.local_clock()) < 3.0
    assert any(json.loads(text)["event"] == "started" for (text,) in events)
    assert slowest < 0.1, "a tick does not wait for those who record"
