"""Bring a clip onto the project's skeleton when both are the same character, and say why when they are
not.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton

MOVED = 1e-4  # metres: below this a joint keeps its rest translation
_NOTABLE = 0.03  # of the figure's size: shorter bones are fingers and faces


class SkeletonMismatchError(ValueError):
    """The clip belongs to another skeleton; the message says how they differ."""


def difference(clip: Skeleton, project: Skeleton) -> str | None:
    """Return in words why a clip on skeleton `clip` cannot play on `project`, or None when it can.

    A clip may lack joints (a face-only file), but not bring its own, and the bones it shares must be as long.
    Names may differ by what all joints of a file bear before or behind them (`mixamorig1:`).
    """
    clip = _called_alike(clip, project)
    extra = [name for name in clip.names if name not in project]
    shared = [name for name in clip.names if name in project]
    if len(shared) < max(1, len(clip) // 2):
        return f"its joints have other names (it has '{extra[0]}', the project has '{project.names[0]}')"
    if extra:
        more = f" and {len(extra) - 1} more" if len(extra) > 1 else ""
        return f"the project's skeleton has no joint '{extra[0]}'{more}"
    for i, name in enumerate(clip.names):
        parent = clip.parents[i]
        if parent < 0:
            continue
        above = project.parents[project.index(name)]
        if above < 0 or project.names[above] != clip.names[parent]:
            return (
                f"joint '{name}' hangs on '{clip.names[parent]}' instead of "
                f"'{project.names[above] if above >= 0 else 'nothing'}'"
            )
    ours = np.linalg.norm(project.rest_translations[[project.index(n) for n in clip.names]], axis=-1)
    theirs = np.linalg.norm(clip.rest_translations, axis=-1)
    inner = clip.parents >= 0
    if inner.any():
        ratio = (
            np.median(theirs[inner & (ours > 1e-3)] / ours[inner & (ours > 1e-3)])
            if (inner & (ours > 1e-3)).any()
            else 1.0
        )
        if not 0.7 < ratio < 1.4:
            return f"its bones are {ratio:.3g} times as long"
    return None


def _called_alike(clip: Skeleton, project: Skeleton) -> Skeleton:
    """Return the clip's skeleton with the project's names where these differ only by a namespace, or by what
    all of either's joints bear before or behind them; else as it is.
    """
    if all(name in project for name in clip.names):
        return clip
    for bare in (_without_namespace, _without_common):
        ours, theirs = bare(project.names), bare(clip.names)
        known = dict(zip(ours, project.names, strict=True))
        if len(known) == len(ours) and len(set(theirs)) == len(theirs) and all(n in known for n in theirs):
            names = tuple(known[name] for name in theirs)
            return Skeleton(names, clip.parents, clip.rest_rotations, clip.rest_translations)
    return clip


def _without_namespace(names: Sequence[str]) -> list[str]:
    return [re.split(r"[:|]", name)[-1] for name in names]


def _without_common(names: Sequence[str]) -> list[str]:
    """Return names without what all of them begin and end with."""
    bare = _without_namespace(names)
    if len(bare) < 3:
        return bare
    before = _shared(bare)
    behind = _shared([name[before:][::-1] for name in bare])
    return [name[before : len(name) - behind] for name in bare]


def _shared(names: Sequence[str]) -> int:
    """Return how many characters all names begin with alike."""
    first, last = min(names), max(names)
    return next(
        (n for n, (a, b) in enumerate(zip(first, last, strict=False)) if a != b), min(map(len, names))
    )


def bone_difference(clip: Skeleton, project: Skeleton) -> float:
    """Return by which share, 0 or more, the longer bones of a clip's skeleton differ most from the project's,
    for skeletons between which there is no `difference`.
    """
    clip = _called_alike(clip, project)
    ours = np.linalg.norm(project.rest_translations[[project.index(n) for n in clip.names]], axis=-1)
    theirs = np.linalg.norm(clip.rest_translations, axis=-1)
    below = np.array([len(clip.descendants(j)) for j in range(len(clip))])
    bones = (clip.parents >= 0) & (ours > _NOTABLE * project.height) & (below <= len(clip) / 2)
    return float(np.abs(theirs[bones] / ours[bones] - 1).max(initial=0.0))


def adopt(clip: Clip, skeleton: Skeleton) -> Clip:
    """Return the clip expressed on `skeleton`: joints reordered by name, missing ones at rest, bones as the
    clip has them.

    Raises SkeletonMismatchError when the skeletons are not of the same character.
    """
    if clip.skeleton is skeleton:
        return clip
    if clip.skeleton == skeleton:
        return replace(clip, skeleton=skeleton)
    why = difference(clip.skeleton, skeleton)
    if why is not None:
        raise SkeletonMismatchError(why)
    alike = _called_alike(clip.skeleton, skeleton)
    places = np.array([skeleton.index(name) for name in alike.names])
    source = clip.poses()
    rotations = np.broadcast_to(skeleton.rest_rotations, (clip.frames, len(skeleton), 4)).astype(np.float32)
    translations = np.broadcast_to(skeleton.rest_translations, (clip.frames, len(skeleton), 3)).astype(
        np.float32
    )
    rotations[:, places] = source.rotations
    translations[:, places] = source.translations
    rest = skeleton.rest_translations.astype(np.float32)
    moved = np.flatnonzero(np.abs(translations - rest).max(axis=(0, 2)) > MOVED)
    translated = tuple(sorted({0, *(int(j) for j in moved)}))
    return replace(
        clip,
        skeleton=skeleton,
        rotations=rotation.continuous(rotations),
        translations=translations[:, list(translated)],
        translated=translated,
    )
