"""Find contacts in motion: where a hand touches the body, or moves along with it.

A hand touches a part while their surfaces are near each other and it moves slowly relative to that part. It
is then put where the surfaces meet, so that a hand that hovers touches, and a hand inside the part comes out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy, edits
from metagraph.graph.checks.end_gaps import get_action_motion
from metagraph.graph.model import Action, Project
from metagraph.motion import rotation
from metagraph.motion.character_mesh import CharacterMesh
from metagraph.motion.contact_solve import HAND, OBSTACLE, ContactRig
from metagraph.motion.contact_spans import EASE, HANDS, ContactKey, ContactSpan
from metagraph.playback.posing.contacts import find_body_parts, find_capsule_ends, find_nearest_between_lines
from metagraph.playback.posing.rigs import get_rigs

Array = NDArray[Any]

NEAR = 0.045  # of the arm's length: surfaces this near each other may touch
SLOW = 0.35  # of the arm's length a second: a hand that stays is not faster over what it touches
SLIDING = 1.0  # the same for a hand that rubs while it is TOUCHING
TOUCHING = 0.02  # of the arm's length
SHORTEST = 0.25  # seconds that a contact must last
BRIDGED = 0.2  # seconds of a gap between two contacts that are one
AT_ENDS = 0.1  # seconds: a contact this near an action's beginning or end continues to it
STILL = (0.012, 6.0)  # metres, degrees: a hand that moves less stays
THIN = (0.003, 2.0)  # metres, degrees: error to which keys are thinned
DEEPEST = 0.002  # metres a hand may be inside what it touches
ROUNDS = 12  # steps of bringing a hand to a surface and out of others
HANGING = (0.77, 0.88)  # cosine to straight down, and how straight: an arm that hangs touches no leg or trunk


@dataclass(frozen=True, eq=False)
class _Seen:
    """The frames of a clip: where joints and capsules are."""

    rig: ContactRig
    times: Array
    turned: Array
    at: Array
    a: Array
    b: Array
    arm: float


def find_contacts(project: Project, action: Action) -> tuple[ContactSpan, ...]:
    """Return the contacts of the hands that an action moves, in order; none if its clip is missing or the
    character has no arms.
    """
    motion = get_action_motion(project, action)
    rig = get_rigs(project).contacts if motion is not None else None
    if motion is None or rig is None:
        return ()
    start, end = project.span(action)
    first, last = int(np.ceil(start * motion.fps - 1e-6)), int(np.floor(end * motion.fps + 1e-6))
    if last - first < 2:
        return ()
    times = np.arange(first, last + 1) / motion.fps
    poses = motion.pose_at(times)
    turned, at = (np.asarray(x, float) for x in motion.skeleton.globals(poses))
    joints = list(rig.joints)
    a, b = find_capsule_ends(rig, poses)
    one = rig.arms[0]
    arm = float(
        np.linalg.norm(at[0, joints[one.lower]] - at[0, joints[one.upper]])
        + np.linalg.norm(at[0, joints[one.hand]] - at[0, joints[one.lower]])
    )
    seen = _Seen(rig, times, turned[:, joints], at[:, joints], a, b, arm)
    mask = anatomy.make_action_mask(project, action)
    found: list[ContactSpan] = []
    for side in (1, 0):
        if mask is None or mask[joints[rig.arms[side].hand]] > 0:
            found += _of_hand(seen, side, start, end, found)
    return tuple(sorted(found, key=lambda s: (s.start, s.hand)))


def list_contact_actions(project: Project) -> list[str]:
    """Return the ids of the actions whose layer moves the arms."""
    return [a.id for a in project.actions() if project.graphs[a.layer].weight("arms") > 0]


def with_contacts(project: Project, actions: Sequence[str]) -> Project:
    """Return a project whose named actions have the contacts found in their motion."""
    changes = {
        ident: {"contacts": find_contacts(project, action)}
        for ident in actions
        if (action := project.action(ident)) is not None
    }
    return edits.update_each(project, changes)


def _parts(rig: ContactRig, side: int) -> dict[int, list[int]]:
    """Return what a hand may touch: joint index -> the capsules that stand for it."""
    out: dict[int, list[int]] = {}
    for n, capsule in enumerate(rig.capsules):
        if capsule.arm != side:
            joint = rig.arms[1 - side].hand if capsule.kind == HAND else capsule.joint
            out.setdefault(joint, []).append(n)
    return out


def _of_hand(
    seen: _Seen, side: int, start: float, end: float, known: Sequence[ContactSpan]
) -> list[ContactSpan]:
    rig, times = seen.rig, seen.times
    own = [n for n, c in enumerate(rig.capsules) if c.arm == side and c.kind == HAND]
    hand = rig.arms[side].hand
    runs: list[tuple[float, int, int, int]] = []
    hanging = _hanging(seen, side)
    for joint, parts in _parts(rig, side).items():
        gap = np.min([_gap(seen, i, k) for i in own for k in parts], axis=0) / seen.arm
        away = _beside(seen, joint, seen.at[:, hand])
        speed = np.linalg.norm(np.gradient(away, times, axis=0), axis=1) / seen.arm
        on = ((gap < NEAR) & (speed < SLOW)) | ((gap < TOUCHING) & (speed < SLIDING))
        if rig.capsules[parts[0]].arm < 0:
            on &= ~hanging
        runs += [
            (float(np.sum(NEAR - np.clip(gap[i : k + 1], -NEAR, NEAR))), joint, i, k)
            for i, k in _runs(on, times)
        ]
    out: list[ContactSpan] = []
    names = {place: name for name, place in rig.places.items()}
    taken = np.zeros(len(times), bool)
    for _, joint, i, k in sorted(runs, reverse=True):
        free = np.flatnonzero(~taken[i : k + 1])
        if not len(free) or len(free) < 0.6 * (k + 1 - i):
            continue
        i, k = i + int(free[0]), i + int(free[-1])
        # Of two hands on each other, one carries the other.
        carried = rig.capsules[_parts(rig, side)[joint][0]].kind != OBSTACLE
        if carried and any(
            s.to == rig.hands[side] and s.start < times[k] and s.end > times[i] for s in known
        ):
            continue
        taken[i : k + 1] = True
        first, last = float(times[i]), float(times[k])
        keys, place = _keys(seen, side, joint, i, k)
        first = start if first - start < AT_ENDS else first
        last = end if end - last < AT_ENDS else last
        ease = min(EASE, (last - first) / 3)
        out.append(ContactSpan(HANDS[side], place, names[joint], first, last, keys, ease, ease))
    return out


def _runs(on: Array, times: Array) -> list[tuple[int, int]]:
    """Return the first and last frame of each contact, with near ones joined."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], on.astype(int), [0]))))
    out: list[tuple[int, int]] = []
    for i, k in edges.reshape(-1, 2):
        if out and times[i] - times[out[-1][1]] <= BRIDGED:
            out[-1] = (out[-1][0], int(k) - 1)
        else:
            out.append((int(i), int(k) - 1))
    return [(i, k) for i, k in out if times[k] - times[i] >= SHORTEST]


def _gap(seen: _Seen, i: int, k: int) -> Array:
    way, _ = find_nearest_between_lines(seen.a[:, i], seen.b[:, i], seen.a[:, k], seen.b[:, k])
    return np.asarray(
        np.linalg.norm(way, axis=-1) - seen.rig.capsules[i].radius - seen.rig.capsules[k].radius
    )


def _hanging(seen: _Seen, side: int) -> Array:
    arm = seen.rig.arms[side]
    way = seen.at[:, arm.hand] - seen.at[:, arm.upper]
    far = np.linalg.norm(way, axis=1)
    return np.asarray((-way[:, 1] / np.maximum(far, 1e-9) > HANGING[0]) & (far > HANGING[1] * seen.arm))


def _beside(seen: _Seen, joint: int, points: Array) -> Array:
    """Return points `[F, 3]` in the space of a joint."""
    return rotation.rotate_vectors(rotation.conjugate(seen.turned[:, joint]), points - seen.at[:, joint])


def _keys(seen: _Seen, side: int, joint: int, i: int, k: int) -> tuple[tuple[ContactKey, ...], str]:
    """Return where a hand is on a joint from frame i to k, at the surface, and which part of it touches."""
    hand = seen.rig.arms[side].hand
    frames = np.arange(i, k + 1)
    at = _beside(seen, joint, seen.at[:, hand])[frames]
    turn = rotation.make_continuous(
        rotation.multiply(rotation.conjugate(seen.turned[frames, joint]), seen.turned[frames, hand])
    )
    middle = len(frames) // 2
    still = (
        np.linalg.norm(at - np.median(at, axis=0), axis=1).max() <= STILL[0]
        and np.degrees(rotation.measure_angle_between(turn, turn[middle])).max() <= STILL[1]
    )
    if still:
        middle = int(np.argmin(np.linalg.norm(at - np.median(at, axis=0), axis=1)))
        chosen = [middle]
    else:
        chosen = _thinned(seen.times[frames], at, turn)
    pushes = [_to_surface(seen, side, joint, int(frames[n])) for n in chosen]
    place = pushes[len(pushes) // 2][1]
    keys = tuple(
        ContactKey(
            round(float(seen.times[frames[n]]), 4),
            tuple(np.round(at[n] + push, 5).tolist()),
            tuple(np.round(turn[n], 6).tolist()),
        )
        for n, (push, _) in zip(chosen, pushes, strict=True)
    )
    return keys, place


def _thinned(times: Array, at: Array, turn: Array) -> list[int]:
    """Return the frames that define a path: others lie on the lines between them (Ramer, Douglas,
    Peucker).
    """
    kept = {0, len(times) - 1}
    waiting = [(0, len(times) - 1)]
    while waiting:
        i, k = waiting.pop()
        if k - i < 2:
            continue
        part = ((times[i + 1 : k] - times[i]) / (times[k] - times[i]))[:, None]
        line = at[i] + (at[k] - at[i]) * part
        mixed = rotation.nlerp(np.broadcast_to(turn[i], (len(part), 4)), turn[k], part[:, 0])
        error = np.maximum(
            np.linalg.norm(at[i + 1 : k] - line, axis=1) / THIN[0],
            np.degrees(rotation.measure_angle_between(turn[i + 1 : k], mixed)) / THIN[1],
        )
        worst = int(np.argmax(error))
        if error[worst] > 1:
            kept.add(i + 1 + worst)
            waiting += [(i, i + 1 + worst), (i + 1 + worst, k)]
    return sorted(kept)


def _to_surface(seen: _Seen, side: int, joint: int, frame: int) -> tuple[Array, str]:
    """Return by what vector a hand moves in the joint's space to touch the part without being inside, and
    which part of it touches.
    """
    rig = seen.rig
    own = [n for n, c in enumerate(rig.capsules) if c.arm == side and c.kind == HAND]
    others = [n for n, c in enumerate(rig.capsules) if c.arm != side]
    i, k = (np.array(x) for x in zip(*[(i, k) for i in own for k in others], strict=True))
    its = np.isin(k, _parts(rig, side)[joint])
    radii = np.array([c.radius for c in rig.capsules])
    push = np.zeros(3)
    a, b = seen.a[frame], seen.b[frame]
    touching, way = 0, np.array([0.0, 1.0, 0.0])
    for turn in range(ROUNDS):
        apart, _ = find_nearest_between_lines(a[i] + push, b[i] + push, a[k], b[k])
        gap = np.linalg.norm(apart, axis=1)
        depth = radii[i] + radii[k] - gap
        touching = int(np.argmax(np.where(its, depth, -np.inf)))
        way = apart[touching] / max(gap[touching], 1e-9)
        deepest = int(np.argmax(depth))
        if depth[deepest] > DEEPEST:  # out of this part, and of any other that it is in
            push = push + apart[deepest] / max(gap[deepest], 1e-9) * (depth[deepest] - DEEPEST)
        elif depth[touching] < -DEEPEST and turn < ROUNDS // 2:
            push = push + way * (depth[touching] + DEEPEST)
        else:
            break
    local = rotation.rotate_vectors(rotation.conjugate(seen.turned[frame, joint]), push)
    return local, _place(seen, side, int(i[touching]), way, frame)


def _place(seen: _Seen, side: int, capsule: int, way: Array, frame: int) -> str:
    """Return which part of a hand touches. `way` points from what it touches to the hand."""
    rig = seen.rig
    hand = rig.arms[side].hand
    if rig.capsules[capsule].joint != hand:
        return "fingertips"
    palms = [n for n, c in enumerate(rig.capsules) if c.arm == side and c.kind == HAND and c.joint == hand]
    if len(palms) < 2:
        return "palm"
    first, last = (seen.b[frame, n] - seen.at[frame, hand] for n in (palms[0], palms[-1]))
    back = np.cross(first, last) * (1 if side == 0 else -1)
    return "palm" if float(back @ way) > 0 else "back"


def with_measured_body(project: Project, character: CharacterMesh | None) -> Project:
    """Return a project whose body has the measures of its character's mesh, or of its skeleton if there is no
    mesh on that skeleton.
    """
    fits = character is not None and character.skeleton == project.skeleton
    bare = replace(project, touch=msgspec.structs.replace(project.touch, parts=()))
    parts = find_body_parts(bare, character) if fits else ()
    return replace(project, touch=msgspec.structs.replace(project.touch, parts=parts))
