"""The autosave journal: every finished edit is appended at once, so a crash loses nothing that was finished.

A journal belongs to one sitting at a saved project file (or at none, for a project never saved) and begins
with the file's SHA-256. Each record after that (`journal_records`) is one edit: what changed in the project's
plain data. A torn last record is ignored. While the project is saved, edits go on: a `mark` stands where the
saved project was, and once more, with the SHA-256 of the file that is about to be written, before it is. So
whichever of the two files a crash leaves, the edits after it are known. `recovery` reads journals.
"""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from itertools import compress
from operator import is_not
from pathlib import Path
from typing import Any, Literal
from weakref import ref

import msgspec

from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.locking import Owner
from metagraph.formats.new_file import Access, access_of
from metagraph.formats.project.appended_file import AppendedFile
from metagraph.formats.project.data import (
    STRUCTS,
    encode_action,
    encode_markov,
    encode_skeleton,
    encode_stance,
    encode_struct,
    encode_weights,
    make_clip_data,
    to_data,
)
from metagraph.formats.project.fields import Data, DataError
from metagraph.formats.project.journal_records import encode_record
from metagraph.formats.project.journal_register import JournalRegister
from metagraph.formats.project.journal_words import (
    describe_displacement,
    make_unstorable_error,
    make_unwritten_error,
)
from metagraph.formats.project.manual_data import encode_alias, encode_link, encode_state, make_manual_data
from metagraph.formats.store import compute_content_digest, compute_file_digest
from metagraph.graph.manual.machine import Manual
from metagraph.graph.model import LAYERS, Layer, MetaGraph, Project

KEYED = ("clips", "stances", "actions", "states", "aliases", "links")
ABOUT = ("step", "how", "at")  # what a record says of its edit, beside what changed
How = Literal["done", "merged", "undone", "redone"]


# --- what changed


def find_changes(before: Project, after: Project) -> Data:
    """Return what differs, as plain data: small for a small edit, however large the project. It is asked for
    more than once of each edit, and is not to be changed.
    """
    known = _latest[0]
    if known is not None and known[0]() is before and known[1]() is after:
        return known[2]
    found = _differing(before, after)
    _latest[0] = ref(before), ref(after), found
    return found


# Of the edit that was asked about last: whether it can be saved, then what is written of it. In one piece, as
# other threads ask, too.
_latest: list[tuple[ref[Project], ref[Project], Data] | None] = [None]


def _differing(before: Project, after: Project) -> Data:
    out: Data = {}
    for key in ("name", "character", "base", "settings", "roles", "parts"):
        if _changed(before, after, key):
            out[key] = to_data(_bare(after))[key]
    if before.hidden != after.hidden:
        out["hidden"] = list(after.hidden)
    if before.language != after.language:
        out["language"] = after.language
    for key in STRUCTS:
        if _changed(before, after, key):
            out[key] = encode_struct(getattr(after, key))
    if _changed(before, after, "markov"):
        out["markov"] = {layer: encode_markov(m) for layer, m in after.markov.items()}
    if before.skeleton is not after.skeleton:
        bones = [encode_skeleton(x) if x is not None else [] for x in (before.skeleton, after.skeleton)]
        if bones[0] != bones[1]:  # to the last digit; it may have been read twice
            out["skeleton"] = bones[1]
    _keyed(out, "clips", before.clips, after.clips, make_clip_data)
    layers = {layer: part for layer in LAYERS if (part := _layer(before.graphs[layer], after.graphs[layer]))}
    if layers:
        out["layers"] = layers
    if _changed(before, after, "manual"):
        out["manual"] = _manual(before.manual, after.manual)
    return out


def _changed(before: Project, after: Project, field: str) -> bool:
    """Whether a field differs; one object is not looked at."""
    old, new = getattr(before, field), getattr(after, field)
    return old is not new and old != new


def _layer(old: MetaGraph, new: MetaGraph) -> Data:
    """Return what changed in a layer's graph."""
    part: Data = {}
    if old is new:
        return part
    if old.start != new.start:
        part["start"] = new.start
    if old.weights != new.weights:
        part["weights"] = encode_weights(new)
    _keyed(part, "stances", old.stances, new.stances, encode_stance)
    _keyed(part, "actions", old.actions, new.actions, encode_action)
    return part


def _manual(before: Mapping[Layer, Manual], after: Mapping[Layer, Manual]) -> Data:
    """Note what changed in manual machines; None for a layer that has none any more."""
    out: Data = dict.fromkeys(layer for layer in before if layer not in after)
    for layer, new in after.items():
        old = before.get(layer)
        if old is None:
            out[layer] = make_manual_data(new)
        elif old is not new:
            part: Data = {
                name: getattr(new, name)
                for name in ("start", "any_x", "any_y")
                if getattr(old, name) != getattr(new, name)
            }
            _keyed(part, "states", old.states, new.states, encode_state)
            _keyed(part, "aliases", old.aliases, new.aliases, encode_alias)
            _keyed(part, "links", old.links, new.links, encode_link)
            if part:
                out[layer] = part
    return out


def _bare(project: Project) -> Project:
    return Project(
        name=project.name,
        character=project.character,
        base=project.base,
        settings=project.settings,
        roles=project.roles,
        parts=project.parts,
        graphs={layer: MetaGraph(layer) for layer in LAYERS},
    )


def _keyed(
    out: Data, key: str, before: Mapping[str, Any], after: Mapping[str, Any], data: Callable[[Any], Data]
) -> None:
    """Note what was added, changed and (as None) removed; `<key>_after`: what stands before those not added
    at the end.
    """
    if before is after:
        return
    order, was = list(after), list(before)
    both = min(len(order), len(was))
    if order[:both] == was[:both]:  # as with nearly all edits; ten thousand are compared at once
        differ = compress(after.items(), map(is_not, before.values(), after.values()))
        part: Data = {i: data(v) for i, v in differ if before[i] != v}
        part.update((i, data(after[i])) for i in order[both:])
        part.update(dict.fromkeys(was[both:]))
        if part:
            out[key] = part
        return
    part = {i: data(v) for i, v in after.items() if before.get(i) is not v and before.get(i) != v}
    part.update(dict.fromkeys(i for i in before if i not in after))
    if part:
        out[key] = part
    kept = [i for i in before if i in after]
    if [i for i in order if i in before] != kept:
        out[f"{key}_order"] = order
    elif len(kept) < len(order) and order[: len(kept)] != kept:
        out[f"{key}_after"] = {i: order[n - 1] if n else None for n, i in enumerate(order) if i not in before}


# --- the file


Done = tuple[Project, Project, str]  # an edit: the project before and after it, and what it is called


class Journal:
    """Appends edits to a file, begun with the first. Beginning replaces what was in it: whoever does has
    taken that over, or declined it. What cannot be written is tried again with the next edit.

    saved: the project file that the edits build on; digest: its SHA-256, where it was another one than it is
    now. owner: whose sitting it is, so that others leave it alone while that goes on. like: who may read it,
    where `saved` does not tell. register: where journals are listed, so that they are found wherever they
    are. notes: what has become of the file, in words for the user; error: why it can no longer be kept there.
    Whoever reads them takes them out.
    """

    def __init__(
        self,
        path: Path,
        saved: Path | None,
        owner: Owner | None = None,
        digest: str | None = None,
        like: Access | None = None,
        register: JournalRegister | None = None,
    ) -> None:
        self._file = AppendedFile(path)
        self._begun = False
        self._saved, self._register = saved, register
        self._like = like or access_of(saved)
        self._base: tuple[Project, int, Sequence[Done]] | None = None
        if digest is None:
            with suppress(FileError):
                digest = compute_file_digest(saved)
        self._head: Data = {"saved": digest, "file": str(saved) if saved else None, "begun": int(time.time())}
        if owner is not None:
            self._head["owner"] = msgspec.to_builtins(owner)
        self._behind: Project | None = None  # the project before the first edit that could not be written
        self._number = 0  # of the next record
        self._turn = threading.RLock()  # a thread that saves writes, too
        self.notes: list[str] = []
        self.error: FileError | None = None

    @property
    def begun(self) -> bool:
        """Whether there is a file by now."""
        return self._begun

    @property
    def path(self) -> Path:
        """Where it is; it goes with its folder, when that is renamed."""
        return self._file.path

    def begin(self, base: Project | None = None, unsaved: int = 0, done: Sequence[Done] = ()) -> None:
        """Start again from the saved file, whose text is kept, or from `base` when there is none. Whatever
        was there stands until the new one is whole. Raises FileError.

        unsaved: how many edits of `base` are unsaved. done: edits after it, which are written with it.
        """
        self._base = (base, unsaved, done) if base is not None else None
        try:
            foundation = self._foundation()
            holds = {"holds": next(iter(foundation), ""), "unsaved": unsaved}
            records = [{**self._head, **holds}, foundation]
            records += [record for edit in done if (record := _record(*edit, "done"))]
        except DataError as error:
            raise make_unstorable_error(self.path, error) from None
        content = b"".join(encode_record(record, number) for number, record in enumerate(records))
        with self._turn:
            try:
                # Until then the old one stands; where none does, and a file holds all but the first edit,
                # nobody need wait.
                sync = self._base is not None or self.path.exists()
                self._file.begin(content, self._like, sync)
            except OSError as error:
                raise make_unwritten_error(self.path, error, phrase("while creating it")) from None
            self._begun, self._number = True, len(records)
        if self._register is not None:
            self._register.add(self.path, self._saved, self._head)

    def _foundation(self) -> Data:
        """Return what the edits build on, so that they can be read whatever becomes of the project file."""
        if self._base is not None:
            return {"base": to_data(self._base[0]), "unsaved": self._base[1]}
        with suppress(OSError, UnicodeDecodeError):
            content = self._saved.read_bytes() if self._saved is not None else b""
            if compute_content_digest(content) == self._head["saved"]:
                return {"text": content.decode("utf-8-sig")}
        return {}

    def edit(self, before: Project, after: Project, step: str = "", how: How = "done") -> None:
        """Append one finished edit. Raises FileError when it cannot be written; the edit itself stands, and
        is written with the next.

        step: what was done, to be read. how: whether it is a step of its own, goes on with the one before,
        or takes that back.
        """
        before = self._behind or before
        self._behind = before
        try:
            record = _record(before, after, step, how)
        except DataError as error:
            raise make_unstorable_error(self.path, error) from None
        if record:
            if not self._begun:
                self._begin_with(before)
            self._write(record)
        self._behind = None

    def _begin_with(self, before: Project) -> None:
        """Begin with the first edit, or when what it had to begin with could not be written."""
        if self._base is not None:
            self.begin(*self._base)
        elif "text" in self._foundation():
            self.begin()
        else:  # the file is another one by now
            self.begin(before)

    def mark(self) -> int | None:
        """Write that the project as it is now is being saved; return the mark's number, None without an edit.
        Raises FileError.
        """
        if not self._begun or self._behind is not None:
            return None
        with self._turn:
            number = self._number
            self._write({"mark": number})
        return number

    def settle(self, mark: int, digest: str) -> None:
        """Write what file a mark is about to become, before it does; on any thread. Raises FileError."""
        if self._begun:
            self._write({"mark": mark, "saved": digest})
            self.secure()  # before the file is

    def touch(self) -> None:
        """Show computers that share the drive that this sitting goes on."""
        if self.secure():
            with suppress(OSError):
                self._file.touch()

    def secure(self) -> bool:
        """Let what was written survive a power cut, too; on any thread. Return whether no edit is missing:
        one in a file that was removed is.
        """
        if not self._begun:
            return False
        try:
            with self._turn:
                self._look()
                handle, whole = self._file.duplicate(), self._behind is None and self._file.whole
            try:
                os.fsync(handle)  # which may take its time; edits need not wait for it
            finally:
                os.close(handle)
        except OSError as error:
            self.error = make_unwritten_error(self.path, error, phrase("while checking it"))
            return False
        return whole

    def _write(self, record: Data) -> None:
        with self._turn:
            try:
                self._file.add(encode_record(record, self._number))
                self._number += 1
                self._look()  # an edit in a file that was removed is no edit that was kept
            except OSError as error:
                raise make_unwritten_error(self.path, error, phrase("while adding to it")) from None

    def _look(self) -> None:
        """Look whether the file is in its place, and put it there again. Raises OSError."""
        was = self.path
        what = self._file.look()
        if what:
            self.notes.append(describe_displacement(what, was, self.path))
        if what and self._register is not None:
            self._register.remove(was)
            self._register.add(self.path, self._saved, self._head)

    def close(self) -> None:
        with self._turn:
            self._file.close()

    def remove(self) -> None:
        """Forget the journal: everything in it has been saved, or was declined. Where that is not allowed it
        is offered again.
        """
        self.close()
        self._begun = False
        with suppress(OSError):
            self.path.unlink(missing_ok=True)
            if self._register is not None:
                self._register.remove(self.path)


def _record(before: Project, after: Project, step: str, how: How) -> Data:
    """Return what is written of an edit, nothing if it changed nothing that is saved. Raises DataError."""
    change = find_changes(before, after)
    if not change:
        return {}
    about = ({"step": step} if step else {}) | ({"how": how} if how != "done" else {})
    return {**change, **about, "at": int(time.time())}


def make_journal_path(saved: Path, sitting: str = "") -> Path:
    """Return where the journal of a sitting at a project file lies: beside it, hidden. Without a sitting: as
    it was called at first.
    """
    return saved.with_name(f".{saved.name}.{sitting}.journal" if sitting else f".{saved.name}.journal")
