"""Which figure draws the character: the project's own GLB, or a stick figure for any skeleton without one."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from PySide6.QtCore import QObject, Signal

from app.document import Document
from app.jobs import Jobs
from metagraph.graph.model import Project
from metagraph.motion.skeleton import Skeleton
from preview.figure import Figure, SkinnedFigure, StickFigure


class Figures(QObject):
    """changed: another figure is to be drawn. A character is read on a thread; until it is there a stick figure stands in."""

    changed = Signal()

    def __init__(self, document: Document, jobs: Jobs, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.document, self.jobs = document, jobs
        self._sticks: dict[str, Figure] = {}
        self._skinned: tuple[tuple[Any, ...], Figure] | None = None
        self._wanted: tuple[Any, ...] | None = None
        document.changed.connect(self._follow)

    def _key(self, project: Project) -> tuple[Any, ...] | None:
        if project.character is None or project.skeleton is None:
            return None
        path = (self.document.folder or Path()) / project.character
        return str(path), project.skeleton.fingerprint

    def _follow(self, before: Project, after: Project) -> None:
        key = self._key(after)
        if key == self._wanted:
            return
        self._wanted = key
        if key is None or after.skeleton is None:
            self.changed.emit()
            return
        skeleton = after.skeleton

        def read(_: object) -> tuple[tuple[Any, ...], Figure]:
            return key, load_figure(Path(key[0]), skeleton)

        self.jobs.start("character", read, self._read, self._unreadable, quick=True)

    def _read(self, result: tuple[tuple[Any, ...], Figure]) -> None:
        if result[0] == self._wanted:
            self._skinned = result
            self.changed.emit()

    def _unreadable(self, error: Exception) -> None:
        self.document.failed.emit(f"The character cannot be drawn: {error}")
        self.changed.emit()

    def figure(self, skeleton: Skeleton) -> Figure:
        """Return the figure for a skeleton: the project's character on the project's skeleton, else a stick figure."""
        project = self.document.project
        if self._skinned is not None and self._skinned[0] == self._key(project) and skeleton == project.skeleton:
            return self._skinned[1]
        found = self._sticks.get(skeleton.fingerprint)
        if found is None:
            found = self._sticks[skeleton.fingerprint] = StickFigure(skeleton)
        return found


def load_figure(path: Path, skeleton: Skeleton) -> Figure:
    """Return a character's figure bound to a skeleton. Raises FileError."""
    from metagraph.formats.gltf import read_character
    from preview.gpu import decoded

    figure = SkinnedFigure(read_character(path), skeleton)
    for batch in figure.mesh.batches:
        if batch.image is not None:
            decoded(batch.image)  # here, on a thread, rather than when it is first drawn
    return figure
