"""Clips of other skeletons after an import: asked about once a skeleton, then retargeted on a thread, one
step to undo.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QWidget

from app.look.plural import count_clips
from app.project.document import Document
from app.project.jobs import Jobs, WindowJob
from app.project.kept_maps import keep_map
from app.translation import tr
from metagraph.errors import FileError
from metagraph.formats.imports import Imported, Strangers, bring_over, find_strangers
from metagraph.graph.editing.retargeting import Bringing
from metagraph.motion.joint_map import JointMap

if TYPE_CHECKING:
    from app.features.retargeting.joint_map_dialog import JointMapDialog

Then = Callable[[Imported], None]


class Retargeting(QObject):
    """told: words for the status bar. failed: an exception."""

    told = Signal(str)
    failed = Signal(object)

    def __init__(self, document: Document, jobs: Jobs, window: QWidget) -> None:
        super().__init__(window)
        self.document, self.jobs, self.window = document, jobs, window
        self._waiting: list[tuple[Strangers, Then]] = []
        self._sure: list[tuple[Strangers, Then]] = []  # those that are not asked about any more
        document.loaded.connect(self._forget)
        self._asking = False

    def _forget(self) -> None:
        self._waiting.clear()  # they were of another project
        self._sure.clear()

    def ask(self, groups: Iterable[Strangers], then: Then) -> None:
        """Ask about each group; `then` is called with what came of each, an empty import for those left
        out.
        """
        self._waiting += [(group, then) for group in groups]
        if not self._asking:
            self._next()

    def bring(self, groups: Iterable[Strangers], then: Then) -> None:
        """Retarget each group by the joint map that is offered for it, unasked; `then` as of `ask`."""
        for group in groups:
            self._bring(group, group.joint_map, then)

    def change_maps(self, clips: Iterable[str]) -> None:
        """Let the joint maps be corrected by which clips of the project were retargeted, those of `clips` or
        all.
        """
        project, folder, chosen = self.document.project, self.document.folder, tuple(clips)

        def then(result: Imported) -> None:
            if result.loaded:
                self.document.edit(tr("Change joint map"), result.into)
                self.told.emit(tr("Retargeted {loaded} again.", loaded=count_clips(len(result.loaded))))

        def done(groups: tuple[Strangers, ...]) -> None:
            if not groups:
                self.told.emit(tr("This project has no retargeted clips."))
            elif self.document.project is project:
                self.ask(groups, then)

        self.jobs.start(
            tr("Reading retargeted clips"),
            lambda _: find_strangers(project, folder, chosen),
            done,
            self.failed.emit,
        )

    def _next(self) -> None:
        if self._sure:
            group, then = self._sure.pop(0)
            self._asking = True
            self._bring(group, group.joint_map, then)
            return
        if not self._waiting:
            return
        from app.features.retargeting.joint_map_dialog import JointMapDialog

        group, then = self._waiting.pop(0)
        if self.document.project.skeleton is None:
            told = replace(group, told=group.failures)
            self._end(lambda: then(Imported((), group.failures, apart=(told,))))
            return
        self._asking = True
        whole = [other for other, _ in self._waiting if not other.joint_map.missing]
        dialog = JointMapDialog(
            group,
            Bringing(self.document.project),
            self.jobs,
            self.window,
            sum(len(other.clips) for other in whole),
        )
        dialog.accepted.connect(lambda: self._accept(dialog, group, then))
        dialog.rejected.connect(lambda: self._leave(group, then))
        dialog.open()

    def _accept(self, dialog: JointMapDialog, group: Strangers, then: Then) -> None:
        """Retarget a group by the dialog's map, and if all were chosen, those that wait by theirs, one after
        another.
        """
        waiting, self._waiting = self._waiting, []
        for pair in waiting:
            whole = dialog.all_chosen and not pair[0].joint_map.missing
            (self._sure if whole else self._waiting).append(pair)
        self._bring(group, dialog.map, then)

    def _leave(self, group: Strangers, then: Then) -> None:
        self._end(lambda: then(Imported((), apart=(group,))))

    def _bring(self, group: Strangers, joint_map: JointMap, then: Then) -> None:
        bringing = Bringing(self.document.project)
        source = self.document.path
        try:
            keep_map(joint_map)
        except (FileError, OSError) as error:
            self.told.emit(tr("The joint map could only be saved in this project ({error}).", error=error))

        def done(result: Imported) -> None:
            if (
                self.document.path != source
                or self.document.project.skeleton is not bringing.project.skeleton
            ):
                result = replace(result, loaded=(), joint_maps={}, retargeted=0)
                self.told.emit(tr("The clips were not retargeted because another project was opened."))
            self._end(lambda: then(result))

        def failed(error: Exception) -> None:
            self.failed.emit(error)
            self._end(lambda: then(Imported(())))

        self.jobs.start(
            tr("Retargeting {clips}", clips=count_clips(len(group.clips))),
            lambda job: self._work(job, bringing, group, joint_map),
            done,
            failed,
        )

    @staticmethod
    def _work(job: WindowJob, bringing: Bringing, group: Strangers, joint_map: JointMap) -> Imported:
        return bring_over(bringing, group, joint_map, job.tell, lambda: job.cancelled)

    def _end(self, then: Callable[[], None]) -> None:
        self._asking = False
        then()
        self._next()
