"""Handle a project file that another program writes while it is open here: notice it, show it, and merge,
reload or replace it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject
from PySide6.QtWidgets import QMessageBox

from app.project.files_host import FilesHost
from app.project.jobs import WindowJob
from app.project.opening import load_whole, with_motion_of
from app.project.writing import FileChangedError, find_file_change
from app.translation import tr
from metagraph.formats.project.clip_loading import Opened
from metagraph.graph.model import Project

if TYPE_CHECKING:
    from metagraph.formats.project.merging import MergeError

Merging = tuple[Opened, tuple[str, ...]]


class Outside(QObject):
    """The part of a window's files that other programs write."""

    def __init__(self, files: FilesHost) -> None:
        super().__init__(files.window)
        self.files, self.document = files, files.document
        self._told_of: str | None = None  # the digest of a changed file that was reported
        self._era = 0  # counts the projects that were shown
        self.document.loaded.connect(self._next_era)
        files.saver.changed.connect(self.ask)

    def _next_era(self) -> None:
        self._era += 1
        self._told_of = None

    def look(self) -> None:
        """Check whether the project file has changed on disk, and report it."""
        document, files = self.document, self.files
        path, digest = document.path, document.digest
        if path is None or digest is None or files.saver.busy:
            return

        def done(changed: FileChangedError | None) -> None:
            if (
                changed is None
                or files.saver.busy
                or (document.path, document.digest) != (path, digest)
                or changed.digest == self._told_of
            ):
                return
            self._told_of = changed.digest
            document.keep_all()
            tip = tr("Another program, another window or a version control update wrote it")
            files.noticed.emit(
                tr("{name} changed on disk. Compare…", name=path.name)
                if document.dirty
                else tr("{name} changed on disk. Reload…", name=path.name),
                tip,
                lambda: self.ask(changed),
            )

        files.jobs.start("project file", lambda _: find_file_change(path, digest), done, quick=True)

    def ask(self, changed: FileChangedError) -> None:
        """Ask what to do with both, because the project file is not the one that was read."""
        from app.project.questions import ask_changed

        document, files = self.document, self.files
        era, dirty = self._era, document.dirty
        answer = ask_changed(files.window, changed, document.common, document.project, dirty)
        theirs, digest = changed.theirs, changed.digest
        if era != self._era:
            return
        if answer == "save as":
            files.save_as()
        elif answer == "anyway":
            files.saver.save(anyway=True)
        elif theirs is not None and digest is not None:
            if answer == "reload":
                self._reload(changed, theirs, digest)
            elif answer == "merge" and document.common is not None:
                self._merge(changed, document.common, theirs, digest)

    def _start(self, changed: FileChangedError, work: Callable[[WindowJob], object], done: Callable) -> None:
        title = tr("Reloading {name}", name=changed.path.name)
        self.files.jobs.start(title, work, done, self.files.show_failure)

    def _reload(self, changed: FileChangedError, theirs: Project, digest: str) -> None:
        era = self._era

        def done(opened: Opened) -> None:
            if era == self._era:
                self.document.reload(opened.project, digest)
                self.files.told.emit(tr("Reloaded {name}", name=changed.path.name))

        self._start(changed, lambda job: load_whole(theirs, changed.path.parent, job.tell), done)

    def _merge(self, changed: FileChangedError, common: Project, theirs: Project, digest: str) -> None:
        from metagraph.formats.project.merging import MergeError, merge_projects

        era, mine = self._era, self.document.project

        def work(job: WindowJob) -> Merging | MergeError:
            try:
                merged = merge_projects(common, mine, theirs)
            except MergeError as error:
                return error
            project = with_motion_of(merged.project, mine)
            return load_whole(project, changed.path.parent, job.tell), merged.kept

        def done(found: Merging | MergeError) -> None:
            if era != self._era:
                return
            if isinstance(found, MergeError):
                words = tr(
                    "The two versions cannot be merged: {found}. Save yours under another name instead.",
                    found=found,
                )
                QMessageBox.warning(self.files.window, tr("Not merged"), words)
            elif self.document.project is not mine:
                self.ask(changed)  # it was edited in the meantime
            else:
                opened, kept = found
                self.document.merge(opened.project, theirs, digest)
                self.files.told.emit(
                    tr("Merged with {name}. Saving writes both versions.", name=changed.path.name)
                )
                if kept:
                    self.files.report.emit(
                        tr("Merged. Your version was kept where both had changed the same thing."), list(kept)
                    )

        self._start(changed, work, done)
