"""The autosave journal: every finished edit is appended at once, so a crash loses nothing that was finished.

A journal belongs to a saved project file (or to none, for a project never saved) and begins with its SHA-256. Each line
after that is one edit as JSON: what changed in the project's plain data. A torn last line is ignored.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, BinaryIO

import msgspec

from metagraph.errors import FileError
from metagraph.formats.data import (
    STRUCTS,
    action_data,
    clip_data,
    from_data,
    markov_data,
    skeleton_data,
    stance_data,
    struct_data,
    to_data,
    weights_data,
)
from metagraph.formats.fields import Data, DataError
from metagraph.formats.manual_data import link_data, manual_data, state_data
from metagraph.formats.store import read_project
from metagraph.graph.manual import Manual
from metagraph.graph.model import LAYERS, Layer, MetaGraph, Project

_KEYED = ("clips", "stances", "actions", "states", "links")
_KEPT = "It is kept; rename it to look into it."


# --- what changed ----------------------------------------------------------------------------------------------------


def changes(before: Project, after: Project) -> Data:
    """Return what differs, as plain data: small for a small edit, however large the project."""
    out: Data = {}
    for key in ("name", "character", "next_id", "base", "settings", "roles", "parts"):
        if getattr(before, key) is not getattr(after, key) and getattr(before, key) != getattr(after, key):
            out[key] = to_data(_bare(after))[key]
    for key in STRUCTS:
        if getattr(before, key) is not getattr(after, key) and getattr(before, key) != getattr(after, key):
            out[key] = struct_data(getattr(after, key))
    if before.markov is not after.markov and before.markov != after.markov:
        out["markov"] = {layer: markov_data(m) for layer, m in after.markov.items()}
    if before.skeleton is not after.skeleton:
        out["skeleton"] = skeleton_data(after.skeleton) if after.skeleton is not None else []
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
            part: Data = {name: getattr(new, name) for name in ("start", "any_x", "any_y") if getattr(old, name) != getattr(new, name)}
            _keyed(part, "states", old.states, new.states, state_data)
            _keyed(part, "links", old.links, new.links, link_data)
            if part:
                out[layer] = part
    return out


def _bare(project: Project) -> Project:
    return Project(
        name=project.name,
        character=project.character,
        next_id=project.next_id,
        base=project.base,
        settings=project.settings,
        roles=project.roles,
        parts=project.parts,
        graphs={layer: MetaGraph(layer) for layer in LAYERS},
    )


def _keyed(out: Data, key: str, before: Mapping[str, Any], after: Mapping[str, Any], data: Callable[[Any], Data]) -> None:
    """Note what was added, changed and (as None) removed; `<key>_after`: what stands before those not added at the end."""
    if before is after:
        return
    part: Data = {i: data(v) for i, v in after.items() if before.get(i) is not v and before.get(i) != v}
    part.update(dict.fromkeys(i for i in before if i not in after))
    if part:
        out[key] = part
    order = list(after)
    kept = [i for i in before if i in after]
    if [i for i in order if i in before] != kept:
        out[f"{key}_order"] = order
    elif len(kept) < len(order) and order[: len(kept)] != kept:
        out[f"{key}_after"] = {i: order[n - 1] if n else None for n, i in enumerate(order) if i not in before}


# --- and back --------------------------------------------------------------------------------------------------------


class _Replay:
    """Project data that changes are worked into; lists are held by id, so that a change costs what it is large."""

    def __init__(self, data: Data) -> None:
        self.top = _opened({key: value for key, value in data.items() if key != "manual"})
        self.layers = {layer: _opened(data["layers"][layer]) for layer in LAYERS}
        self.manual = {layer: _opened(machine) for layer, machine in data.get("manual", {}).items()}

    def apply(self, change: Data) -> None:
        for layer, part in change.get("layers", {}).items():
            _work_in(self.layers[layer], part)
        for layer, part in change.get("manual", {}).items():
            if part is None:
                self.manual.pop(layer, None)
            elif layer in self.manual:
                _work_in(self.manual[layer], part)
            else:
                self.manual[layer] = _opened(part)
        _work_in(self.top, {key: value for key, value in change.items() if key not in ("layers", "manual")})

    def data(self) -> Data:
        out = {**_closed(self.top), "layers": {layer: _closed(part) for layer, part in self.layers.items()}}
        return {**out, "manual": {layer: _closed(part) for layer, part in self.manual.items()}} if self.manual else out


def _opened(data: Data) -> Data:
    return {key: {item["id"]: item for item in value} if key in _KEYED else value for key, value in data.items()}


def _closed(data: Data) -> Data:
    return {key: list(value.values()) if key in _KEYED else value for key, value in data.items()}


def _work_in(data: Data, change: Data) -> None:
    for key, value in change.items():
        if key in _KEYED:
            items = data.setdefault(key, {})
            for ident, item in value.items():
                if item is None:
                    items.pop(ident, None)
                else:
                    items[ident] = item
        elif not key.endswith(("_order", "_after")):
            data[key] = value
    for key in _KEYED:
        if f"{key}_order" in change:
            data[key] = {i: data[key][i] for i in change[f"{key}_order"]}
        elif f"{key}_after" in change:
            data[key] = _inserted(data[key], change[f"{key}_after"])


def _inserted(items: Data, places: Mapping[str, str | None]) -> Data:
    """Return items in the order that puts each of `places` right behind another item, None being the beginning."""
    following: dict[str | None, list[str]] = {}
    for ident, before in places.items():
        following.setdefault(before, []).append(ident)
    out: Data = {}
    queue: list[str] = following.pop(None, [])[::-1]
    rest = iter([i for i in items if i not in places])
    while True:
        if not queue:
            following_one = next(rest, None)
            if following_one is None:
                break
            queue.append(following_one)
        ident = queue.pop()
        out[ident] = items[ident]
        queue.extend(reversed(following.pop(ident, ())))
    return {**out, **items}


def apply(data: Data, change: Data) -> Data:
    """Return project data with one change worked in. Raises KeyError, TypeError or AttributeError when they do not fit."""
    replay = _Replay(data)
    replay.apply(change)
    return replay.data()


# --- the file --------------------------------------------------------------------------------------------------------


class Journal:
    """Appends edits to a file, begun with the first. Beginning truncates: whoever does has taken over what was in it, or declined it.

    saved: the project file as it is now, which the edits build on.
    """

    def __init__(self, path: Path, saved: Path | None) -> None:
        self.path = path
        self._file: BinaryIO | None = None
        self._head: Data = {"saved": _digest(saved), "file": str(saved) if saved else None}
        self._behind: Project | None = None  # the project before the first edit that could not be written

    def begin(self, base: Project | None = None) -> None:
        """Start anew from the saved file, or from `base` written into the journal when there is none. Raises FileError."""
        self.close()
        try:
            head = self._head if base is None else {**self._head, "base": to_data(base)}
        except DataError as error:
            raise FileError(self.path, f"cannot be written ({error})", error.where, "Correct that value.") from None
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            self._file = self.path.open("wb")
        except OSError as error:
            raise FileError(
                self.path, f"cannot be written ({error.strerror})", "on beginning it", "Save the project now and then."
            ) from None
        self._write(head)

    def edit(self, before: Project, after: Project) -> None:
        """Append one finished edit. Raises FileError when it cannot be written; the edit itself stands, and is written with the next."""
        before = self._behind or before
        self._behind = before
        try:
            change = changes(before, after)
        except DataError as error:
            raise FileError(self.path, f"cannot be written ({error})", error.where, "Correct that value.") from None
        if change:
            if self._file is None:
                self.begin()
            self._write(change)
        self._behind = None

    def _write(self, record: Data) -> None:
        assert self._file is not None
        start = self._file.tell()
        try:
            self._file.write(_encoded(record) + b"\n")
            self._file.flush()
        except OSError as error:
            self._cut(start)
            raise FileError(
                self.path, f"cannot be written ({error.strerror})", "on adding to it", "Make room on the disk and save the project."
            ) from None

    def _cut(self, size: int) -> None:
        """Forget half a record: what is written later must not stand behind it."""
        try:
            if self._file is not None:
                self._file.close()
            self._file = self.path.open("r+b")
            self._file.truncate(size)
            self._file.seek(size)
        except OSError:
            self._file = None

    def close(self) -> None:
        if self._file is not None:
            self._file.close()
            self._file = None

    def remove(self) -> None:
        """Forget the journal: everything in it has been saved, or was declined."""
        self.close()
        self.path.unlink(missing_ok=True)


def _encoded(record: Data) -> bytes:
    try:
        return msgspec.json.encode(record)  # ten times as fast, for long conversations
    except UnicodeEncodeError:  # a path that is no text
        return json.dumps(record, separators=(",", ":"), allow_nan=False).encode()


def _digest(path: Path | None) -> str | None:
    if path is None or not path.is_file():
        return None
    return hashlib.sha256(path.read_bytes()).hexdigest()


def recover(journal: Path, saved: Path | None) -> tuple[Project, int] | None:
    """Return the project with the journal's edits worked in, without motion, and how many there were; None if there is nothing.

    Raises FileError when the journal belongs to another state of the file, or nothing in it can be used.
    """
    try:
        lines = journal.read_bytes().split(b"\n")[:-1]  # what follows the last newline was torn
    except OSError:
        return None
    if len(lines) < 2:
        return None
    records: list[Data] = []
    for line in lines:
        try:
            record = json.loads(line)
        except (ValueError, RecursionError):
            break
        if not isinstance(record, dict):
            break
        records.append(record)
    if not records or "saved" not in records[0]:
        raise FileError(journal, "is damaged", "line 1", _KEPT)
    if records[0]["saved"] != _digest(saved):
        raise FileError(journal, "belongs to another state of the project file", "line 1", _KEPT)
    base = records[0].get("base")
    if not isinstance(base, dict):
        base = to_data(read_project(saved, []) if saved is not None and saved.is_file() else Project())
    # Usually all are good; else the longest beginning that is.
    good, bad = 0, len(records)
    count = len(records) - 1
    found: Project | None = None
    while count > good:
        project = _replayed(base, records[1 : count + 1])
        if project is not None:
            good, found = count, project
        else:
            bad = count
        count = (good + bad) // 2
    if found is None:
        raise FileError(journal, "is damaged", "line 2", _KEPT)
    return found, good


def _replayed(base: Data, records: Sequence[Data]) -> Project | None:
    try:
        replay = _Replay(base)
        for record in records:
            replay.apply(record)
        return from_data(replay.data(), [])
    except (DataError, KeyError, TypeError, AttributeError):
        return None


def journal_path(saved: Path) -> Path:
    """Return where the journal of a project file lies: beside it, hidden."""
    return saved.with_name(f".{saved.name}.journal")
