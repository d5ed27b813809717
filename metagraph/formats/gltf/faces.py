"""One take that a file has as two animations: the body's, and its face's. Blender writes a rig's action and
the action of its shape keys so.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from metagraph.common.wording import phrase
from metagraph.motion.clip import Clip

SAME = 0.05  # seconds by which a body's and its face's animation may differ in length


def join_faces(clips: Sequence[Clip], faces: Sequence[bool]) -> list[Clip]:
    """Return the takes of a file, those that only have a face joined to the body's take that they belong to:
    the only one as long that has no face, or of as many of each the one in the same place. `faces` tells
    which takes only have a face. A joined take has a note. The face's own take stays in its place, so that
    numbers of takes in projects stay right, and names its body in `face_of`; importing leaves it out.
    """
    bodies = [n for n, clip in enumerate(clips) if not faces[n] and not clip.morphs]
    owners: dict[int, int] = {}
    for length in dict.fromkeys(round(clips[n].duration / SAME) for n, face in enumerate(faces) if face):
        some = [n for n, face in enumerate(faces) if face and _as_long(clips[n], length)]
        fitting = [n for n in bodies if _as_long(clips[n], length)]
        if len(some) == len(fitting):
            owners |= dict(zip(fitting, some, strict=True))
    out = list(clips)
    for body, face in owners.items():
        out[body] = _joined(clips[body], clips[face])
        out[face] = replace(clips[face], face_of=clips[body].name)
    return out


def _as_long(clip: Clip, length: int) -> bool:
    return abs(clip.duration / SAME - length) <= 1


def _joined(body: Clip, face: Clip) -> Clip:
    times = np.arange(body.frames) / body.fps
    frames = np.arange(face.frames) / face.fps
    assert face.weights is not None
    weights = np.stack([np.interp(times, frames, column) for column in face.weights.T], 1)
    note = phrase("its face is the animation '{name}' of the same file", name=face.name)
    return replace(body, morphs=face.morphs, weights=weights, notes=(*body.notes, note))
