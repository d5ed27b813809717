"""The autosave journal: every finished edit is appended at once, so a crash loses nothing that was finished.

A journal belongs to one sitting at a saved project file (or at none, for a project never saved) and begins
with the file's SHA-256. Each line after that is one edit as JSON: what changed in the project's plain data. A
torn last line is ignored. While the project is saved, edits go on: a `mark` stands where the saved project
was, and once more, with the SHA-256 of the file that is about to be written, before it is. So whichever of
the two files a crash leaves, the edits after it are known. `recovery` reads journals.
"""

from __future__ import annotations

import json
import os
import threading
from collections.abc import Callable, Mapping
from contextlib import suppress
from itertools import compress
from operator import is_not
from pathlib import Path
from typing import Any, Literal
from weakref import ref

import msgspec

from metagraph.errors import FileError
from metagraph.formats.atomic import replace_file, write_all
from metagraph.formats.data import (
    STRUCTS,
    action_data,
    clip_data,
    markov_data,
    skeleton_data,
    stance_data,
    struct_data,
    to_data,
    weights_data,
)
from metagraph.formats.fields import Data, DataError
from metagraph.formats.locking import Owner
from metagraph.formats.manual_data import alias_data, link_data, manual_data, state_data
from metagraph.formats.store import content_digest, file_digest
from metagraph.graph.manual import Manual
from metagraph.graph.model import LAYERS, Layer, MetaGraph, Project
from metagraph.wording import told

KEYED = ("clips", "stances", "actions", "states", "aliases", "links")
ABOUT = ("step", "how")  # what a record says of its edit, beside what changed
How = Literal["done", "merged", "undone", "redone"]


# --- what changed


def changes(before: Project, after: Project) -> Data:
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
        if getattr(before, key) is not getattr(after, key) and getattr(before, key) != getattr(after, key):
            out[key] = to_data(_bare(after))[key]
    if before.hidden != after.hidden:
        out["hidden"] = list(after.hidden)
    for key in STRUCTS:
        if getattr(before, key) is not getattr(after, key) and getattr(before, key) != getattr(after, key):
            out[key] = struct_data(getattr(after, key))
    if before.markov is not after.markov and before.markov != after.markov:
        out["markov"] = {layer: markov_data(m) for layer, m in after.markov.items()}
    if before.skeleton is not after.skeleton:
        bones = [skeleton_data(x) if x is not None else [] for x in (before.skeleton, after.skeleton)]
        if bones[0] != bones[1]:  # to the last digit; it may have been read twice
            out["skeleton"] = bones[1]
    _keyed(out, "clips", before.clips, after.clips, clip_data)
    layers: Data = {}
    for layer in LAYERS:
        old, new = before.graphs[layer], after.graphs[layer]
        if old is new:
            continue
        part: Data = {}
        if old.start != new.start:
            part["start"] = new.start
        if old.weights != new.weights:
            part["weights"] = weights_data(new)
        _keyed(part, "stances", old.stances, new.stances, stance_data)
        _keyed(part, "actions", old.actions, new.actions, action_data)
        if part:
            layers[layer] = part
    if layers:
        out["layers"] = layers
    if before.manual is not after.manual and before.manual != after.manual:
        out["manual"] = _manual(before.manual, after.manual)
    return out


def _manual(before: Mapping[Layer, Manual], after: Mapping[Layer, Manual]) -> Data:
    """Note what changed in manual machines; None for a layer that has none any more."""
    out: Data = dict.fromkeys(layer for layer in before if layer not in after)
    for layer, new in after.items():
        old = before.get(layer)
        if old is None:
            out[layer] = manual_data(new)
        elif old is not new:
            part: Data = {
                name: getattr(new, name)
                for name in ("start", "any_x", "any_y")
                if getattr(old, name) != getattr(new, name)
            }
            _keyed(part, "states", old.states, new.states, state_data)
            _keyed(part, "aliases", old.aliases, new.aliases, alias_data)
            _keyed(part, "links", old.links, new.links, link_data)
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


class Journal:
    """Appends edits to a file, begun with the first. Beginning replaces what was in it: whoever does has
    taken that over, or declined it. What cannot be written is tried again with the next edit.

    saved: the project file that the edits build on; digest: its SHA-256, where it was another one than it is
    now. owner: whose sitting it is, so that others leave it alone while that goes on.
    """

    def __init__(
        self, path: Path, saved: Path | None, owner: Owner | None = None, digest: str | None = None
    ) -> None:
        self.path = path
        self._file: int | None = None
        self._begun, self._torn, self._size = False, False, 0  # torn: half a record stands behind `size`
        self._saved = saved
        self._base: tuple[Project, int] | None = None
        self._head: Data = {"saved": digest or file_digest(saved), "file": str(saved) if saved else None}
        if owner is not None:
            self._head["owner"] = msgspec.to_builtins(owner)
        self._behind: Project | None = None  # the project before the first edit that could not be written
        self._marks = 0
        self._turn = threading.RLock()  # a thread that saves writes, too

    def begin(self, base: Project | None = None, unsaved: int = 0) -> None:
        """Start anew from the saved file, whose text is kept, or from `base` when there is none. Raises
        FileError.

        unsaved: how many edits of `base` are in no file.
        """
        self._base = (base, unsaved) if base is not None else None
        head = {**self._head, **self._foundation()}
        with self._turn:
            self.close()
            try:
                self.path.parent.mkdir(parents=True, exist_ok=True)
                # Until then the old one stands; where none does, and a file holds all but the first edit,
                # nobody need wait.
                sync = self._base is not None or self.path.exists()
                replace_file(self.path, _encoded(head) + b"\n", sync)
                self._begun, self._torn = True, False
                with suppress(OSError):  # tried again with the next edit
                    self._open()
            except OSError as error:
                raise FileError(
                    self.path,
                    told("cannot be written ({value})", value=error.strerror or error),
                    told("on beginning it"),
                    told("Save the project now and then."),
                ) from None

    def _foundation(self) -> Data:
        """Return what the edits build on, so that they can be read whatever becomes of the project file."""
        if self._base is None:
            with suppress(OSError, UnicodeDecodeError):
                content = self._saved.read_bytes() if self._saved is not None else b""
                if content_digest(content) == self._head["saved"]:
                    return {"text": content.decode("utf-8-sig")}
            return {}
        try:
            return {"unsaved": self._base[1], "base": to_data(self._base[0])}
        except DataError as error:
            raise FileError(
                self.path,
                told("cannot be written ({error})", error=error),
                error.where,
                told("Correct that value."),
            ) from None

    def edit(self, before: Project, after: Project, step: str = "", how: How = "done") -> None:
        """Append one finished edit. Raises FileError when it cannot be written; the edit itself stands, and
        is written with the next.

        step: what was done, to be read. how: whether it is a step of its own, goes on with the one before,
        or takes that back.
        """
        before = self._behind or before
        self._behind = before
        try:
            change = changes(before, after)
        except DataError as error:
            raise FileError(
                self.path,
                told("cannot be written ({error})", error=error),
                error.where,
                told("Correct that value."),
            ) from None
        if change:
            if not self._begun:
                self._begin_with(before)
            self._write(change | ({"step": step} if step else {}) | ({"how": how} if how != "done" else {}))
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
        self._marks += 1
        self._write({"mark": self._marks})
        return self._marks

    def settle(self, mark: int, digest: str) -> None:
        """Write what file a mark is about to become, before it does; on any thread. Raises FileError."""
        if self._begun:
            self._write({"mark": mark, "saved": digest})
            self.secure()  # before the file is

    def touch(self) -> None:
        """Show computers that share the drive that this sitting goes on. Raises OSError."""
        if self._begun:
            os.utime(self.path)
            self.secure()

    def secure(self) -> bool:
        """Let what was written survive a power cut, too; on any thread. Return whether no edit is missing."""
        with suppress(OSError):
            with self._turn:
                if self._file is None:
                    return False
                handle, whole = os.dup(self._file), self._behind is None and not self._torn
            try:
                os.fsync(handle)  # which may take its time; edits need not wait for it
                return whole
            finally:
                os.close(handle)
        return False

    def _write(self, record: Data) -> None:
        with self._turn:
            self._add(record)

    def _open(self) -> None:
        handle = os.open(self.path, os.O_RDWR | os.O_APPEND | getattr(os, "O_BINARY", 0))
        try:
            if not self._torn:
                self._size = os.fstat(handle).st_size
        except OSError:
            os.close(handle)
            raise
        self._file = handle

    def _add(self, record: Data) -> None:
        line = _encoded(record) + b"\n"
        try:
            if self._file is None:  # it could not be opened again
                self._open()
            assert self._file is not None
            if self._torn:
                os.ftruncate(self._file, self._size)
            self._torn = True
            write_all(self._file, line)
            self._size += len(line)
            self._torn = False
        except OSError as error:
            raise FileError(
                self.path,
                told("cannot be written ({value})", value=error.strerror or error),
                told("on adding to it"),
                told("Make room on the disk and save the project."),
            ) from None

    def close(self) -> None:
        with self._turn:
            if self._file is not None:
                handle, self._file = self._file, None
                with suppress(OSError):  # a network drive that is away
                    os.close(handle)

    def remove(self) -> None:
        """Forget the journal: everything in it has been saved, or was declined. Where that is not allowed it
        is offered again.
        """
        self.close()
        self._begun = False
        with suppress(OSError):
            self.path.unlink()


def _encoded(record: Data) -> bytes:
    try:
        return msgspec.json.encode(record)  # ten times as fast, for long conversations
    except UnicodeEncodeError:  # a path that is no text
        return json.dumps(record, separators=(",", ":"), allow_nan=False).encode()


def journal_path(saved: Path, sitting: str = "") -> Path:
    """Return where the journal of a sitting at a project file lies: beside it, hidden. Without a sitting: as
    it was called at first.
    """
    return saved.with_name(f".{saved.name}.{sitting}.journal" if sitting else f".{saved.name}.journal")
