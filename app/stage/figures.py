"""Choose the figure that draws the character: the project's own GLB, or a stick figure for any skeleton
without one.
"""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QObject, QTimer, Signal

from app.project.document import Document
from app.project.jobs import Jobs, WindowJob
from app.stage.playback_source import ShownPlayback
from app.translation import tr
from metagraph.errors import FileError
from metagraph.graph.model import Project
from metagraph.motion.skeleton import Skeleton
from preview.character_file import figure_from_file
from preview.figure import MeshFigure

Key = tuple[str, str, tuple[str, ...]]  # the character's file, the skeleton it is bound to, what is hidden
REST = 1500  # milliseconds after a new figure, in which much else is made


class Figures(QObject):
    """Reads and builds figures on a thread. `changed` is emitted if another figure should be drawn."""

    changed = Signal()

    def __init__(self, document: Document, jobs: Jobs, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.document, self.jobs = document, jobs
        self._sticks: dict[str, MeshFigure | None] = {}  # None while it is being built
        self._skinned: tuple[Key, MeshFigure] | None = None
        self._guests: dict[
            Key, MeshFigure | None
        ] = {}  # characters of other projects, who talk with this one's
        self._wanted: Key | None = None
        self._unreadable: Key | None = None
        self._whole: list[MeshFigure] = []  # figures whose levels of detail are still to be made
        self._later = QTimer(self, singleShot=True, interval=REST)
        self._later.timeout.connect(self._make_levels)
        document.changed.connect(self._follow)

    def _key(self, project: Project) -> Key | None:
        if project.character is None or project.skeleton is None:
            return None
        path = (self.document.folder or Path()) / project.character
        return str(path), project.skeleton.fingerprint, project.hidden

    def _follow(self, before: Project, after: Project) -> None:
        key = self._key(after)
        if key == self._wanted:
            return
        self._wanted, self._unreadable = key, None
        if key is None or after.skeleton is None:
            self.changed.emit()
            return
        skeleton = after.skeleton
        self.jobs.start(
            "character",
            lambda _: (key, _ready(figure_from_file(Path(key[0]), skeleton, key[2]))),
            self._read,
            lambda error: self._refused(key, error),
            quick=True,
        )

    def _read(self, result: tuple[Key, MeshFigure]) -> None:
        if result[0] == self._wanted:
            self._skinned = result
            self._simplify(result[1])
            if result[1].instead:
                self.document.failed.emit(tr("A stick figure is drawn: {instead}", instead=result[1].instead))
            self.changed.emit()

    def _refused(self, key: Key, error: Exception) -> None:
        if key == self._wanted:
            self._unreadable = key
            self.document.failed.emit(tr("The character cannot be drawn: {error}", error=error))
            self.changed.emit()

    def figure(self, skeleton: Skeleton) -> MeshFigure | None:
        """Return the figure for a skeleton: the project's character on the project's skeleton, else a stick
        figure.

        None while it is being made; `changed` is emitted when it is ready.
        """
        project = self.document.project
        key = self._key(project)
        if key is not None and key != self._unreadable and skeleton == project.skeleton:
            # Until meshes are shown or hidden, the drawn figure stays.
            return self._skinned[1] if self._skinned is not None and self._skinned[0][:2] == key[:2] else None
        if skeleton.fingerprint not in self._sticks:
            self._sticks[skeleton.fingerprint] = None
            self.jobs.start(
                "figure", lambda _: _ready(figure_from_file(None, skeleton)), self._built, quick=True
            )
        return self._sticks[skeleton.fingerprint]

    def of(self, shown: ShownPlayback) -> MeshFigure | None:
        """Return the figure for what is shown; for another project's character, that one's own. None while it
        is being made.
        """
        skeleton, character = shown.skeleton, shown.project.character
        if skeleton is None:
            return None
        if shown.folder is None or character is None or shown.clip is not None:
            return self.figure(skeleton)
        key = (str(shown.folder / character), skeleton.fingerprint, shown.project.hidden)
        if key == self._key(self.document.project):
            return self.figure(skeleton)
        if key not in self._guests:
            self._guests[key] = None

            def work(_: object) -> tuple[Key, MeshFigure]:
                try:
                    return key, _ready(figure_from_file(Path(key[0]), skeleton, key[2]))
                except FileError:  # it moves in any case
                    return key, _ready(figure_from_file(None, skeleton))

            self.jobs.start("character", work, self._came, quick=True)
        return self._guests[key]

    def _came(self, result: tuple[Key, MeshFigure]) -> None:
        self._guests[result[0]] = result[1]
        self._simplify(result[1])
        self.changed.emit()

    def _simplify(self, figure: MeshFigure) -> None:
        """Make its levels of detail while it is already drawn, once the window is idle."""
        self._whole.append(figure)
        self._later.start()

    def _make_levels(self) -> None:
        figures, self._whole = self._whole, []

        def work(job: WindowJob) -> None:
            for figure in figures:
                figure.simplify(lambda: job.cancelled)

        self.jobs.start("levels of detail", work, quick=True)

    def _built(self, figure: MeshFigure) -> None:
        self._sticks[figure.skeleton.fingerprint] = figure
        self._simplify(figure)
        self.changed.emit()


def _ready(figure: MeshFigure) -> MeshFigure:
    """Compute on this thread what would otherwise be computed while the first picture is drawn."""
    from preview.gpu import decode_texture

    for batch in figure.mesh.batches:
        if batch.image is not None:
            decode_texture(batch.image)
    _, rest = figure.skeleton.globals(figure.skeleton.rest)
    figure.bounds(rest)
    return figure
