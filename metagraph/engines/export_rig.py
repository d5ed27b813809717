"""What the life layers need of a character, resolved for runtimes: they need not find faces, nor analyse
sound.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from metagraph.engines import contract as c
from metagraph.graph.face.rig import CHANNELS, FaceRig
from metagraph.graph.model import Project
from metagraph.playback.life.body import Body, EyeAt, Looker, Quaternion, Vector
from metagraph.playback.life.voice import Voice
from metagraph.playback.posing.rigs import get_rigs

STEPS = 1e4  # a mouth shape's weight is written in steps of this part of one


def export_rig(project: Project) -> c.Rig | None:
    """Return the resolved body of a project, None if nothing of it can live."""
    body = get_rigs(project).body
    if body.empty:
        return None
    long, face = len(body.chain), body.face
    shoulders = body.joints[long : long + len(body.shoulders)].tolist()
    eye_joints = iter(body.joints[long + len(body.shoulders) :].tolist())
    return c.Rig(
        left=list(body.left),
        up=list(body.up),
        ahead=list(body.ahead),
        chain=body.chain.tolist(),
        breath=[[*axis, angle] for axis, angle in body.breath],
        shoulders=[
            c.RigShoulder(joint, list(turn), list(tense), list(closed))
            for joint, turn, tense, closed in zip(
                shoulders, body.shoulders, body.tense, body.closed, strict=True
            )
        ],
        lookers=[c.RigLooker(x.place, x.share) for x in body.lookers],
        trunk=body.trunk,
        trunk_ahead=list(body.trunk_ahead),
        head_ahead=list(body.head_ahead),
        eyes=[_eye(eye, next(eye_joints) if eye.joint else -1) for eye in body.eyes],
        partner=list(body.partner),
        eyes_at_rest=list(body.eyes_at_rest),
        face=c.RigFace(
            joints=face.joints.tolist(),
            turns=face.turns.tolist(),
            shifts=face.shifts.tolist(),
            follows=face.follows.tolist(),
            lid_joints=face.lid_joints.tolist(),
            shut_by=face.shut_by.tolist(),
            morphs={channel: dict(targets) for channel, targets in face.morphs.items()},
        ),
        bowed=list(body.bowed),
        thrust=list(body.thrust),
    )


def _eye(eye: EyeAt, joint: int) -> c.RigEye:
    return c.RigEye(
        list(eye.at),
        list(eye.left),
        list(eye.up),
        list(eye.ahead),
        joint,
        list(eye.turn_left),
        list(eye.turn_up),
        list(eye.down),
    )


def read_rig(rig: c.Rig) -> Body:
    """Return an exported body as the life layers take it."""
    eyes = tuple(
        EyeAt(
            _three(e.at),
            _three(e.left),
            _three(e.up),
            _three(e.ahead),
            e.joint >= 0,
            _three(e.turn_left),
            _three(e.turn_up),
            _four(e.down),
        )
        for e in rig.eyes
    )
    face = rig.face
    seeing = [e.joint for e in rig.eyes if e.joint >= 0]
    joints = [*rig.chain, *(s.joint for s in rig.shoulders), *seeing, *face.joints]
    read = [*rig.chain, *seeing, *(j for j in face.lid_joints if j >= 0)]
    shape = (len(CHANNELS), len(face.joints), 3)
    found = FaceRig(
        (),
        np.array(face.joints, int),
        np.array(face.turns, float).reshape(shape),
        np.array(face.shifts, float).reshape(shape),
        np.array(face.follows),
        np.array(face.lid_joints, int),
        np.array(face.shut_by),
        {channel: tuple(targets.items()) for channel, targets in face.morphs.items()},
    )
    return Body(
        left=_three(rig.left),
        up=_three(rig.up),
        ahead=_three(rig.ahead),
        chain=np.array(rig.chain, int),
        breath=tuple((_three(row[:3]), row[3]) for row in rig.breath),
        bowed=tuple(rig.bowed) or (0.0,) * len(rig.chain),
        thrust=tuple(rig.thrust) or (0.0,) * len(rig.chain),
        joints=np.array(joints, int),
        read=np.array(read, int),
        shoulders=tuple(_three(s.turn) for s in rig.shoulders),
        tense=tuple(_three(s.tense or (0.0, 0.0, 0.0)) for s in rig.shoulders),
        closed=tuple(_three(s.closed or (0.0, 0.0, 0.0)) for s in rig.shoulders),
        lookers=tuple(Looker(x.place, x.share) for x in rig.lookers),
        trunk=rig.trunk,
        trunk_ahead=_three(rig.trunk_ahead),
        head_ahead=_three(rig.head_ahead),
        eyes=(eyes[0], eyes[1]),
        partner=_three(rig.partner),
        eyes_at_rest=_three(rig.eyes_at_rest),
        face=found,
    )


def _three(values: Sequence[float]) -> Vector:
    x, y, z = values
    return x, y, z


def _four(values: Sequence[float]) -> Quaternion:
    x, y, z, w = values
    return x, y, z, w


def list_export_voices(project: Project) -> dict[str, c.ExportedVoice]:
    """Return the voices of a project's lines, as far as their sound was read."""
    return {
        line: _voice(voice)
        for line, voice in project.voices.items()
        if line in project.lines and isinstance(voice, Voice)
    }


def _voice(voice: Voice) -> c.ExportedVoice:
    weights = np.round(np.clip(voice.weights.astype(float), 0.0, 1.0) * STEPS) / STEPS
    return c.ExportedVoice(voice.duration, voice.accents.tolist(), weights.tolist())


def read_voices(voices: dict[str, c.ExportedVoice]) -> dict[str, Any]:
    """Return voices as the life layers take them."""
    return {
        line: Voice(
            voice.duration,
            np.array(voice.accents, float),
            np.linspace(0.0, max(voice.duration, 1e-3), len(voice.weights)),
            np.array(voice.weights, np.float32),
            stresses=np.array(voice.accents, float),  # as they are: a conversation's may be near each other
        )
        for line, voice in voices.items()
    }
