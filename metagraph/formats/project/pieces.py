"""Parts of projects that go from one into another: a whole file, or what was copied in another window."""

from __future__ import annotations

import json
from collections.abc import Callable, Collection
from dataclasses import dataclass
from pathlib import Path

import msgspec

from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.project.clip_loading import load_motions
from metagraph.formats.project.data import FORMAT, from_data, to_data
from metagraph.formats.project.fields import DataError
from metagraph.formats.project.paths import make_paths_absolute, move_project
from metagraph.formats.store import open_project
from metagraph.graph.editing.taking import Taking, take, take_piece
from metagraph.graph.model import Project

CLIPBOARD = phrase("the clipboard")
_MARK = "metagraph_piece"


@dataclass(frozen=True)
class ProjectPiece:
    """A part of another project. project: with its clips loaded, its paths relative to where it goes.
    actions: those that are wanted; None for all. notes: what was odd about its files, in words.
    """

    project: Project
    actions: frozenset[str] | None = None
    notes: tuple[str, ...] = ()

    def into(self, project: Project, retarget: bool = True) -> Taking:
        """Return what comes of taking it into a project."""
        return take(project, self.project, self.actions, retarget)


def read_other_project(
    path: Path, into: Path | None, progress: Callable[[int, int], None] | None = None
) -> ProjectPiece:
    """Read another project's file, to be taken into the project at `into`; None: one without a file. Raises
    FileError.
    """
    if into is not None and path.resolve() == into.resolve():
        raise FileError(
            path,
            phrase("is the open project itself"),
            phrase("the file"),
            phrase("Choose the file of another project."),
        )
    opened = open_project(path, progress)
    return ProjectPiece(_at(opened.project, path, into), None, opened.notes)


def _at(project: Project, path: Path, into: Path | None) -> Project:
    return make_paths_absolute(project, path.parent) if into is None else move_project(project, path, into)


def encode_piece(
    project: Project, folder: Path | None, actions: Collection[str] = (), stances: Collection[str] = ()
) -> str:
    """Return actions and stances of a project as a text that any window pastes. folder: what its paths
    are relative to; None when they are absolute.
    """
    piece = take_piece(project, actions, stances)
    if folder is not None:
        piece = make_paths_absolute(piece, folder)
    wanted = [a.id for a in piece.actions() if a.id in actions or a.stance in stances]
    return json.dumps({_MARK: 1, "actions": wanted, "project": to_data(piece)})


def is_piece(text: str) -> bool:
    """Return whether a text may be one of `encode_piece`."""
    return text.startswith(f'{{"{_MARK}"')


def read_piece(text: str, into: Path | None) -> ProjectPiece:
    """Read what was copied in another window, its clips loaded from their files. Raises FileError."""
    try:
        data = msgspec.json.decode(text)
        if data["project"]["metagraph"] > FORMAT:
            raise ValueError(phrase("it comes from a newer Metagraph: update this one"))
        project = from_data(data["project"])
        wanted = frozenset(x for x in data["actions"] if isinstance(x, str))
    except (msgspec.DecodeError, DataError, KeyError, TypeError, ValueError, RecursionError) as error:
        raise FileError(
            CLIPBOARD,
            phrase("contains nothing that can be pasted ({error})", error=error),
            phrase("its text"),
            phrase("Copy stances or actions in another window first."),
        ) from None
    if into is not None:
        project = move_project(project, None, into)
    opened = load_motions(project, into.parent if into is not None else None)
    return ProjectPiece(opened.project, wanted, opened.notes)
