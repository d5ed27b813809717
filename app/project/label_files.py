"""Read files of labels from other programs, such as Blender's add-on: they place and change actions, with the
clips beside them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtWidgets import QFileDialog, QWidget

from app.project.document import Document
from app.project.files import Files
from app.project.importing import FileDrop, Importing
from app.project.jobs import Jobs, WindowJob
from app.translation import tr, tr_plural
from metagraph.common.studio import find_start_folder
from metagraph.formats.clip_readers import list_clip_suffixes
from metagraph.formats.imports import Imported
from metagraph.graph.model import Project

if TYPE_CHECKING:
    from metagraph.formats.action_labels import LabelRow

ENDING = ".labels.json"


def _filter() -> str:
    return tr("Labels (*{ending});;JSON (*.json);;All files (*)", ending=ENDING)


@dataclass(frozen=True)
class ReadLabels:
    """What a file says, and the clips that came with it."""

    rows: tuple[LabelRow, ...]
    clips: Imported

    def into(self, project: Project) -> tuple[Project, int, tuple[str, ...]]:
        """Return a project with both, how many rows were applied, and why others were not."""
        project = self.clips.into(project)
        at = {(entry.path, entry.take): entry.id for entry in project.clips.values()}
        from metagraph.formats.action_labels import apply_labels

        fresh = {clip.name: at[file, take] for file, take, _, clip in self.clips.loaded}
        return apply_labels(project, self.rows, fresh)


def find_clips_beside(path: Path) -> list[Path]:
    """Return the clip files with the name of a file of labels: `talk.glb` for `talk.labels.json`."""
    stem = path.name.removesuffix(ENDING)
    return [
        path.with_name(stem + ending)
        for ending in list_clip_suffixes()
        if path.with_name(stem + ending).is_file()
    ]


class LabelFiles:
    """Applies files of labels to the project, each as one step that can be undone. `drop` handles dropped
    ones.
    """

    def __init__(
        self, document: Document, jobs: Jobs, files: Files, importing: Importing, widget: QWidget
    ) -> None:
        self._document, self._jobs, self._files = document, jobs, files
        self._importing, self._widget = importing, widget
        self.drop = FileDrop((ENDING,), self._claimed, self.take)

    def ask(self) -> None:
        """Ask for a file of labels and apply it."""
        if self._files.refuse():
            return
        name, _ = QFileDialog.getOpenFileName(
            self._widget, tr("Import labels"), str(find_start_folder(self._document.folder)), _filter()
        )
        if name:
            self.take([Path(name)])

    def take(self, paths: Sequence[Path]) -> None:
        """Read files of labels on a thread and apply them."""
        for path in paths:
            self._take(path)

    @staticmethod
    def _claimed(paths: Sequence[Path]) -> Sequence[Path]:
        return [path for path in paths if path.name.lower().endswith(ENDING)]

    def _take(self, path: Path) -> None:
        from metagraph.formats.action_labels import read_labels
        from metagraph.formats.imports import import_files

        project, folder = self._document.project, self._document.folder

        def work(job: WindowJob) -> ReadLabels:
            tell = lambda n, total, file: job.tell(n, total, file.name)  # noqa: E731
            rows = read_labels(path)
            return ReadLabels(
                rows, import_files(project, folder, find_clips_beside(path), tell, lambda: job.cancelled)
            )

        def done(read: ReadLabels) -> None:
            left: tuple[str, ...] = ()
            met = 0

            def edit(project: Project) -> Project:
                nonlocal left, met
                project, met, left = read.into(project)
                return project

            self._document.edit(
                tr(
                    "Import labels of {actions}",
                    actions=tr_plural("{count:,} action", "{count:,} actions", len(read.rows)),
                ),
                edit,
            )
            told = tr(
                "Labelled {met} of {actions}",
                met=met,
                actions=tr_plural("{count:,} action", "{count:,} actions", len(read.rows)),
            )
            why = (*left, *read.clips.failures)
            if why:
                self._importing.report.emit(told, list(why))
            self._importing.told.emit(told)

        self._jobs.start(tr("Importing labels"), work, done, self._files.show_failure)
