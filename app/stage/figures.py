"""Choose the figure that draws the character: the project's own GLB, or for any skeleton without one the
default body, or a stick figure.
"""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QObject, QTimer, Signal

from app.project.document import Document
from app.project.jobs import Jobs, WindowJob
from app.stage.playback_source import ShownPlayback
from app.stage.props import PropFigures
from app.stage.watch import Watch
from app.translation import tr
from metagraph.errors import FileError
from metagraph.graph.model import Project
from metagraph.motion.fitting.footing import Footing, choose_footing
from metagraph.motion.skeleton import Skeleton
from preview.character_file import load_mesh_figure
from preview.figure import MeshFigure, SkinnedFigure, StickFigure

Key = tuple[str, str, tuple[str, ...]]  # the character's file, the skeleton it is bound to, what is hidden
REST = 1500  # milliseconds after a new figure, in which much else is made


class Figures(QObject):
    """Reads and builds figures on a thread. `changed` is emitted if another figure should be drawn. `watch`
    says whether stick figures are drawn in place of the default body. `props` are what stands beside them.
    """

    changed = Signal()

    def __init__(
        self, document: Document, jobs: Jobs, watch: Watch | None = None, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self.document, self.jobs, self.watch = document, jobs, watch
        self.sticks = watch is not None and watch.now.sticks
        self._bodies: dict[str, MeshFigure | None] = {}  # without a mesh; None while it is being built
        self._footings: dict[str, Footing] = {}
        self._skinned: tuple[Key, MeshFigure] | None = None
        self._guests: dict[
            Key, MeshFigure | None
        ] = {}  # characters of other projects, who talk with this one's
        self._wanted: Key | None = None
        self._unreadable: Key | None = None
        self._whole: list[MeshFigure] = []  # figures whose levels of detail are still to be made
        self.props = PropFigures(document, jobs, self)
        self.props.changed.connect(self.changed)
        self._later = QTimer(self, singleShot=True, interval=REST)
        self._later.timeout.connect(self._make_levels)
        document.changed.connect(self._follow)
        if watch is not None:
            watch.changed.connect(self._choose_sticks)

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
        self._start(key, after)

    def _start(self, key: Key, project: Project) -> None:
        """Read the project's character."""
        skeleton, sticks = project.skeleton, self.sticks
        assert skeleton is not None
        footing = self.footing(skeleton, project)
        self.jobs.start(
            "character",
            lambda _: (key, _ready(load_mesh_figure(Path(key[0]), skeleton, key[2], footing, sticks))),
            self._read,
            lambda error: self._refused(key, error),
            quick=True,
        )

    def footing(self, skeleton: Skeleton, project: Project) -> Footing | None:
        """Return how a skeleton stands, told once by the first of the project's clips that is on it."""
        if skeleton.fingerprint not in self._footings:
            found = choose_footing((entry.motion for entry in project.clips.values()), skeleton)
            if found is None:
                return None
            self._footings[skeleton.fingerprint] = found
        return self._footings[skeleton.fingerprint]

    def _choose_sticks(self) -> None:
        """Build again what has no mesh, after the choice between body and sticks has changed."""
        assert self.watch is not None
        if self.sticks == self.watch.now.sticks:
            return
        self.sticks = self.watch.now.sticks
        self._bodies.clear()
        self._guests = {key: f for key, f in self._guests.items() if isinstance(f, SkinnedFigure)}
        if self._wanted is not None and self._skinned is not None and self._skinned[1].instead:
            self._start(self._wanted, self.document.project)
        self.changed.emit()

    def _read(self, result: tuple[Key, MeshFigure]) -> None:
        if result[0] == self._wanted:
            self._skinned = result
            self._simplify(result[1])
            if result[1].instead:
                if isinstance(result[1], StickFigure):
                    words = tr("A stick figure is drawn: {instead}", instead=result[1].instead)
                else:
                    words = tr("The default body is drawn: {instead}", instead=result[1].instead)
                self.document.failed.emit(words)
            self.changed.emit()

    def _refused(self, key: Key, error: Exception) -> None:
        if key == self._wanted:
            self._unreadable = key
            self.document.failed.emit(tr("The character cannot be drawn: {error}", error=error))
            self.changed.emit()

    def figure(self, skeleton: Skeleton, clips: Project | None = None) -> MeshFigure | None:
        """Return the figure for a skeleton: the project's character on the project's skeleton, else the
        default body, or a stick figure. `clips`: the project whose clips tell how the skeleton stands, the
        document's if None.

        None while it is being made; `changed` is emitted when it is ready.
        """
        project = self.document.project
        key = self._key(project)
        if key is not None and key != self._unreadable and skeleton == project.skeleton:
            # Until meshes are shown or hidden, the drawn figure stays.
            return self._skinned[1] if self._skinned is not None and self._skinned[0][:2] == key[:2] else None
        if skeleton.fingerprint not in self._bodies:
            self._bodies[skeleton.fingerprint] = None
            footing, sticks = self.footing(skeleton, clips or project), self.sticks
            self.jobs.start(
                "figure",
                lambda _: (sticks, _ready(load_mesh_figure(None, skeleton, (), footing, sticks))),
                self._built,
                quick=True,
            )
        return self._bodies[skeleton.fingerprint]

    def of(self, shown: ShownPlayback) -> MeshFigure | None:
        """Return the figure for what is shown; for another project's character, that one's own. None while it
        is being made.
        """
        skeleton, character = shown.skeleton, shown.project.character
        if skeleton is None:
            return None
        if shown.folder is None or character is None or shown.clip is not None:
            return self.figure(skeleton, shown.project)
        key = (str(shown.folder / character), skeleton.fingerprint, shown.project.hidden)
        if key == self._key(self.document.project):
            return self.figure(skeleton, shown.project)
        if key not in self._guests:
            self._guests[key] = None
            footing, sticks = self.footing(skeleton, shown.project), self.sticks

            def work(_: object) -> tuple[Key, MeshFigure]:
                try:
                    return key, _ready(load_mesh_figure(Path(key[0]), skeleton, key[2], footing, sticks))
                except FileError:  # it moves in any case
                    return key, _ready(load_mesh_figure(None, skeleton, (), footing, sticks))

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

    def _built(self, result: tuple[bool, MeshFigure]) -> None:
        sticks, figure = result
        if sticks != self.sticks:  # the other kind was chosen in the meantime
            return
        self._bodies[figure.skeleton.fingerprint] = figure
        self._simplify(figure)
        self.changed.emit()


def _ready(figure: MeshFigure) -> MeshFigure:
    """Compute on this thread what would otherwise be computed while the first picture is drawn."""
    from preview.gpu import decode_texture

    for batch in figure.mesh.batches:
        if batch.image is not None:
            decode_texture(batch.image)
    figure.bounds(figure.bound[1])
    return figure
