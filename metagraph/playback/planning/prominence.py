"""How much an action stands out, which says how soon it may be done again (`director`)."""

from __future__ import annotations

from functools import lru_cache
from typing import Any
from weakref import ref

import numpy as np

from metagraph.graph import anatomy
from metagraph.graph.model import Action, Layer, Project
from metagraph.graph.vocabulary import split_tokens
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.playback.timing.phases import REMEMBERED, find_movers, track

TALL = 1.75  # metres: the figure that distances and speeds below are of
FAR = {"body": 0.3, "arms": 0.6, "head": 0.8}  # metres, for the head radians, from where it began: at most 1
FAST = {"body": 1.0, "arms": 3.0, "head": 3.5}  # metres a second, for the head radians: at most 1
EMBLEM = 0.75  # at least, for what has a meaning of its own
SMALL = 0.3  # at most, for what goes along with speech or only settles
EMBLEMS = frozenset((  # words of its name or tags
    "applaud", "beckon", "bow", "bye", "cheer", "clap", "count", "cough", "cry", "curtsy", "dance",
    "facepalm", "fist", "flex", "goodbye", "greet", "greeting", "heart", "hello", "hi", "jump", "kiss",
    "laugh", "naughty", "peace", "phone", "point", "pray", "quote", "quotes", "refuse", "salute",
    "scratch", "shrug", "shush", "sneeze", "stop", "stretch", "taunt", "thumb", "thumbs", "victory",
    "watch", "wave", "waving", "yawn",
))  # fmt: skip
MODEST = frozenset(["beat", "blink", "breath", "breathe", "emphasis", "nod", "settle", "shift", "sway"])


def measure_prominence(project: Project, action: Action) -> float:
    """Return how much an action stands out, 0..1: as its user says, else by its motion and its name.

    Half of what its motion counts is how far its hands (arms), trunk and feet or head go, half how fast.
    Words of its name and tags that mean something by themselves (wave, watch, thumbs up) make it at least
    0.75; words for what accompanies speech (beat, nod) make it at most 0.3. Names in other languages than
    English count by their motion. To two digits, so that what reads them from a file has the same.
    """
    if action.prominence is not None:
        return action.prominence
    moved = _moved(project, action)
    words = {word for text in (action.name, *action.tags) for word in split_tokens(text)}
    words |= {word.removesuffix("ing") for word in words}
    if words & MODEST:
        return round(min(SMALL, moved), 2)
    return round(max(EMBLEM, moved) if words & EMBLEMS else moved, 2)


def _moved(project: Project, action: Action) -> float:
    entry = project.clips.get(action.clip)
    if entry is None or entry.motion is None or project.skeleton is None:
        return 0.0
    start, end = project.span(action)
    motion = entry.motion
    if motion.frames < 3 or end <= start:
        return 0.0
    if action.layer == "head":
        roles = anatomy.project_roles(project) if motion.skeleton == project.skeleton else {}
        trunk = next((roles[r] for r in ("upper_chest", "chest", "spine") if r in roles), -1)
        if "head" not in roles:
            return 0.0
        far, fast = _turned(ref(motion), roles["head"], trunk, start, end)
        return _share(action.layer, far, fast)
    joints, seen_from = find_movers(project, motion, action.layer, action.limb)
    size = project.skeleton.height / TALL
    far, fast = _gone(ref(motion), joints, seen_from, start, end)
    return _share(action.layer, far / size, fast / size)


def _share(layer: Layer, far: float, fast: float) -> float:
    return 0.5 * min(1.0, far / FAR[layer]) + 0.5 * min(1.0, fast / FAST[layer])


def _frames(motion: Clip, start: float, end: float) -> slice:
    first = min(int(start * motion.fps), motion.frames - 3)
    return slice(first, max(first + 3, int(end * motion.fps) + 1))


@lru_cache(maxsize=REMEMBERED)
def _gone(
    whose: ref[Clip], joints: tuple[int, ...], seen_from: int, start: float, end: float
) -> tuple[float, float]:
    """Return how far the joint goes that goes farthest, and how fast the fastest is, in metres and seconds;
    the fastest twentieth of the frames is left out.
    """
    motion = whose()
    assert motion is not None
    places: Any = track(whose, joints, seen_from)[_frames(motion, start, end)]
    far = np.linalg.norm(places - places[0], axis=-1).max()
    speeds = np.linalg.norm(np.diff(places, axis=0), axis=-1).max(-1) * motion.fps
    return float(far), float(np.percentile(speeds, 95))


@lru_cache(maxsize=REMEMBERED)
def _turned(whose: ref[Clip], head: int, trunk: int, start: float, end: float) -> tuple[float, float]:
    """Return how far the head turns from where it began, and how fast, in radians and seconds."""
    motion = whose()
    assert motion is not None
    turns, _ = motion.skeleton.globals(motion.poses())
    seen: Any = turns[:, head]
    if trunk >= 0:
        seen = rotation.multiply(rotation.conjugate(turns[:, trunk]), seen)
    seen = seen[_frames(motion, start, end)]

    def angles(a: Any, b: Any) -> Any:
        return 2.0 * np.arccos(np.clip(np.abs(np.sum(a * b, axis=-1)), 0.0, 1.0))

    return float(angles(seen, seen[:1]).max()), float(
        np.percentile(angles(seen[1:], seen[:-1]), 95) * motion.fps
    )
