"""VMC in: a tracked person is mimicked, whoever sends it."""

from __future__ import annotations

import asyncio
import struct
from collections.abc import Iterator

import numpy as np
import pytest
from pythonosc.osc_message_builder import OscMessageBuilder

from metagraph.graph import anatomy
from metagraph.graph.face.rig import find_body_axes
from metagraph.graph.model import Project
from metagraph.graph.requests import make_request
from metagraph.live.live_session import LiveSession
from metagraph.live.osc_bytes import pad_osc, read_osc_messages
from metagraph.live.server import LiveError, Options, Server, check_live_options
from metagraph.live.vmc import VmcBody, split_bundles
from metagraph.live.vmc_person import VmcPerson
from metagraph.live.wire import exchange
from metagraph.motion.skeleton import Pose
from metagraph.motion.t_pose import make_t_pose
from metagraph.playback.evaluator import Evaluator
from metagraph.playback.planning.running_plan import plan_performance

PARTS = ("eye", "ear", "shoulder", "elbow", "wrist", "hip", "knee", "ankle")
COCO = ("nose", *(f"{side} {part}" for part in PARTS for side in ("left", "right")))


def t_pose_of(project: Project) -> Pose:
    roles = anatomy.project_roles(project)
    _, at = project.skeleton.globals(project.skeleton.rest)
    return make_t_pose(project.skeleton, roles, find_body_axes(project.skeleton, roles, at)[0])


def on_hips(project: Project) -> Pose:
    """Return a pose of the sample's character with its hands on its hips."""
    ask = make_request({"do": "stance", "stance": "on hips", "at": 0.0})
    plan = plan_performance(project, [ask], 8.0, 1, {}, False)
    return Evaluator(plan, project).at(6.0, alive=False)


def bundles(project: Project, pose: Pose, weights: dict[str, float] | None = None) -> Iterator[bytes]:
    return split_bundles(VmcBody.of(project).messages(1.0, pose, weights or {}))


def seen(project: Project, pose: Pose) -> dict[str, np.ndarray]:
    """Return a person's points, as a camera sees them."""
    person = VmcPerson()
    for bundle in bundles(project, pose):
        for address, values in read_osc_messages(bundle):
            person.hear(address, values)
    points = person.list_keypoints()
    assert points is not None
    return dict(zip(COCO, np.array(points), strict=True))


def test_a_person_in_a_t_pose_is_seen_from_before(sample: Project) -> None:
    points = seen(sample, t_pose_of(sample))
    assert points["left wrist"][0] > points["left elbow"][0] > points["left shoulder"][0] > 0.05
    assert points["right wrist"][0] < points["right shoulder"][0] < -0.05
    assert points["nose"][1] < points["left shoulder"][1] < points["left hip"][1] < points["left ankle"][1]
    assert points["nose"][2] < points["left ear"][2], "the nose is nearer to the camera"
    _, places = sample.skeleton.globals(t_pose_of(sample))
    at = dict(zip(sample.skeleton.names, places, strict=True))
    width = np.linalg.norm(at["LeftHand"] - at["RightHand"])
    assert np.linalg.norm(points["left wrist"] - points["right wrist"]) == pytest.approx(width, rel=1e-4)


def test_nobody_is_seen_until_all_bones_came_and_while_nothing_is_tracked() -> None:
    person = VmcPerson()
    person.hear("/VMC/Ext/Bone/Pos", ["Head", 0.0, 1.5, 0.0, 0.0, 0.0, 0.0, 1.0])
    assert person.list_keypoints() is None
    person.hear("/VMC/Ext/OK", [0])
    assert not person.tracked


@pytest.mark.parametrize(
    "values",
    [
        [],
        ["Head"],
        ["Head", *[0.0] * 7],
        ["Head", *[float("nan")] * 7],
        [3, *[1.0] * 7],
        ["Head", *"abcdefg"],
    ],
)
def test_what_is_no_bone_is_passed_over(values: list[object]) -> None:
    person = VmcPerson()
    person.hear("/VMC/Ext/Bone/Pos", values)
    assert not person.bones


def test_expressions_are_a_mood_while_they_are_strong() -> None:
    person = VmcPerson()
    person.hear("/VMC/Ext/Blend/Val", ["Joy", 0.4])
    assert person.find_mood() is None
    person.hear("/VMC/Ext/Blend/Val", ["Sorrow", 0.8])
    assert person.find_mood() == "sad"


def play(project: Project, datagrams: list[bytes], ticks: int = 120) -> LiveSession:
    """Send datagrams to a session over UDP, all of them each few ticks; return the session."""
    session = LiveSession(project, idle=False)

    async def run() -> None:
        loop = asyncio.get_running_loop()
        now = [0.0]
        server = Server(Options(port=None, osc=None, person=0), lambda: now[0])
        await server.open()
        transport, _ = await loop.create_datagram_endpoint(
            asyncio.DatagramProtocol, remote_addr=("127.0.0.1", server.person_port)
        )
        for n in range(ticks):
            for data in datagrams if n % 2 == 0 else ():
                transport.sendto(data)
            await asyncio.sleep(0.001)
            server.hub.give(exchange(session, now[0], server.hub.take()))
            now[0] += 1 / 60
        transport.close()
        await server.close()

    asyncio.run(run())
    return session


def stances(session: LiveSession) -> set[str]:
    """Return the names of the stances that were asked for."""
    found = [session.project.stance(request.stance or "") for request in session.plan.requests]
    return {stance.name for stance in found if stance is not None}


def test_the_character_takes_the_stance_of_a_person_who_is_sent_by_our_own_sender(sample: Project) -> None:
    session = play(sample, list(bundles(sample, on_hips(sample))))
    assert "on hips" in stances(session)


def test_the_character_takes_the_stance_of_a_person_whom_python_osc_sends(sample: Project) -> None:
    datagrams = []
    for bundle in bundles(sample, on_hips(sample)):
        for address, values in read_osc_messages(bundle):
            builder = OscMessageBuilder(address)
            for value in values:
                builder.add_arg(value)
            datagrams.append(builder.build().dgram)
    builder = OscMessageBuilder("/VMC/Ext/Blend/Val")
    builder.add_arg("Joy")
    builder.add_arg(1.0)
    session = play(sample, [builder.build().dgram, *datagrams])
    assert "on hips" in stances(session)
    assert session.plan.track.moods, "who smiles is smiled at"


def test_what_is_no_osc_does_not_stop_it(sample: Project) -> None:
    noise = [
        b"",
        b"#bundle\0",
        b"\0" * 40,
        pad_osc("/VMC/Ext/Bone/Pos") + pad_osc(",s") + struct.pack(">i", 7),
    ]
    session = play(sample, [*noise, *bundles(sample, on_hips(sample))])
    assert session.plan.requests


def test_a_port_for_a_person_that_cannot_be_is_refused() -> None:
    with pytest.raises(LiveError, match="from 0 to 65535"):
        check_live_options(Options(person=70000))
