"""Plan a conversation on stage: the plans of all characters, made on a job's thread, with what was read for
them kept.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from threading import Lock
from typing import Any

import msgspec

from app.project.opening import open_whole, with_face
from app.stage.playback_source import ShownPlayback
from app.translation import tr
from metagraph.errors import FileError
from metagraph.graph.conversation.model import Side
from metagraph.graph.editing import performances as performance_edits
from metagraph.graph.model import Project
from metagraph.graph.requests import Performance

Key = tuple[Any, ...]


class ConversationPlans:
    """Reads voices and other projects once. Threads run one after another: the second one waits."""

    def __init__(self) -> None:
        self._one = Lock()
        self._voices: dict[Key, Any] = {}
        self._projects: dict[Key, Project] = {}
        self._bodies: dict[Key, tuple[str, ...]] = {}  # morph targets of characters

    def show(self, project: Project, ident: str, folder: Path, side: int = 0) -> ShownPlayback:
        """Return what all characters play: that of one side, with the others in it. `folder` is what paths
        are relative to.
        """
        with self._one:
            return self._show(project, ident, folder, side)

    def _show(self, project: Project, ident: str, folder: Path, side: int) -> ShownPlayback:
        from metagraph.speech.duet import load_conversation_voices, plan_duet

        conversation = project.conversations[ident]
        notes: list[str] = []
        wanted = {
            (str(folder / s.project), _written(folder / s.project))
            for s in conversation.sides
            if s.project is not None
        }
        self._projects = {key: found for key, found in self._projects.items() if key in wanted}
        moving = [self._project(project, s.project, folder, notes) for s in conversation.sides]
        drawn = {str(folder / s.character) for s in conversation.sides if s.character is not None}
        self._bodies = {key: found for key, found in self._bodies.items() if key[0] in drawn}
        projects = [
            self._drawn(p, s.character, folder, notes)
            for p, s in zip(moving, conversation.sides, strict=True)
        ]
        key = tuple(
            (s.audio, s.channel, s.words, _written(folder / s.audio) if s.audio else None)
            for s in conversation.sides
        )
        if key not in self._voices:
            self._voices = {key: load_conversation_voices(conversation, folder)}
        heard, told = self._voices[key]
        made = plan_duet(conversation, ident, projects, heard)
        moved = [_motion(p.project, s, notes) for p, s in zip(made.parts, conversation.sides, strict=True)]
        everyone = tuple(
            ShownPlayback(
                p.project,
                p.plan,
                made.length,
                side=n,
                stand=p.stand,
                motion=moved[n],
                told=p.told if moved[n] is None else (),
                looks=p.looks,
                asks=p.performance.asks,
                notes=(*notes, *told),
                folder=folder if s.project is None else (folder / s.project).parent,
            )
            for n, (p, s) in enumerate(zip(made.parts, conversation.sides, strict=True))
        )
        side = side if side < len(everyone) else 0  # for a conversation that had more sides
        return replace(everyone[side], others=tuple(one for one in everyone if one.side != side))

    def _project(self, project: Project, path: str | None, folder: Path, notes: list[str]) -> Project:
        """Return the project whose graph moves a side: another project, or the current one if that cannot be
        read.
        """
        if path is None:
            return project
        whole = folder / path
        key = (str(whole), _written(whole))
        if key not in self._projects:
            try:
                found = open_whole(whole)
            except (FileError, OSError) as error:
                notes.append(tr("{error} This speaker uses the graph of this project instead.", error=error))
                return project
            if found.project.skeleton is None:
                notes.append(
                    tr(
                        "{name} has no clips. This speaker uses the graph of this project instead.",
                        name=whole.name,
                    )
                )
                return project
            self._projects[key] = found.project
        return self._projects[key]

    def _drawn(self, project: Project, path: str | None, folder: Path, notes: list[str]) -> Project:
        """Return the project with the character that draws a side, and the morph targets of that face; its
        own character if there is no such file.
        """
        if path is None:
            return project
        whole = folder / path
        if not whole.is_file():
            notes.append(
                tr(
                    "There is no character at {whole}. This speaker uses the character of their project "
                    "instead.",
                    whole=whole,
                )
            )
            return project
        drawn = replace(project, character=str(whole), hidden=())
        key = (str(whole), _written(whole))
        if key not in self._bodies:
            self._bodies[key] = with_face(drawn, folder).face.morphs
        return replace(drawn, face=msgspec.structs.replace(project.face, morphs=self._bodies[key]))


def _motion(project: Project, side: Side, notes: list[str]) -> str | None:
    """Return the clip that moves a side instead of a graph, if it exists and fits."""
    if side.motion is None:
        return None
    entry = project.clips.get(side.motion)
    if entry is None or entry.motion is None or entry.motion.skeleton != project.skeleton:
        notes.append(
            tr(
                "The new motion of {name} is missing. The graph's motion is used instead.",
                name=side.name or tr("a speaker"),
            )
        )
        return None
    return side.motion


def _written(path: Path) -> int:
    try:
        return path.stat().st_mtime_ns
    except OSError:
        return 0


def keep_conversation(project: Project, ident: str, shown: ShownPlayback) -> tuple[Project, tuple[str, ...]]:
    """Keep what all sides of a conversation do as performances, each with the line it says; return the
    project and the performances' ids.

    A side that another project moves is left out, because its requests would mean nothing to this project's
    graph.
    """
    conversation = project.conversations[ident]
    kept: list[str] = []
    for side, part in zip(conversation.sides, shown.everyone, strict=True):
        if side.project is not None:
            continue
        for line in {s.line for s in part.plan.track.speeches if s.line is not None} - set(project.lines):
            project = performance_edits.set_line(project, line, part.project.lines[line])
            project = replace(project, voices={**project.voices, line: part.project.voices[line]})
        name = f"{conversation.name}: {side.name}" if side.name else conversation.name
        made = Performance(
            name=name[:200], asks=part.asks, seed=conversation.seed, length=conversation.length, idle=False
        )
        project, new = performance_edits.add_performance(project, made)
        kept.append(new)
    return project, tuple(kept)
