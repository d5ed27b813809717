"""Offer unsaved work after a crash, wherever it is: one sitting can be recovered, the others kept or
discarded.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from PySide6.QtCore import QObject

from app.project.document import ProjectPast
from app.project.files_host import FilesHost
from app.project.leftovers import (
    FoundJournal,
    list_known_journals,
    list_untitled_journals,
    read_untitled,
    remove_journal,
)
from app.project.opening import load_recovered
from app.translation import tr, tr_plural
from metagraph.formats.project.clip_loading import Opened
from metagraph.formats.project.history import UndoStep
from metagraph.formats.project.journal_search import project_of
from metagraph.formats.project.paths import make_paths_absolute
from metagraph.formats.recovery import Left


class Unsaved(QObject):
    """The part of a window's files that is only in journals."""

    def __init__(self, files: FilesHost) -> None:
        super().__init__(files.window)
        self.files = files

    def offer(self, otherwise: Callable[[], object] | None = None) -> None:
        """Offer what opening a project would not offer. If there is nothing, or nothing is recovered, call
        `otherwise` or say so.
        """
        journals = list_untitled_journals()
        if not journals:
            self._nothing(otherwise)
            return
        self._read(lambda: journals, otherwise)

    def offer_all(self) -> None:
        """Offer every journal, wherever it is."""
        recent = self.files.recent()
        path = self.files.document.path
        self._read(lambda: list_known_journals([*recent, path] if path is not None else recent), None)

    def _read(self, journals: Callable[[], Sequence[Path]], otherwise: Callable[[], object] | None) -> None:
        files = self.files
        files.jobs.start(
            tr("Recovering"),
            lambda _: read_untitled(journals()),
            lambda found: self._offer(found, otherwise),
            files.show_failure,
        )

    def tell(self) -> None:
        """Say in the status bar that there are some, when a project is opened by its name."""
        count = len(list_untitled_journals())
        if count:
            words = tr_plural(
                "{count:,} unsaved project can be recovered. Review…",
                "{count:,} unsaved projects can be recovered. Review…",
                count,
            )
            tip = tr("Unsaved work from windows that were not closed properly")
            self.files.noticed.emit(words, tip, self.offer)

    def _nothing(self, otherwise: Callable[[], object] | None) -> None:
        if otherwise is not None:
            otherwise()
        else:
            self.files.told.emit(tr("There is nothing to recover."))

    def _offer(self, found: FoundJournal, otherwise: Callable[[], object] | None) -> None:
        files = self.files
        if found.notes and not found.left:
            files.report.emit(tr("Unrecoverable edits were kept"), list(found.notes))
        if not found.left:
            self._nothing(otherwise)
            return
        from app.project.recovering import ask_recover

        choices = ask_recover(files.window, found, None) or ("later",) * len(found.left)
        chosen: Left | None = None
        for left, choice in zip(found.left, choices, strict=True):
            if choice == "recover":
                chosen = left
            elif choice == "discard":
                remove_journal(left.path, discard=True)
        kept = sum(choice == "later" for choice in choices)
        if kept:
            files.told.emit(
                tr_plural(
                    "Kept {count:,} project for later: File > Recover offers it again.",
                    "Kept {count:,} projects for later: File > Recover offers them again.",
                    kept,
                )
            )
        if chosen is None:
            if otherwise is not None:
                otherwise()
        elif files.may_leave():
            self._take_over(chosen)

    def _take_over(self, left: Left) -> None:
        """Continue with a sitting, in its project file's place if that still has a folder."""
        files = self.files
        document, before = files.document, files.document.project
        saved = project_of(left.path)
        if saved is not None and saved.parent.is_dir():
            files.go_on(left, saved)
            return
        folder = saved.parent if saved is not None else Path("/")

        def done(result: tuple[Opened, tuple[UndoStep, ...]]) -> None:
            if document.project is not before and not files.may_leave():
                return  # it is offered again another time
            opened, steps = result
            if saved is not None:  # its folder is gone, so it becomes a project that was never saved
                steps = ()
            project = opened.project if saved is None else make_paths_absolute(opened.project, folder)
            document.load(project, None, ProjectPast(steps=steps, lost=count_lost_steps(left, steps)))
            if document.secured():
                remove_journal(left.path)
            files.opened.emit()
            files.tell_lost(left)
            if opened.notes:
                files.report.emit(tr("Recovered, with warnings"), list(opened.notes))

        files.jobs.start(
            tr("Recovering"), lambda job: load_recovered(left, folder, job.tell), done, files.show_failure
        )


def count_lost_steps(left: Left, steps: Sequence[UndoStep]) -> int:
    """Return how many of a journal's edits are unsaved and can no longer be undone one by one."""
    return left.unsaved if steps else left.edits
