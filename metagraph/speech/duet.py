"""Characters who talk with each other, mostly two: each with its own graph and voice, two facing each other,
several in a circle.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import atan2, cos, hypot, pi, sin
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from metagraph.errors import FileError
from metagraph.graph import anatomy
from metagraph.graph.conversation.model import Conversation, Side, list_other_sides
from metagraph.graph.model import Project
from metagraph.graph.requests import AnyRequest, Line, Performance, Point
from metagraph.motion import rotation
from metagraph.playback.evaluator import Evaluator
from metagraph.playback.life.voice import Voice
from metagraph.playback.plan import Plan
from metagraph.playback.planning.running_plan import plan_performance
from metagraph.playback.posing.rigs import get_rigs
from metagraph.speech.delivered import Delivered, count_delivered
from metagraph.speech.drive import drive
from metagraph.speech.gaze_shares import GazeShare, measure_gaze_shares
from metagraph.speech.lines import read_spoken_voice
from metagraph.speech.mirroring import Mover, list_mirrored_stances
from metagraph.speech.sympathies import list_sympathies

Array = NDArray[Any]
HEAD = 1.6  # metres up, of a skeleton whose head is not known


@dataclass(frozen=True, slots=True)
class Stand:
    """Where a character stands: turned about the vertical by `turn` radians, then moved to x, z metres."""

    turn: float = 0.0
    x: float = 0.0
    z: float = 0.0

    def placed(self, rotations: Array, positions: Array) -> tuple[Array, Array]:
        """Return global rotations `[..., J, 4]` xyzw and positions `[..., J, 3]` of a character that stands
        here.
        """
        about = np.array([0.0, sin(self.turn / 2), 0.0, cos(self.turn / 2)], rotations.dtype)
        moved = rotation.rotate_vectors(np.broadcast_to(about, rotations.shape), positions) + np.array(
            [self.x, 0.0, self.z], positions.dtype
        )
        return rotation.multiply(np.broadcast_to(about, rotations.shape), rotations), moved

    def world(self, point: Point) -> Point:
        """Return where a point of this one's space is, metres."""
        x, y, z = point
        turned = x * cos(self.turn) + z * sin(self.turn), z * cos(self.turn) - x * sin(self.turn)
        return turned[0] + self.x, y, turned[1] + self.z

    def own(self, point: Point) -> Point:
        """Return where a point that all see is in this one's space, metres."""
        x, y, z = point[0] - self.x, point[1], point[2] - self.z
        turned = x * cos(self.turn) - z * sin(self.turn), x * sin(self.turn) + z * cos(self.turn)
        return round(turned[0], 6), y, round(turned[1], 6)


@dataclass(frozen=True)
class DuetPart:
    """One of them. project: its graph, with its voice among the lines. performance: what it is asked.
    told: what becomes of its rates. looks: of three or more, where it looks.
    """

    project: Project
    performance: Performance
    plan: Plan
    stand: Stand
    told: tuple[Delivered, ...] = ()
    looks: tuple[GazeShare, ...] = ()


@dataclass(frozen=True)
class Duet:
    """notes: what could not be read, in words."""

    parts: tuple[DuetPart, ...]
    length: float
    notes: tuple[str, ...] = ()


def place_sides(conversation: Conversation) -> tuple[Stand, ...]:
    """Return where the sides of a conversation stand, seen from the front.

    Two face each other, the first on the left. More stand in a circle, the first left of its opening towards
    the viewer and the others clockwise after it, as far from their neighbours as two would be: in such a
    circle each has all others in sight (Kendon's F-formation, 1990). Sides with a place of their own stand
    there and face the middle of the others.
    """
    count, distance = len(conversation.sides), conversation.distance
    if count == 2:
        circle = [Stand(pi / 2, -distance / 2), Stand(-pi / 2, distance / 2)]
    else:
        far = distance / (2 * sin(pi / count))
        angles = [pi * (2 * n + 1) / count for n in range(count)]  # from the opening, to the left
        circle = [Stand(atan2(sin(a), -cos(a)), -far * sin(a), far * cos(a)) for a in angles]
    if all(side.place is None for side in conversation.sides):
        return tuple(circle)
    at = [(c.x, c.z) if s.place is None else s.place for c, s in zip(circle, conversation.sides, strict=True)]
    return tuple(Stand(_facing(at, n), x, z) for n, (x, z) in enumerate(at))


def _facing(at: Sequence[tuple[float, float]], n: int) -> float:
    """Return how far one is turned who faces the middle of the others; to the viewer right in it."""
    others = [place for m, place in enumerate(at) if m != n]
    x, z = (sum(place[k] for place in others) / len(others) - at[n][k] for k in (0, 1))
    return atan2(x, z) if hypot(x, z) > 1e-3 else 0.0


def make_side_line(side: Side) -> Line:
    """Return the line that has a side's voice."""
    return Line(text=" ".join(w.text for w in side.words)[:20000], audio=side.audio, channel=side.channel)


def load_conversation_voices(
    conversation: Conversation, folder: Path
) -> tuple[tuple[Voice | None, ...], tuple[str, ...]]:
    """Return each side's voice, None if its sound is missing, and what could not be read, in words. folder:
    what paths begin at.
    """
    found: list[Voice | None] = []
    notes: list[str] = []
    for n, side in enumerate(conversation.sides, 1):
        try:
            found.append(
                read_spoken_voice(folder / side.audio, side.channel, side.words) if side.audio else None
            )
        except FileError as error:
            found.append(None)
            notes.append(f"{side.name or f'Speaker {n}'}: {error}")
    return tuple(found), tuple(dict.fromkeys(notes))


def plan_duet(
    conversation: Conversation, ident: str, projects: Sequence[Project], heard: Sequence[Voice | None]
) -> Duet:
    """Return all characters' plans. ident: the conversation's id. projects: of each side. heard: their
    voices.
    """
    places = place_sides(conversation)
    eyes = [find_resting_eyes(project) for project in projects]
    movers: list[Mover] = []
    driven = []
    for n in range(len(conversation.sides)):
        known = _with_voice(conversation, ident, n, projects[n], heard[n])
        heads = tuple(places[n].own(places[m].world(eyes[m])) for m in list_other_sides(conversation, n))
        performance, plan = drive(conversation, n, *known, heads, others=[m.plan for m in movers])
        driven.append((known, heads, performance))
        movers.append(Mover(n, known[0], plan))
    parts = []
    for n, (known, heads, performance) in enumerate(driven):
        others, plan = [m for m in movers if m.side != n], movers[n].plan
        taken_up: tuple[AnyRequest, ...] = (
            *list_mirrored_stances(conversation, movers[n], others),
            *list_sympathies(conversation, movers[n], others),
        )
        if taken_up:
            before = [m.plan for m in movers[:n]]
            performance, plan = drive(conversation, n, *known, heads, more=taken_up, others=before)
        told = count_delivered(conversation, n, known[0], plan)
        looks = measure_gaze_shares(conversation, n, known[0], plan)
        parts.append(DuetPart(known[0], performance, plan, places[n], told, looks))
    return Duet(tuple(parts), conversation.length)


def _with_voice(
    conversation: Conversation, ident: str, n: int, project: Project, voice: Voice | None
) -> tuple[Project, str | None]:
    """Return a side's project with its voice among the lines, and that line's id; None without a voice."""
    side, line = conversation.sides[n], None
    if voice is not None:
        line = _free_id(ident, n, project)
        peaks = [s.peak for s in side.segments if s.kind == "clause" and s.peak is not None]
        voice = replace(voice, stresses=np.array(peaks)) if peaks else voice
        project = replace(
            project,
            lines={**project.lines, line: make_side_line(side)},
            voices={**project.voices, line: voice},
        )
    if conversation.blinks == "peaks":  # and no others
        project = replace(project, life=msgspec.structs.replace(project.life, blinks=0.0, accent_blinks=0.0))
    return project, line


def _free_id(ident: str, side: int, project: Project) -> str:
    out = f"{ident}.{side + 1}"
    while out in project.lines:
        out += "'"
    return out


def find_resting_eyes(project: Project) -> Point:
    """Return where a character's eyes are as it rests in the stances it begins in, metres, in its own space:
    of somebody who sits, lower and farther back than in the pose at rest.
    """
    skeleton, roles = project.skeleton, anatomy.project_roles(project)
    head = roles.get("head")
    if skeleton is None or head is None:
        return 0.0, HEAD, 0.0
    rests = Evaluator(plan_performance(project, (), 1.0, 0, idle=False), project).layered(np.zeros(1))
    turned, at = (x[0].astype(float) for x in skeleton.globals(rests))
    eyes = [roles[eye] for eye in ("left_eye", "right_eye") if eye in roles]
    if len(eyes) == 2:
        x, y, z = (at[eyes[0]] + at[eyes[1]]) / 2
    else:  # where the rig has them, beside the head as it is turned
        body = get_rigs(project).body
        rest_turned, rest_at = (x.astype(float) for x in skeleton.globals(skeleton.rest))
        known = rest_at[head] if body.empty else np.asarray(body.eyes_at_rest, float)
        own = rotation.rotate_vectors(rotation.conjugate(rest_turned[head]), known - rest_at[head])
        x, y, z = at[head] + rotation.rotate_vectors(turned[head], own)
    return round(float(x), 3), round(float(y), 3), round(float(z), 3)
