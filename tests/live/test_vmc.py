"""The character as programs receive it that show avatars by VMC: by a receiver written from the protocol's
words, and by python-osc.
"""

from __future__ import annotations

import asyncio
from dataclasses import replace

import numpy as np
import pytest
from pythonosc.osc_bundle import OscBundle

from metagraph.graph import anatomy
from metagraph.graph.face.rig import find_body_axes
from metagraph.graph.model import Project
from metagraph.graph.requests import RequestError
from metagraph.live.live_session import LiveSession
from metagraph.live.osc_bytes import read_osc_messages
from metagraph.live.server import LiveError, Options, Server, check_live_options
from metagraph.live.vmc import LARGEST, VmcBody, name_unity_bone, split_bundles
from metagraph.live.wire import exchange
from metagraph.motion import rotation
from metagraph.motion.skeleton import Pose
from metagraph.motion.t_pose import make_t_pose


class Receiver:
    """What a program knows after a pose: bones' local positions and rotations, expressions."""

    def __init__(self):
        self.bones, self.blends, self.seen = {}, {}, []

    def hear(self, bundle: bytes) -> None:
        for address, values in read_osc_messages(bundle):
            self.seen.append(address)
            if address == "/VMC/Ext/Bone/Pos":
                self.bones[values[0]] = np.array(values[1:4]), np.array(values[4:8])
            elif address == "/VMC/Ext/Blend/Val":
                self.blends[values[0]] = values[1]


TRUNK = ("UpperChest", "Chest", "Spine")
PARENTS = {  # of Unity's humanoid, the nearest that there is
    "Spine": ("Hips",), "Chest": ("Spine",), "UpperChest": ("Chest",), "Neck": TRUNK,
    "Head": ("Neck",), "LeftShoulder": TRUNK, "LeftUpperArm": ("LeftShoulder", *TRUNK),
    "LeftLowerArm": ("LeftUpperArm",), "LeftHand": ("LeftLowerArm",), "LeftUpperLeg": ("Hips",),
    "LeftLowerLeg": ("LeftUpperLeg",), "LeftFoot": ("LeftLowerLeg",),
}  # fmt: skip


def place(receiver: Receiver, bone: str) -> np.ndarray:
    """Return where Unity puts a bone: forward kinematics over what was received."""
    at, _ = receiver.bones[bone]
    while bone in PARENTS:
        bone = next(p for p in PARENTS[bone] if p in receiver.bones)
        up, q = receiver.bones[bone]
        at = up + rotation.rotate_vectors(q, at)
    return at


def heard(body: VmcBody, pose: Pose, weights=None) -> Receiver:
    out = Receiver()
    for bundle in split_bundles(body.messages(1.5, pose, weights or {})):
        assert len(bundle) <= LARGEST
        out.hear(bundle)
    return out


def t_pose_of(project: Project) -> Pose:
    roles = anatomy.project_roles(project)
    _, at = project.skeleton.globals(project.skeleton.rest)
    return make_t_pose(project.skeleton, roles, find_body_axes(project.skeleton, roles, at)[0])


def test_in_a_t_pose_no_bone_is_turned_and_the_left_hand_is_at_unitys_left(sample):
    receiver = heard(VmcBody.of(sample), t_pose_of(sample))
    for name, (_, turned) in receiver.bones.items():
        assert abs(turned @ [0, 0, 0, 1]) == pytest.approx(1, abs=1e-5), name
    hand = place(receiver, "LeftHand")
    assert hand[0] < -0.5, "Unity's x points to the right of a character that faces +z"
    assert place(receiver, "LeftFoot")[1] < place(receiver, "Hips")[1] < place(receiver, "Head")[1]


def test_every_bone_is_where_the_character_has_it_mirrored_into_unitys_space(sample):
    clip = next(e.motion for e in sample.clips.values() if "wave_hello" in e.name)
    body = VmcBody.of(sample)
    for frame in (0, clip.frames // 3, clip.frames // 2):
        pose = clip.pose_at(frame / clip.fps)
        receiver = heard(body, pose)
        _, at = sample.skeleton.globals(pose)
        roles = anatomy.project_roles(sample)
        for bone, role in (
            ("LeftHand", "left_hand"),
            ("Head", "head"),
            ("LeftFoot", "left_foot"),
            ("Hips", "hips"),
        ):
            np.testing.assert_allclose(place(receiver, bone), at[roles[role]] * [-1, 1, 1], atol=1e-4)


def test_a_character_that_faces_elsewhere_is_turned_to_face_z(toy):
    project = toy.project()
    quarter = rotation.from_axis_angle(np.array([0.0, 1, 0]), np.pi / 2)
    skeleton = project.skeleton
    turned = replace(
        skeleton,
        rest_rotations=np.concatenate(
            [rotation.multiply(quarter, skeleton.rest_rotations[:1]), skeleton.rest_rotations[1:]]
        ),
    )
    body = VmcBody.of(replace(project, skeleton=turned, clips={}))
    receiver = heard(body, turned.rest)
    straight = heard(VmcBody.of(project), skeleton.rest)
    for bone in ("LeftHand", "Head"):
        np.testing.assert_allclose(place(receiver, bone), place(straight, bone), atol=1e-5)


def test_faces_go_as_expressions_and_by_their_own_names(sample):
    body = VmcBody.of(sample, ("eyeBlinkLeft", "eyeBlinkRight", "jawOpen", "mouthSmileLeft"))
    shown = heard(body, sample.skeleton.rest, {"eyeBlinkLeft": 1.0, "eyeBlinkRight": 0.0, "jawOpen": 0.3})
    assert shown.blends["Blink_L"] == pytest.approx(1.0) and shown.blends["Blink_R"] == 0.0
    assert shown.blends["jawOpen"] == pytest.approx(0.3)
    assert 0 < shown.blends["A"] <= 1
    assert shown.seen[0] == "/VMC/Ext/OK" and shown.seen[-1] == "/VMC/Ext/Blend/Apply"
    assert {"/VMC/Ext/T", "/VMC/Ext/Root/Pos"} <= set(shown.seen)


def test_another_library_reads_the_bundles(sample):
    for bundle in split_bundles(VmcBody.of(sample).messages(0.0, sample.skeleton.rest, {})):
        assert all(content.address.startswith("/VMC/Ext/") for content in OscBundle(bundle))


@pytest.mark.parametrize(
    ("bone", "name"),
    [
        ("hips", "Hips"),
        ("leftThumbMetacarpal", "LeftThumbProximal"),
        ("rightThumbProximal", "RightThumbIntermediate"),
        ("rightThumbDistal", "RightThumbDistal"),
        ("leftIndexProximal", "LeftIndexProximal"),
    ],
)
def test_bones_have_unitys_names(bone, name):
    assert name_unity_bone(bone) == name


def test_what_is_no_humanoid_is_refused():
    with pytest.raises(RequestError, match="needs a humanoid"):
        VmcBody.of(Project())


def test_a_receiver_is_sent_sixty_poses_a_second(sample):
    got: list[bytes] = []

    class Ears(asyncio.DatagramProtocol):
        def datagram_received(self, data: bytes, address: object) -> None:
            got.append(data)

    async def play() -> None:
        loop = asyncio.get_running_loop()
        transport, _ = await loop.create_datagram_endpoint(Ears, ("127.0.0.1", 0))
        port = transport.get_extra_info("sockname")[1]
        clock = loop.time
        server = Server(Options(port=None, osc=None, vmc=("127.0.0.1", port)), clock)
        await server.open()
        session, now = LiveSession(sample), 0.0
        for _ in range(31):
            server.hub.give(exchange(session, now, server.hub.take()))
            now += 1 / 60
            await asyncio.sleep(0)
        await asyncio.sleep(0.05)
        await server.close()
        transport.close()

    asyncio.run(play())
    moments = {
        values[0] for data in got for address, values in read_osc_messages(data) if address == "/VMC/Ext/T"
    }
    assert len(moments) >= 20
    assert any(address == "/VMC/Ext/Bone/Pos" for address, _ in read_osc_messages(got[0]))


def test_a_port_that_cannot_be_is_refused():
    with pytest.raises(LiveError, match="from 0 to 65535"):
        check_live_options(Options(vmc=("127.0.0.1", 70000)))
