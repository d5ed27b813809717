"""Import clips: files and folders that are chosen or dropped, and clip files that were lost and found."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QFileDialog, QWidget

from app.look.plural import count_clips
from app.project.document import Document
from app.project.files import Files
from app.project.jobs import Jobs, WindowJob
from app.project.kept_maps import read_joint_maps
from app.project.load import Load
from app.project.opening import take_over
from app.translation import tr, tr_phrase
from metagraph.common.studio import find_start_folder
from metagraph.common.wording import Phrase
from metagraph.formats.clip_readers import describe_clip_files, list_clip_suffixes
from metagraph.formats.import_words import Remedy, count_alike, describe_import, describe_imported
from metagraph.formats.imports import BY_KNOWN_MAP, Imported, Strangers, import_files
from metagraph.formats.project.clip_loading import Opened, load_returned
from metagraph.formats.repairs import list_repairs
from metagraph.formats.takes import NAME
from metagraph.graph.model import Project

Retarget = Callable[[Sequence[Strangers], Callable[[Imported], None]], None]


def _filter() -> str:
    return tr("Clips ({endings});;All files (*)", endings=" ".join(f"*{x}" for x in list_clip_suffixes()))


@dataclass(frozen=True)
class FileDrop:
    """Files that are not clips, and the object that takes them when they are dropped or imported.

    `suffixes` are the ends of their names, in lower case. `claim` returns those that really belong to it, and
    `take` handles them.
    """

    suffixes: tuple[str, ...]
    claim: Callable[[Sequence[Path]], Sequence[Path]]
    take: Callable[[Sequence[Path]], object]


class Importing(QObject):
    """Imports clips.

    `told` has words for the status bar, `report` (title, lines) to read. `begun` is emitted when files are
    being read. `imported` has an Imported, and the drop that says where to place it. `ended` has an Imported,
    once no more questions are asked about it. `noticed` has (title, ids of clips, lines) for clips that were
    repaired; the lines are further notes. `drops` take what is not a clip. `retarget` asks about clips of
    other skeletons; without it they are left out. `bring` retargets them without asking. `guided`: whether
    something else tells the user already what to do after an import.
    """

    told = Signal(str)
    report = Signal(str, object)
    begun = Signal()
    imported = Signal(object, object)
    ended = Signal(object)
    noticed = Signal(str, object, object)

    def __init__(self, document: Document, jobs: Jobs, files: Files, widget: QWidget) -> None:
        super().__init__(widget)
        self.document, self.jobs, self.files, self.widget = document, jobs, files, widget
        self.drops: tuple[FileDrop, ...] = ()
        self.retarget: Retarget | None = None
        self.bring: Retarget | None = None
        self.guided = False
        self._era = 0  # counts the projects that were shown
        document.loaded.connect(self._next_era)

    def _next_era(self) -> None:
        self._era += 1

    def takes(self, paths: Sequence[Path]) -> bool:
        """Return whether files may be usable, by their names."""
        ends = (*list_clip_suffixes(), *(suffix for drop in self.drops for suffix in drop.suffixes))
        return any(not path.suffix or path.name.lower().endswith(ends) for path in paths)

    def ask_import_folder(self) -> None:
        if self.files.refuse():
            return
        name = QFileDialog.getExistingDirectory(
            self.widget, tr("Import a folder of clips"), str(find_start_folder(self.document.folder))
        )
        if name:
            self.import_paths([name])

    def ask_import_files(self) -> None:
        if self.files.refuse():
            return
        names, _ = QFileDialog.getOpenFileNames(
            self.widget, tr("Import clips"), str(find_start_folder(self.document.folder)), _filter()
        )
        if names:
            self.import_paths(names)

    def import_paths(self, paths: list[str], drop: object = None) -> None:
        """Import files and folders on a thread, as one undo step. `drop` says where to place them."""
        if self.files.refuse():
            return
        for taker in self.drops:
            claimed = taker.claim([Path(p) for p in paths])
            if claimed:
                taker.take(claimed)
                paths = [p for p in paths if Path(p) not in claimed]
        if not paths:
            return
        project, folder, era = self.document.project, self.document.folder, self._era

        def done(result: Imported) -> None:
            if era == self._era:
                self._imported(result, drop)
            else:
                self.told.emit(tr("The import was discarded because another project was opened."))

        maps = read_joint_maps()

        def work(job: WindowJob) -> Imported:
            tell = lambda n, total, path: job.tell(n, total, path.name)  # noqa: E731
            remembered = lambda source, target: maps.get((source, target))  # noqa: E731
            return import_files(project, folder, paths, tell, lambda: job.cancelled, "ask", remembered)

        self.begun.emit()
        self.jobs.start(tr("Importing clips"), work, done, self.files.show_failure)

    def _imported(self, result: Imported, drop: object) -> None:
        count = len(result.loaded)
        if count:
            self.document.edit(tr("Import {clips}", clips=count_clips(count)), result.into)
        elif result.chosen:
            self.document.edit(tr("Choose character"), result.into)
        self.imported.emit(result, drop)
        if not result.strangers or self.retarget is None:
            self._tell_imported(result)
        else:
            self._collect(self.retarget, result.strangers, replace(result, strangers=()), drop)

    def _collect(
        self, retarget: Retarget, strangers: Sequence[Strangers], result: Imported, drop: object
    ) -> None:
        """Retarget strangers, and report all of them together with `result` at the end."""
        parts, groups = [result], len(strangers)

        def then(brought: Imported) -> None:
            if brought.loaded:
                self.document.edit(
                    tr("Retarget {clips}", clips=count_clips(len(brought.loaded))), brought.into
                )
                self.imported.emit(brought, drop)
            parts.append(brought)
            if len(parts) > groups:
                self._tell_imported(_together(parts))

        retarget(strangers, then)

    def remedy(self, result: Imported, remedy: Remedy) -> None:
        """Do what an import's report offers for clips of other skeletons."""
        retarget = self.bring if remedy.do == "retarget" else self.retarget
        if retarget is None or self.files.refuse():
            return
        told = {line for group in remedy.strangers for line in group.told}
        rest = replace(
            result,
            apart=tuple(group for group in result.apart if group not in remedy.strangers),
            failures=tuple(line for line in result.failures if line not in told),
        )
        self._collect(retarget, remedy.strangers, rest, None)

    def _tell_imported(self, result: Imported) -> None:
        """Report the result of an import."""
        if not result.loaded and not result.apart and not result.failures and not result.chosen:
            self.report.emit(
                tr("Nothing was imported"),
                [f"{tr('No clips were found there.')} {tr_phrase(describe_clip_files())}"],
            )
            return
        known = [note for note in result.notes if isinstance(note, Phrase) and note.template == BY_KNOWN_MAP]
        self.told.emit(". ".join(map(tr_phrase, [describe_import(result), *known])))
        clips = self.load_for(result).clips
        repairs = list_repairs(self.document.project, clips)
        if any(
            found.repair.name != NAME for found in repairs
        ):  # a changed name is visible, and no reason to interrupt
            told = {found.repair.words for found in repairs}
            notes = [note for note in result.notes if note.split(": ", 1)[-1] not in told]
            lines = [tr_phrase(line) for line in count_alike([*result.failures, *notes])]
            self.noticed.emit(tr_phrase(describe_imported(result)), clips, lines)
        self.ended.emit(result)

    def load_for(self, result: Imported) -> Load:
        """Return the imported clips as something that can be dropped."""
        known = {(e.path, e.take): e.id for e in self.document.project.clips.values()}
        return Load(
            clips=tuple(known[(path, take)] for path, take, _, _ in result.loaded if (path, take) in known)
        )

    def find_missing(self) -> None:
        """Load clip files that were missing and are back; ask where the others are now, and load them from
        there.
        """
        project, era, folder = self.document.project, self._era, self.document.folder
        count = sum(1 for e in project.clips.values() if e.motion is None)
        if not count:
            self.told.emit(tr("No clip file is missing."))
            return

        def done(back: Opened) -> None:
            if era != self._era:
                return
            self.document.take_motion(tr("Read restored clips"), lambda p: take_over(p, back.project))
            if any(e.motion is None for e in self.document.project.clips.values()):
                self._ask_for_missing(count)
            else:
                self.told.emit(tr("Found {found} of {count} missing clips.", found=count, count=count))

        self.jobs.start(
            tr("Looking for clips"),
            lambda job: load_returned(project, folder, job.tell),
            done,
            self.files.show_failure,
        )

    def _ask_for_missing(self, count: int) -> None:
        """Ask for missing files. `count` is how many were missing before some were found in their places."""
        project, era = self.document.project, self._era
        missing = [e for e in project.clips.values() if e.motion is None]
        name = QFileDialog.getExistingDirectory(
            self.widget,
            tr("Locate {missing} missing clips", missing=len(missing)),
            str(find_start_folder(self.document.folder)),
        )
        if not name:
            return
        folder = Path(name)

        def work(job: WindowJob) -> Project:
            from metagraph.formats.project.clip_loading import relocate

            return relocate(project, self.document.folder, folder, job.tell)

        def done(found: Project) -> None:
            if era != self._era:
                return
            self.document.take_motion(tr("Find missing clips"), lambda p: take_over(p, found))
            left = sum(1 for e in self.document.project.clips.values() if e.motion is None)
            self.told.emit(tr("Found {found} of {count} missing clips.", found=count - left, count=count))

        self.jobs.start(tr("Looking for clips"), work, done, self.files.show_failure)


def _together(parts: Sequence[Imported]) -> Imported:
    """Return several imports as one."""
    return replace(
        parts[0],
        loaded=tuple(x for part in parts for x in part.loaded),
        failures=tuple(x for part in parts for x in part.failures),
        notes=tuple(x for part in parts for x in part.notes),
        retargeted=sum(part.retargeted for part in parts),
        apart=tuple(x for part in parts for x in part.apart),
    )
