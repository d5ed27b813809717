"""Poses on their way to an engine: what a client wants of them, as JSON, packed numbers, OSC or VMC."""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import floor
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.face.curves import fit_curves_to_face
from metagraph.graph.model import Project
from metagraph.graph.requests import RequestError
from metagraph.live.messages import Poses, encode
from metagraph.live.osc_bytes import pad_osc
from metagraph.motion.skeleton import Pose
from metagraph.playback.evaluator import Evaluator
from metagraph.playback.posing.overlay import Overlay

if TYPE_CHECKING:
    from metagraph.live.vmc import VmcBody

Array = NDArray[Any]

MAGIC = b"MGP1"
HEADER = struct.Struct("<4sHHHHd")  # magic, flags, joints, morphs, 0, seconds
MODEL, TRANSLATIONS = 1, 2  # flags


@dataclass(frozen=True)
class PoseFrame:
    """One pose for some clients. binary: whether it is to be sent as bytes rather than text."""

    clients: tuple[int, ...]
    data: bytes
    binary: bool


@dataclass
class Stream:
    """What a client wants: joints `[J]`, their names, and when the next pose is due. body: of VMC alone."""

    wish: Poses
    joints: Array
    names: tuple[str, ...]
    morphs: tuple[str, ...]
    next: float
    prefixes: list[bytes] = field(default_factory=list)
    body: VmcBody | None = None

    @classmethod
    def of(cls, wish: Poses, project: Project, now: float) -> Stream:
        """Return the stream of a wish. Raises RequestError for joints that are not there, and for VMC of a
        character that is no humanoid.
        """
        skeleton = project.skeleton
        if skeleton is None:
            raise RequestError("the project has no clips, so there are no poses")
        unknown = [] if wish.joints is None else [j for j in wish.joints if j not in skeleton.names]
        if unknown:
            raise RequestError(f"there is no joint '{unknown[0][:60]}'; 'describe' lists them")
        names = skeleton.names if wish.joints is None else wish.joints
        morphs = dict.fromkeys(
            name
            for entry in project.clips.values()
            if entry.motion is not None
            for name in fit_curves_to_face(project, entry.motion).morphs
        )
        places = np.array([skeleton.names.index(name) for name in names], np.int64)
        faces = (*morphs, *(m for m in project.face.morphs if m not in morphs))
        body = None
        if wish.format == "vmc":
            from metagraph.live.vmc import VmcBody  # only those who are sent VMC wait for its import

            body = VmcBody.of(project, faces)
        return cls(wish, places, tuple(names), faces, now, body=body)

    @property
    def key(self) -> Any:
        """What streams have in common that get the same bytes."""
        return self.wish.format, self.wish.space, self.wish.translations, self.names


def collect_due_frames(
    now: float,
    evaluator: Evaluator | None,
    streams: Sequence[tuple[int, Stream]],
    over: Callable[[float], Overlay | None] = lambda _: None,
) -> list[PoseFrame]:
    """Return the poses that are due at `now`, and say when the next are. evaluator: of what plays, None for a
    project without a skeleton. over: what is laid over the plan.
    """
    groups: dict[Any, list[tuple[int, Stream]]] = {}
    for client, stream in streams:
        if stream.next <= now and evaluator is not None:
            stream.next = (
                floor(now * stream.wish.rate + 1e-6) + 1
            ) / stream.wish.rate  # those of one rate are due together
            groups.setdefault(stream.key, []).append((client, stream))
    if not groups or evaluator is None:
        return []
    laid = over(now)
    pose = evaluator.at(now, overlay=laid)
    turned = (
        evaluator.rigs.composer.ground.skeleton.globals(pose)
        if any(key[1] == "model" for key in groups)
        else None
    )
    still = None if laid is None else evaluator.at(now, False, laid)
    weights = evaluator.morphs_at(now, composed=still)
    out = []
    for group in groups.values():
        stream = group[0][1]
        data = encode_pose_frame(stream, now, pose, turned, weights)
        out.append(PoseFrame(tuple(client for client, _ in group), data, stream.wish.format != "json"))
    return out


def encode_pose_frame(
    stream: Stream, now: float, pose: Pose, turned: tuple[Array, Array] | None, weights: dict[str, float]
) -> bytes:
    """Return one pose as a client wants it. turned: rotations and positions in the character's space, where
    they are needed.
    """
    wish, joints = stream.wish, stream.joints
    if stream.body is not None:
        return stream.body.messages(now, pose, dict.fromkeys(stream.morphs, 0.0) | weights)
    root = pose.translations[0]
    rotations, places = pose.rotations[joints], pose.translations[joints] if wish.translations else None
    if wish.space == "model" and turned is not None:
        rotations, places = turned[0][joints], turned[1][joints]
    if wish.format == "binary":
        flags = (MODEL if wish.space == "model" else 0) | (TRANSLATIONS if places is not None else 0)
        head = HEADER.pack(MAGIC, flags, len(joints), len(stream.morphs), 0, now)
        parts = [
            root,
            rotations,
            *([] if places is None else [places]),
            np.array([weights.get(m, 0.0) for m in stream.morphs]),
        ]
        return head + b"".join(np.ascontiguousarray(part, "<f4").tobytes() for part in parts)
    if wish.format == "osc":
        return _osc(stream, now, root, rotations, places, weights)
    data: dict[str, Any] = {"t": round(now, 4), "root": _plain(root), "rotations": _plain(rotations)}
    if places is not None:
        data["positions" if wish.space == "model" else "translations"] = _plain(places)
    shown = dict.fromkeys(stream.morphs, 0.0) | weights  # those at rest, too
    if shown:
        data["weights"] = {name: round(value, 4) for name, value in shown.items()}
    return encode(data)


def _plain(values: Array) -> Any:
    return np.round(values.astype(np.float64), 5).tolist()


def _osc(
    stream: Stream, now: float, root: Array, rotations: Array, places: Array | None, weights: dict[str, float]
) -> bytes:
    """Return an OSC bundle: /metagraph/pose with the time, /metagraph/root, one /metagraph/joint each, one
    /metagraph/weight each.
    """
    if not stream.prefixes:
        tags = ",sffff" if places is None else ",sfffffff"
        stream.prefixes = [
            pad_osc("/metagraph/joint") + pad_osc(tags) + pad_osc(name) for name in stream.names
        ]
    numbers = rotations if places is None else np.concatenate([rotations, places], axis=1)
    parts = [pad_osc("/metagraph/pose") + pad_osc(",d") + struct.pack(">d", now)]
    parts.append(pad_osc("/metagraph/root") + pad_osc(",fff") + root.astype(">f4").tobytes())
    parts += [
        prefix + row.tobytes() for prefix, row in zip(stream.prefixes, numbers.astype(">f4"), strict=True)
    ]
    parts += [
        pad_osc("/metagraph/weight") + pad_osc(",sf") + pad_osc(name) + struct.pack(">f", x)
        for name, x in (dict.fromkeys(stream.morphs, 0.0) | weights).items()
    ]
    return (
        b"#bundle\0" + struct.pack(">Q", 1) + b"".join(struct.pack(">i", len(part)) + part for part in parts)
    )
