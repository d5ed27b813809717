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
    """Return the takes of a file, those that only have a face joined to the body's take that they belong to.
    That is the only body as long as the face. Of several, it is the one whose name is in the face's name, or
    else the one at the same place, if there are as many faces. `faces` tells which takes only have a face.

    A joined take has a note. The face's own take stays in its place, so that numbers of takes in projects
    stay right, and names its body in `face_of`; importing leaves it out.
    """
    bodies = [n for n, clip in enumerate(clips) if not faces[n] and not clip.morphs]
    owners: dict[int, int] = {}
    for length in dict.fromkeys(round(clips[n].duration / SAME) for n, face in enumerate(faces) if face):
        some = [n for n, face in enumerate(faces) if face and _as_long(clips[n], length)]
        fitting = [n for n in bodies if _as_long(clips[n], length)]
        if len(some) == len(fitting):
            owners |= _by_name(clips, fitting, some) or dict(zip(fitting, some, strict=True))
    out = list(clips)
    for body, face in owners.items():
        out[body] = _joined(clips[body], clips[face])
        out[face] = replace(clips[face], face_of=clips[body].name)
    return out


def _by_name(clips: Sequence[Clip], bodies: Sequence[int], faces: Sequence[int]) -> dict[int, int]:
    """Return each body with the face that has its name, and no longer name of another body, within its own;
    nothing unless each has exactly one.
    """
    names = {body: clips[body].name.casefold() for body in bodies if clips[body].name}
    owners: dict[int, int] = {}
    for face in faces:
        within = [body for body, name in names.items() if name in clips[face].name.casefold()]
        if within:
            owners[max(within, key=lambda body: len(names[body]))] = face
    return owners if len(owners) == len(bodies) == len(faces) else {}


def _as_long(clip: Clip, length: int) -> bool:
    return abs(clip.duration / SAME - length) <= 1


def _joined(body: Clip, face: Clip) -> Clip:
    times = np.arange(body.frames) / body.fps
    frames = np.arange(face.frames) / face.fps
    assert face.weights is not None
    weights = np.stack([np.interp(times, frames, column) for column in face.weights.T], 1)
    note = phrase("its face is the animation '{name}' of the same file", name=face.name)
    return replace(body, morphs=face.morphs, weights=weights, notes=(*body.notes, note))
