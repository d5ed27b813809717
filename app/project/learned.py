"""Keep what was learned from the user between projects, in the program's data folder; one memory for all
windows of all running programs.

There are two files of one format, `metagraph.suggest.memory`: words and corrections, small and written at
once; labelled clips of projects, large and written by a job. Every change reads the file again under a lock,
is applied, and writes the whole file, so that nothing another window learned is lost. A file that cannot be
read is renamed, never overwritten.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from functools import reduce
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QLockFile, QObject, QSettings, Signal

from app.project.autosave import state_folder
from app.project.document import Document
from app.translation import tr
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically

if TYPE_CHECKING:  # arrays and word lists are imported when something is first learned or needed
    from app.project.jobs import Jobs
    from metagraph.graph.model import Project
    from metagraph.suggest.alike import LabelledExample
    from metagraph.suggest.memory import Memory
    from metagraph.suggest.words.patterns import Patterns

WORDS = "learned-words.json"
CLIPS = "learned-clips.json"
LOCK_WAIT = 2000  # milliseconds another window may take to write


class Learned(QObject):
    """What the user taught. `changed` is emitted if something was learned, forgotten or edited here, `failed`
    with words if it could not be kept.
    """

    changed = Signal()
    failed = Signal(str)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._read: dict[
            str, tuple[tuple[int, int], Memory]
        ] = {}  # file -> its state when it was read, its content
        self.paused = False  # nothing is learned from the participants of a study, nor used for them
        self._due = 0  # saved projects whose job is not done yet

    # --- whether

    @property
    def on(self) -> bool:
        """Return whether corrections and labelled clips are remembered and used. Patterns that the user wrote
        are always used.
        """
        return not self.paused and str(QSettings().value("learn", "true")) == "true"

    def set_on(self, on: bool) -> None:
        QSettings().setValue("learn", "true" if on else "false")
        self.changed.emit()

    # --- what is known

    @property
    def patterns(self) -> Patterns:
        """Return what words in names mean, without what was learned from corrections while learning
        is off.
        """
        from metagraph.suggest.words.patterns import forget_learned

        return self.every_pattern if self.on else forget_learned(self.every_pattern)

    @property
    def every_pattern(self) -> Patterns:
        """Return everything known of words, used or not."""
        return self._memory(WORDS).patterns

    def examples_for(self, document: Document) -> list[LabelledExample]:
        """Return labelled clips of the user's other projects. This may read a file of some MB, so call it in
        a job.
        """
        return self.examples_beside(document.path)

    def examples_beside(self, path: Path | None) -> list[LabelledExample]:
        """Return labelled clips of all projects except the one saved at a path."""
        return self._memory(CLIPS).others(_key(path)) if self.on else []

    @property
    def clips(self) -> int:
        """Return how many labelled clips are remembered."""
        return sum(map(len, self._memory(CLIPS).examples.values()))

    # --- learning

    def correct(self, name: str, field: str, value: str | Sequence[str], names: Sequence[str] = ()) -> None:
        """Remember that a clip of this name was corrected; see `Memory.corrected`. Nothing happens while
        learning is off.
        """
        self.correct_all([(name, field, value)], names)

    def correct_all(
        self, corrections: Sequence[tuple[str, str, str | Sequence[str]]], names: Sequence[str] = ()
    ) -> None:
        """Remember several corrections, each the name of a clip, a field and its value, in one write."""
        if self.on and corrections:
            self._change(
                WORDS, lambda m: reduce(lambda kept, one: kept.corrected(*one, names), corrections, m)
            )

    def keep(self, document: Document, jobs: Jobs | None = None) -> None:
        """Remember a saved project's labelled clips, in a job. Without `jobs`, on closing, what a job was not
        done with is remembered at once, but only with motion that was measured before. A project with unsaved
        changes or without a file is not remembered.
        """
        if not self.on or document.path is None or document.dirty:
            return
        project, key = document.project, make_memory_key(document)
        if jobs is not None:
            self._due += 1
            jobs.start(
                "learning", lambda _: self._keep(project, key), self._kept, lambda _: self._kept(), quick=True
            )
        elif self._due:
            self._keep(project, key, wait=False)

    def _kept(self, _: object = None) -> None:
        self._due -= 1

    def _keep(self, project: Project, key: str, wait: bool = True) -> None:
        from metagraph.suggest.propose import list_examples
        from metagraph.suggest.traits import list_known_traits, measure_all_traits

        examples = list_examples(project, measure_all_traits(project) if wait else list_known_traits(project))
        self._change(CLIPS, lambda m: m.with_project(key, examples))

    def edit(self, change: Callable[[Patterns], Patterns]) -> None:
        """Change the patterns by a pure function."""
        from dataclasses import replace

        self._change(WORDS, lambda m: replace(m, patterns=change(m.patterns)))

    def forget(self) -> None:
        """Forget every correction and every project; patterns that the user wrote stay."""
        self._change(WORDS, lambda m: m.forgotten())
        self._change(CLIPS, lambda m: m.forgotten())

    # --- files

    def _memory(self, file: str) -> Memory:
        """Return what a file holds now; nothing if it cannot be read, which is reported once."""
        from metagraph.suggest.memory import Memory, MemoryFormatError

        path = state_folder() / file
        try:
            state = path.stat()
        except OSError:
            return Memory()
        stamp = (state.st_mtime_ns, state.st_size)
        if file not in self._read or self._read[file][0] != stamp:
            try:
                memory = Memory.from_json(json.loads(path.read_text(encoding="utf-8")))
            except OSError as error:
                self.failed.emit(
                    tr(
                        "Cannot read what was learned: {path}: {why}.",
                        path=path,
                        why=error.strerror or error,
                    )
                )
                return Memory()
            except (MemoryFormatError, ValueError, RecursionError) as error:
                aside = _set_aside(path)
                self.failed.emit(
                    tr(
                        "Cannot read what was learned: {name}: {error}. The file is kept as {aside}.",
                        name=path.name,
                        error=error,
                        aside=aside,
                    )
                )
                return Memory()
            self._read[file] = stamp, memory
        return self._read[file][1]

    def _change(self, file: str, change: Callable[[Memory], Memory]) -> None:
        """Read a file, change its content, and write it, while no other window does."""
        path = state_folder() / file
        lock = QLockFile(str(path.with_suffix(".lock")))
        if not lock.tryLock(LOCK_WAIT):
            self.failed.emit(
                tr(
                    "Nothing was learned because another window is using {name}. Metagraph tries again at "
                    "the next correction.",
                    name=path.name,
                )
            )
            return
        try:
            before = self._memory(file)
            after = change(before)
            if after is not before:
                write_atomically(
                    path, json.dumps(after.to_json(), ensure_ascii=False, separators=(",", ":")).encode()
                )
                state = path.stat()
                self._read[file] = (state.st_mtime_ns, state.st_size), after
        except FileError as error:
            self.failed.emit(tr("Nothing was learned: {error}", error=error))
            return
        finally:
            lock.unlock()
        self.changed.emit()


def make_memory_key(document: Document) -> str:
    """Return the key under which a project is remembered: its file, "" for none."""
    return _key(document.path)


def _key(path: Path | None) -> str:
    return str(path.resolve()) if path is not None else ""


def _set_aside(path: Path) -> str:
    kept = path.with_suffix(".broken")
    try:
        path.replace(kept)
    except OSError:
        return path.name
    return kept.name
