"""The life layers at a time: what they add to the pose the layers have composed.

All is additive: a turn is multiplied on the right of a joint's composed rotation, a shift is added to its
translation.

    breath(t)   = depth e(min(x / 0.4, (1 - x) / 0.6)),  x: how far the breath has gone, e(x) = 3 x^2 - 2 x^3
    blink(t)    = e(min(x / close, (close + open - x) / open)),  x: seconds since the blink began
    gaze(t)     = moves from target to target, with aversions and saccades: `gaze`
    head(a)     = share a |a| / (|a| + 15 degrees), and all beyond what the eyes do with ease, for a target at
    angle a: `solve`
    eyes        = the turn that aims each eye at the target from where head and body have it, so they hold
    while the head nods
    lid         = follow x pitch of the eye + blink x (1 - how far it is shut already)
    posture     = the mood's droop x bowed, its thrust and tension, its lift of the shoulders, on top of the
                  breath: `mood.bearing`
    expressions = of moods, speech and cues: `expressions.shown_face`, `expressions.answer`
    mouth       = sum over mouth shapes of weight x shape: `lips`
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.anatomy import get_base_pose
from metagraph.graph.face.names import MOOD_FACE
from metagraph.graph.face.rig import CHANNELS, LIDS, MOUTH, UPPER_FOLLOWS, UPPER_LID_SHUT, FaceRig
from metagraph.graph.life import Life
from metagraph.graph.model import Project
from metagraph.motion.skeleton import Pose
from metagraph.playback.life.body import Body
from metagraph.playback.life.expressions import FaceShown, answer, settle, shown_face
from metagraph.playback.life.gaze import BodyGaze, Moves, ease_gaze
from metagraph.playback.life.lane import Lane
from metagraph.playback.life.lips import compute_mouth_shapes
from metagraph.playback.life.schedule import HALF, Schedule
from metagraph.playback.life.solve import FaceLids, LifeDials, LifeNow, solve_life
from metagraph.playback.life.track import Track
from metagraph.playback.planning.mood import Bearing, bearing, shut_in
from metagraph.playback.planning.mood import shown as mood_shown

Array = NDArray[Any]

Playing = tuple[Sequence[str], float, float]  # a cue: its action's tags, start and end, seconds
INHALE = 0.4  # of a breath
UNMOVED = Bearing()
MORPH_LOOK = np.radians(30.0)  # the turn of an eye that a morph target of a look stands for
# How far a morph target shuts for an eye that looks down a radian.
MORPH_FOLLOWS = UPPER_FOLLOWS / np.radians(UPPER_LID_SHUT)
MORPH_WIDE = 0.6  # of a target that opens wide, for a lid as far open as it would be shut

_PRODUCT = np.array(
    [[3, 2, 1, 0], [2, 3, 0, 1], [1, 0, 3, 2], [0, 1, 2, 3]]
)  # of quaternions, as a matrix of the left one
_SIGNS = np.array([[1.0, -1, 1, 1], [1, 1, -1, 1], [-1, 1, 1, 1], [-1, -1, -1, 1]])


def make_face_lids(face: FaceRig) -> FaceLids:
    """Return a face's lids as `solve_life` takes them; where none is a joint, how far morph targets
    follow.
    """
    joints = [joint >= 0 for joint in face.lid_joints.tolist()]
    follows = face.follows.tolist() if any(joints) else [MORPH_FOLLOWS, MORPH_FOLLOWS, 0.0, 0.0]
    return FaceLids(joints, follows, face.shut_by.tolist())


@dataclass(frozen=True, slots=True)
class _Look:
    """A face at a time. blink: 0..1. shut: how far each of LIDS is. eyes: their turns to the left and up,
    radians. bears: the mood's part in it.
    """

    blink: float
    shut: tuple[float, ...]
    eyes: tuple[tuple[float, float], ...]
    bears: Bearing = UNMOVED


@dataclass(frozen=True, slots=True)
class _Found:
    """What the life layers make of poses `[N, J]`: chain `[N, c, 4]` as breathing has it, turns `[N, M, 3]`
    of the body's joints but the face's, channels `[N, C]` of the face and faces.
    """

    chain: Array
    turns: Array
    channels: Array
    faces: list[_Look]


class LifeStage:
    """Adds breathing, gaze, lids, lips and expressions to the composed poses of a plan."""

    def __init__(self, project: Project, schedule: Schedule, track: Track, body: Body) -> None:
        life = project.life
        self._project, self._schedule, self._track, self.body = project, schedule, track, body
        self._gaze = None
        if body.lookers and schedule.targets:  # else it looks at nothing
            self._gaze = BodyGaze(schedule, life, body, project.points)
        self._lids = make_face_lids(body.face)
        self._dials = LifeDials(life.gaze, 1 - life.stillness, life.head_share, life.lids)

    def run(self, pose: Pose, times: Array) -> Pose:
        """Return composed poses `[N, J]` with life added at `times [N]`, in any order; each depends on its
        own time alone.
        """
        body, face = self.body, self.body.face
        if not self._project.life.on or not len(times) or body.empty:
            return pose
        found = self._find(pose, times)
        rotations, translations = np.array(pose.rotations), pose.translations
        rotations[:, body.joints] = self._turned(pose, found)
        if len(face.shifted) and found.channels.any():
            translations = np.array(translations)
            translations[:, face.joints[face.shifted]] += _each(found.channels, face.shifts[:, face.shifted])
        return Pose(rotations, translations)

    def morphs(
        self, seconds: float, pose: Pose | None = None, playing: Iterable[Playing] = ()
    ) -> dict[str, float]:
        """Return the weights that life gives morph targets at one time, 0..1.

        pose: the composed pose `[J]` before `run`, so that eyes made of morph targets hold while the head
        moves; else the base pose. playing: what plays, which the face answers (`expressions.answer`).
        """
        life, schedule = self._project.life, self._schedule
        if not life.on or not self.body.face.morphs:
            return {}
        whole = get_base_pose(self._project) if pose is None else pose
        one = Pose(whole.rotations[None], whole.translations[None])
        found = self._find(one, np.array([float(seconds)]))
        look, face = found.faces[0], FaceShown()
        shown_face(face, life, schedule.swells, schedule.emphases, look.bears, float(seconds))
        for tags, start, end in playing:
            answer(face, life, tags, start, end, float(seconds))
        settle(face)
        return _morphs(self.body.face, look, face, found.channels[0])

    def _find(self, pose: Pose, times: Array) -> _Found:
        """Return what happens to poses `[N, J]` at times `[N]`."""
        body, gaze, life = self.body, self._gaze, self._project.life
        read = pose.rotations[:, body.read].tolist()
        places = pose.translations[:, body.chain].tolist()
        channels = self._spoken(times)
        chains: list[Any] = []
        turns: list[Any] = []
        faces: list[_Look] = []
        for n, time in enumerate(times.tolist()):
            now, bears = find_happening(self._schedule, life, time)
            moves = gaze.at(time) if gaze is not None else NO_MOVES
            chain, turn, eyes, shut, own = solve_life(
                body, self._lids, self._dials, now, read[n], places[n], moves, gaze is not None
            )
            chains.append(chain)
            turns.append(turn)
            faces.append(_Look(now.blink, tuple(shut), tuple(eyes), bears))
            channels[n, : len(LIDS) + 1] = (*own, now.blink)
        shaped = np.array(chains).reshape(len(times), len(body.chain), 4)
        return _Found(shaped, np.array(turns).reshape(len(times), -1, 3), channels, faces)

    def _spoken(self, times: Array) -> Array:
        """Return the face's channels `[N, C]` at times, the mouth's filled."""
        project, out = self._project, np.zeros((len(times), len(CHANNELS)))
        life = project.life
        if life.lips > 0:
            shown = compute_mouth_shapes(self._track, project.voices, life.lip_smoothing, times)
            if shown is not None:
                out[:, len(LIDS) + 2 :] = shown * life.lips
        return out

    def _turned(self, pose: Pose, found: _Found) -> Array:
        """Return what the rotations of the body's joints become `[N, L, 4]`."""
        body, turns = self.body, found.turns
        local = np.asarray(pose.rotations[:, body.joints], np.float64)
        local[:, : len(body.chain)] = found.chain
        if len(body.face.joints):
            turns = np.concatenate([turns, _each(found.channels, body.face.turns)], 1)
        return _times(local, _turn(turns))


def find_happening(schedule: Schedule, life: Life, time: float) -> tuple[LifeNow, Bearing]:
    """Return what happens to a body at a time, and what the mood has in it."""
    full = compute_breath(schedule.breaths, life, time)
    mood = mood_shown(schedule.moods.times, schedule.moods.rows, time)
    bears = UNMOVED if mood.neutral else bearing(mood)
    blink = shut_in(compute_blink(schedule.blinks, life, time), bears.lids)
    now = LifeNow(full, bears.droop, bears.thrust, full + bears.lift, bears.tension, bears.closed, blink)
    return now, bears


NO_MOVES = Moves((), (0.0, 0.0), (0.0, 0.0))


def compute_breath(lane: Lane, life: Life, time: float) -> float:
    """Return how full the chest is, 0 at rest, about 1 at the top of a breath."""
    starts, values = lane.times, lane.rows
    n = bisect_right(starts, time) - 1
    if n < 0:
        return 0.0
    length, depth = values[n]
    gone = (time - starts[n]) / length
    return (
        life.breathing
        * (1 - life.stillness)
        * depth
        * ease_gaze(min(gone / INHALE, (1 - gone) / (1 - INHALE)))
    )


def compute_blink(lane: Lane, life: Life, time: float) -> float:
    """Return how far a blink has shut the eyes, 0..1."""
    starts = lane.times
    whole, out = life.blink_close + life.blink_open, 0.0
    n = bisect_right(starts, time) - 1
    while n >= 0 and time - starts[n] < whole:  # a slow one may still be opening when the next begins
        gone = time - starts[n]
        far = HALF if lane.rows[n][0] == 3.0 else 1.0
        out = max(out, far * ease_gaze(min(gone / life.blink_close, (whole - gone) / life.blink_open)))
        n -= 1
    return out


def _morphs(face: FaceRig, look: _Look, shown: FaceShown, channels: Array) -> dict[str, float]:
    """Return morph target weights of a face."""
    values: dict[str, float] = {"blink": max(sum(look.shut[:2]) / 2, look.blink)}
    for n, side in enumerate(("left", "right")):
        values[f"blink_{side}"], values[f"wide_{side}"] = look.shut[n], -MORPH_WIDE * look.shut[n]
        left, up = (x / MORPH_LOOK for x in look.eyes[n])
        values |= {
            f"look_left_{side}": left,
            f"look_right_{side}": -left,
            f"look_up_{side}": up,
            f"look_down_{side}": -up,
        }
    values |= {channel: getattr(shown, channel) for channel in MOOD_FACE}
    values |= dict(zip(MOUTH, channels[len(LIDS) + 1 :].tolist(), strict=True))
    out: dict[str, float] = {}
    for channel, targets in face.morphs.items():
        value = values.get(channel, 0.0)
        if value > 1e-4:
            for name, weight in targets:
                out[name] = out.get(name, 0.0) + value * weight
    return {name: min(1.0, value) for name, value in out.items()}


# --- many joints at once


def _times(a: Array, b: Array) -> Array:
    """Return products `[..., 4]`: rotate by `b`, then by `a`."""
    return np.asarray((a[..., _PRODUCT] * _SIGNS) @ b[..., None])[..., 0]


def _turn(vectors: Array) -> Array:
    """Return unit quaternions `[..., 4]` of rotation vectors `[..., 3]`."""
    size = np.sqrt((vectors * vectors).sum(-1) + 1e-30)
    half = 0.5 * size
    out = np.empty((*vectors.shape[:-1], 4))
    out[..., :3] = vectors * (np.sin(half) / size)[..., None]
    out[..., 3] = np.cos(half)
    return out


def _each(channels: Array, shapes: Array) -> Array:
    """Return sums over channels `[N, C]` of shapes `[C, F, 3]`: `[N, F, 3]`."""
    flat = shapes.reshape(len(shapes), -1)
    return np.asarray((channels[:, None, :] @ flat)[:, 0]).reshape(len(channels), *shapes.shape[1:])
