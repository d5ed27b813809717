"""Opening, saving, importing and recovering, with the questions they ask. The window's right hand; it draws nothing."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QFileDialog, QMessageBox, QWidget

from app.features.graph.graph_drops import Drop
from app.features.retargeting.import_retargeting import Retargeting
from app.look.plural import clips_words
from app.project.document import Document, state_folder, untitled_journal
from app.project.jobs import Job, Jobs
from app.project.kept_maps import kept_maps
from app.project.load import ANNOTATIONS, Load
from app.project.opening import load_whole, open_whole
from app.project.speech_files import converses, kinds_of
from metagraph.errors import FileError
from metagraph.formats.imports import Imported, import_files
from metagraph.formats.journal import journal_path, recover
from metagraph.formats.repairs import repairs_of
from metagraph.formats.store import SUFFIX, Opened, absolute
from metagraph.formats.takes import NAME
from metagraph.graph.model import Project

RECENT = 10
FILTER = f"Metagraph projects (*{SUFFIX} *.yaml);;All files (*)"
CLIPS = "Clips (*.bvh *.glb *.gltf *.vrm *.vrma *.fbx);;All files (*)"
SAMPLE = Path(__file__).resolve().parents[2] / "sample_clips" / f"sample{SUFFIX}"
PRACTICE = Path(__file__).resolve().parents[2] / "sample_clips" / f"practice{SUFFIX}"


class Files(QObject):
    """told: words for the status bar. report: (title, lines) to read. imported: (Imported, Drop or None). opened: a project is shown.
    conversation_dropped, lines_dropped: the paths of sounds, and of transcripts, that were dropped.
    annotation_dropped: the path of an annotation among files to import. repaired: (title, ids of clips, lines) to look
    through; the lines say what else is to be read. noticed: the same, with nothing that has to be read."""

    told = Signal(str)
    report = Signal(str, object)
    imported = Signal(object, object)
    opened = Signal()
    annotation_dropped = Signal(str)
    conversation_dropped = Signal(object)
    lines_dropped = Signal(object)
    repaired = Signal(str, object, object)
    noticed = Signal(str, object, object)

    def __init__(self, document: Document, jobs: Jobs, window: QWidget) -> None:
        super().__init__(window)
        self.document, self.jobs, self.window = document, jobs, window
        self.retargeting = Retargeting(document, jobs, window)
        self.retargeting.told.connect(self.told)
        self.retargeting.failed.connect(self._failed)
        self.closed = ""  # why no other project or clip may be brought in now, in words
        self._era = 0  # counts the projects that were shown
        document.loaded.connect(self._next_era)

    def _next_era(self) -> None:
        self._era += 1

    def _refuse(self) -> bool:
        if self.closed:
            self.told.emit(self.closed)
        return bool(self.closed)

    # --- new and open

    def new(self) -> None:
        if self._refuse():
            return
        if self.may_leave():
            self.document.load(Project(), None)
            self.opened.emit()

    def ask_open(self) -> None:
        if self._refuse():
            return
        name, _ = QFileDialog.getOpenFileName(self.window, "Open project", str(self.document.folder or Path.home()), FILTER)
        if name:
            self.open(Path(name))

    def open(self, path: Path, template: bool = False) -> None:
        """Open a project; its clips load on a thread. Asks about unsaved changes and about a journal that was left behind.

        template: a copy without a file is opened; saving asks for a place of one's own.
        """
        if self._refuse():
            return
        if not self.may_leave():
            return
        recovered = None if template else self._offer(journal_path(path), path)
        left = self.document.project

        def work(job: Job) -> Opened:
            if recovered is not None:
                return load_whole(recovered, path.parent, job.tell)
            return open_whole(path, job.tell)

        def done(opened: Opened) -> None:
            if self.document.project is not left and not self.may_leave():
                return  # it was edited meanwhile
            if template:
                self.document.load(absolute(opened.project, path.parent), None)
            else:
                self.document.load(opened.project, path, recovered is not None)
                self._remember(path)
            self.opened.emit()
            if opened.notes:
                self.report.emit(f"{path.name} was opened, but", list(opened.notes))

        self.jobs.start(f"Opening {path.name}", work, done, self._failed)

    def recover_untitled(self) -> bool:
        """Offer what was never saved before a crash; return whether it is being opened."""
        project = self._offer(untitled_journal(), None)
        if project is None:
            return False

        def done(opened: Opened) -> None:
            self.document.load(opened.project, None, recovered=True)
            self.opened.emit()

        self.jobs.start("Recovering", lambda job: load_whole(project, Path("/"), job.tell), done, self._failed)
        return True

    def _offer(self, journal: Path, saved: Path | None) -> Project | None:
        """Ask whether to take over a journal's edits; None when there are none or they are not wanted."""
        try:
            found = recover(journal, saved)
        except FileError as error:
            kept = journal.with_suffix(".old")
            journal.replace(kept)
            self.told.emit(f"{error} ({kept.name})")
            return None
        if found is None:
            return None
        project, count = found
        name = saved.name if saved is not None else "A project that was never saved"
        edits = f"{count} edit{'s' if count != 1 else ''}"
        answer = QMessageBox.question(
            self.window,
            "Recover edits?",
            f"{name} was not closed properly. {edits.capitalize()} since the last save can be recovered.",
            QMessageBox.StandardButton.Yes | QMessageBox.StandardButton.Discard,
            QMessageBox.StandardButton.Yes,
        )
        return project if answer == QMessageBox.StandardButton.Yes else None

    def _failed(self, error: Exception) -> None:
        if not isinstance(error, FileError):
            for note in getattr(error, "__notes__", ()):
                print(note)
        QMessageBox.warning(self.window, "Metagraph", str(error))

    # --- save

    def save(self) -> bool:
        if self.document.path is None:
            return self.save_as()
        return self._save(None)

    def save_as(self) -> bool:
        start = self.document.folder or Path.home()
        name, _ = QFileDialog.getSaveFileName(self.window, "Save project as", str(start / f"{self.document.project.name}{SUFFIX}"), FILTER)
        if not name:
            return False
        path = Path(name)
        return self._save(path if path.suffix in (".yaml", ".yml") else path.with_name(path.name + SUFFIX))

    def _save(self, path: Path | None) -> bool:
        try:
            self.document.save(path)
        except FileError as error:
            QMessageBox.warning(self.window, "Not saved", str(error))
            return False
        assert self.document.path is not None
        self._remember(self.document.path)
        self.told.emit(f"Saved {self.document.path.name}")
        return True

    def may_leave(self) -> bool:
        """Return whether the project may be left: nothing unsaved, or saved or discarded when asked."""
        if not self.document.dirty:
            return True
        box = QMessageBox.StandardButton
        answer = QMessageBox.question(
            self.window,
            "Save changes?",
            f"'{self.document.project.name}' has changes that are not saved.",
            box.Save | box.Discard | box.Cancel,
            box.Save,
        )
        return self.save() if answer == box.Save else answer == box.Discard

    # --- import

    def ask_import_folder(self) -> None:
        if self._refuse():
            return
        name = QFileDialog.getExistingDirectory(self.window, "Import a folder of clips", str(self.document.folder or Path.home()))
        if name:
            self.import_paths([name])

    def ask_import_files(self) -> None:
        if self._refuse():
            return
        names, _ = QFileDialog.getOpenFileNames(self.window, "Import clips", str(self.document.folder or Path.home()), CLIPS)
        if names:
            self.import_paths(names)

    def import_paths(self, paths: list[str], drop: Drop | None = None) -> None:
        """Import files and folders on a thread; one undo step when it is done. drop: where to place them then."""
        if self._refuse():
            return
        annotations = [path for path in paths if path.lower().endswith(ANNOTATIONS)]
        paths = [path for path in paths if path not in annotations]
        for path in annotations[:1]:  # one dialog is enough
            self.annotation_dropped.emit(path)
        if not paths:
            return
        project, folder, era = self.document.project, self.document.folder, self._era

        def done(result: Imported) -> None:
            if era == self._era:
                self._imported(result, drop)
            else:
                self.told.emit("The import was dropped, since another project was opened.")

        maps = kept_maps()

        def work(job: Job) -> Imported:
            tell = lambda n, total, path: job.tell(n, total, path.name)  # noqa: E731
            remembered = lambda source, target: maps.get((source, target))  # noqa: E731
            return import_files(project, folder, paths, tell, lambda: job.cancelled, "ask", remembered)

        self.jobs.start("Importing clips", work, done, self._failed)

    def import_sounds(self, paths: Sequence[Path]) -> None:
        """Ask what two in conversation say in sounds, or take each for a line of dialogue."""
        if self._refuse():
            return
        if converses(paths):
            self.conversation_dropped.emit(tuple(paths))
        else:
            self.lines_dropped.emit(list(kinds_of(paths)[0]))

    def _imported(self, result: Imported, drop: Drop | None) -> None:
        count = len(result.loaded)
        if count:
            self.document.edit(f"Import {clips_words(count)}", result.into)
        self.imported.emit(result, drop)
        if not result.strangers:
            self._tell_imported(result)
            return
        parts, groups = [replace(result, strangers=())], len(result.strangers)

        def then(brought: Imported) -> None:
            if brought.loaded:
                self.document.edit(f"Retarget {clips_words(len(brought.loaded))}", brought.into)
                self.imported.emit(brought, drop)
            parts.append(brought)
            if len(parts) > groups:
                self._tell_imported(_together(parts))

        self.retargeting.ask(result.strangers, then)

    def _tell_imported(self, result: Imported) -> None:
        """Say what came of an import: in the status bar, or to read where something was left out or repaired."""
        count, files = len(result.loaded), len(result.failures)
        words = f"Imported {clips_words(count)}"
        if result.retargeted:
            words += f", {result.retargeted} of them retargeted"
        if result.left:
            out = f"left out {clips_words(result.left)} of another skeleton"
            words = f"{words}, {out}" if count else out.capitalize()
        clips = self.load_for(result).clips
        repairs = repairs_of(self.document.project, clips)
        if any(found.repair.name != NAME for found in repairs):  # a name is plain to see, and no reason to interrupt
            told = {found.repair.words for found in repairs}
            notes = [note for note in result.notes if note.split(": ", 1)[-1] not in told]
            (self.repaired if files else self.noticed).emit(words, clips, [*result.failures, *notes])
            self.told.emit(words)
        elif files:
            self.report.emit(f"{words}; {files} file{'s' if files != 1 else ''} could not be read", [*result.failures, *result.notes])
        elif not count and not result.left:
            self.report.emit("Nothing was imported", ["No clip was found there. Clips are BVH, GLB, glTF, VRM animation or FBX files."])
        else:
            before = [note for note in result.notes if note.endswith("retargeted as before")]
            more = [note for note in result.notes if note not in before]
            words = ". ".join([words, *before])
            self.told.emit(words + (f" ({len(more)} note{'s' if len(more) != 1 else ''}, see the tooltips)" if more else ""))

    def load_for(self, result: Imported) -> Load:
        """Return the imported clips as something that can be dropped."""
        known = {(e.path, e.take): e.id for e in self.document.project.clips.values()}
        return Load(clips=tuple(known[(path, take)] for path, take, _, _ in result.loaded if (path, take) in known))

    def find_missing(self) -> None:
        """Ask where missing clip files are now, and load them from there."""
        project, era = self.document.project, self._era
        missing = [e for e in project.clips.values() if e.motion is None]
        if not missing:
            self.told.emit("No clip file is missing.")
            return
        name = QFileDialog.getExistingDirectory(
            self.window, f"Where are the {len(missing)} missing clips?", str(self.document.folder or Path.home())
        )
        if not name:
            return
        folder = Path(name)

        def work(job: Job) -> Project:
            from metagraph.formats.store import relocate

            return relocate(project, self.document.folder, folder, job.tell)

        def done(found: Project) -> None:
            if era != self._era:
                return
            before = {i for i, e in self.document.project.clips.items() if e.motion is None}
            self.document.edit("Find missing clips", lambda p: _take_over(p, found))
            left = sum(1 for i in before if self.document.project.clips[i].motion is None)
            self.told.emit(f"Found {len(before) - left} of {len(before)} missing clips.")

        self.jobs.start("Looking for clips", work, done, self._failed)

    # --- recent

    def recent(self) -> list[Path]:
        """Return the recent projects that still exist, the latest first."""
        try:
            names = json.loads((state_folder() / "recent.json").read_text(encoding="utf-8"))
            return [Path(n) for n in names if isinstance(n, str) and Path(n).is_file()]
        except (OSError, ValueError, TypeError):
            return []

    def _remember(self, path: Path) -> None:
        names = [str(path.resolve()), *(str(p) for p in self.recent() if p != path.resolve())]
        try:
            (state_folder() / "recent.json").write_text(json.dumps(names[:RECENT]), encoding="utf-8")
        except OSError:
            self.told.emit("The list of recent projects could not be written.")


def _together(parts: Sequence[Imported]) -> Imported:
    """Return several imports as one."""
    return replace(
        parts[0],
        loaded=tuple(x for part in parts for x in part.loaded),
        failures=tuple(x for part in parts for x in part.failures),
        notes=tuple(x for part in parts for x in part.notes),
        retargeted=sum(part.retargeted for part in parts),
        left=sum(part.left for part in parts),
    )


def _take_over(project: Project, found: Project) -> Project:
    """Return `project` with the clips that have motion in `found` and none here."""
    clips = {i: found.clips[i] if e.motion is None and i in found.clips else e for i, e in project.clips.items()}
    return replace(project, clips=clips)
