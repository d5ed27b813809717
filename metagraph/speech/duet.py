"""Two characters who talk with each other: each with its own graph and voice, facing the other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import cos, pi, sin
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from metagraph.errors import FileError
from metagraph.graph import anatomy
from metagraph.graph.conversation import Conversation, Side
from metagraph.graph.model import Project
from metagraph.graph.requests import Line, Performance
from metagraph.motion import rotation
from metagraph.playback.life.voice import Voice
from metagraph.playback.plan import Plan
from metagraph.speech.delivered import Delivered, delivered
from metagraph.speech.drive import drive
from metagraph.speech.lines import read_spoken
from metagraph.speech.mirroring import mirrored

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
        moved = rotation.rotate(np.broadcast_to(about, rotations.shape), positions) + np.array(
            [self.x, 0.0, self.z], positions.dtype
        )
        return rotation.multiply(np.broadcast_to(about, rotations.shape), rotations), moved


@dataclass(frozen=True)
class DuetPart:
    """One of the two. project: its graph, with its voice among the lines. performance: what it is asked.
    told: what becomes of its rates.
    """

    project: Project
    performance: Performance
    plan: Plan
    stand: Stand
    told: tuple[Delivered, ...] = ()


@dataclass(frozen=True)
class Duet:
    """notes: what could not be read, in words."""

    parts: tuple[DuetPart, DuetPart]
    length: float
    notes: tuple[str, ...] = ()


def stands(distance: float) -> tuple[Stand, Stand]:
    """Return where two stand who face each other, so many metres apart, seen from the side: the first on the
    left.
    """
    return Stand(pi / 2, -distance / 2), Stand(-pi / 2, distance / 2)


def line_of(side: Side) -> Line:
    """Return the line that has a side's voice."""
    return Line(text=" ".join(w.text for w in side.words)[:20000], audio=side.audio, channel=side.channel)


def voices(
    conversation: Conversation, folder: Path
) -> tuple[tuple[Voice | None, Voice | None], tuple[str, ...]]:
    """Return each side's voice, None where its sound is missing, and what could not be read, in words.
    folder: what paths begin at.
    """
    found: list[Voice | None] = []
    notes: list[str] = []
    for n, side in enumerate(conversation.sides, 1):
        try:
            found.append(read_spoken(folder / side.audio, side.channel, side.words) if side.audio else None)
        except FileError as error:
            found.append(None)
            notes.append(f"{side.name or f'Speaker {n}'}: {error}")
    return (found[0], found[1]), tuple(dict.fromkeys(notes))


def duet(
    conversation: Conversation, ident: str, projects: Sequence[Project], heard: Sequence[Voice | None]
) -> Duet:
    """Return both characters' plans. ident: the conversation's id. projects: of each side. heard: their
    voices.
    """
    heads = [_head(project) for project in projects]
    known = [_with_voice(conversation, ident, n, projects[n], heard[n]) for n in (0, 1)]
    at = [(0.0, round(heads[1 - n], 3), conversation.distance) for n in (0, 1)]
    made = [drive(conversation, n, *known[n], at[n]) for n in (0, 1)]
    taken_up = [
        tuple(mirrored(conversation, n, known[n][0], made[n][1], known[1 - n][0], made[1 - n][1]))
        for n in (0, 1)
    ]
    parts = []
    for n, stand in enumerate(stands(conversation.distance)):
        performance, plan = (
            drive(conversation, n, *known[n], at[n], more=taken_up[n]) if taken_up[n] else made[n]
        )
        told = delivered(conversation, n, known[n][0], plan)
        parts.append(DuetPart(known[n][0], performance, plan, stand, told))
    return Duet((parts[0], parts[1]), conversation.length)


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
            project, lines={**project.lines, line: line_of(side)}, voices={**project.voices, line: voice}
        )
    if conversation.blinks == "peaks":  # and no others
        project = replace(project, life=msgspec.structs.replace(project.life, blinks=0.0, accent_blinks=0.0))
    return project, line


def _free_id(ident: str, side: int, project: Project) -> str:
    out = f"{ident}.{side + 1}"
    while out in project.lines:
        out += "'"
    return out


def _head(project: Project) -> float:
    """Return how high a character's head is, metres."""
    if project.skeleton is None:
        return HEAD
    head = anatomy.roles(project).get("head")
    return HEAD if head is None else float(project.skeleton.globals(project.skeleton.rest)[1][head, 1])
