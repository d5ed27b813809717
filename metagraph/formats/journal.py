"""The autosave journal: every finished edit is appended at once, so a crash loses nothing that was finished.

A journal belongs to a saved project file (or to none, for a project never saved) and begins with its SHA-256. Each line
after that is one edit as JSON: what changed in the project's plain data. A torn last line is ignored.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TextIO

from metagraph.errors import FileError
from metagraph.formats.data import (
    Data,
    DataError,
    action_data,
    clip_data,
    from_data,
    markov_data,
    skeleton_data,
    to_data,
)
from metagraph.formats.store import read_project
from metagraph.graph.model import LAYERS, MetaGraph, Project, Stance

_KEYED = ("clips", "stances", "actions")


def changes(before: Project, after: Project) -> Data:
    """Return what differs, as plain data: small for a small edit, however large the project."""
    out: Data = {}
    for key in ("name", "character", "next_id", "base", "settings", "roles", "parts"):
        if getattr(before, key) is not getattr(after, key) and getattr(before, key) != getattr(after, key):
            out[key] = to_data(_bare(after))[key]
    if before.markov is not after.markov:
        out["markov"] = {layer: markov_data(m) for layer, m in after.markov.items()}
    if before.skeleton is not after.skeleton:
        out["skeleton"] = skeleton_data(after.skeleton) if after.skeleton is not None else []
    if before.clips is not after.clips:
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
            part["weights"] = dict(new.weights)
        _keyed(part, "stances", old.stances, new.stances, _stance_data)
        _keyed(part, "actions", old.actions, new.actions, action_data)
        if part:
            layers[layer] = part
    if layers:
        out["layers"] = layers
    return out


def _stance_data(stance: Stance) -> Data:
    return {"id": stance.id, "name": stance.name}


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


def _keyed(out: Data, key: str, before: Mapping[str, Any], after: Mapping[str, Any], data: Any) -> None:
    if before is after:
        return
    part: Data = {i: data(v) for i, v in after.items() if before.get(i) is not v}
    part.update(dict.fromkeys(i for i in before if i not in after))
    if part:
        out[key] = part
    kept = [i for i in before if i in after]
    if [*kept, *(i for i in after if i not in before)] != list(after):
        out[f"{key}_order"] = list(after)


def apply(data: Data, change: Data) -> Data:
    """Return project data with one change worked in."""
    out = dict(data)
    for key, value in change.items():
        if key == "layers":
            out["layers"] = {
                layer: apply(data["layers"][layer], value[layer]) if layer in value else data["layers"][layer] for layer in LAYERS
            }
        elif key in _KEYED:
            items = {item["id"]: item for item in data.get(key, [])}
            for ident, item in value.items():
                if item is None:
                    items.pop(ident, None)
                else:
                    items[ident] = item
            out[key] = list(items.values())
        elif not key.endswith("_order"):
            out[key] = value
    for key in _KEYED:
        if f"{key}_order" in change:
            items = {item["id"]: item for item in out[key]}
            out[key] = [items[i] for i in change[f"{key}_order"] if i in items]
    return out


class Journal:
    """Appends edits to a file. Opening truncates: whoever opens it has taken over what was in it, or declined it."""

    def __init__(self, path: Path, saved: Path | None) -> None:
        self.path = path
        self._file: TextIO | None = None
        self._saved = saved

    def begin(self, base: Project | None = None) -> None:
        """Start anew from the saved file, or from `base` written into the journal when there is none."""
        self.close()
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self._file = self.path.open("w", encoding="utf-8")
        head: Data = {"saved": _digest(self._saved), "file": str(self._saved) if self._saved else None}
        if base is not None:
            head["base"] = to_data(base)
        self._write(head)

    def edit(self, before: Project, after: Project) -> None:
        """Append one finished edit. A full disk is told as FileError; the edit itself stands."""
        change = changes(before, after)
        if not change:
            return
        if self._file is None:
            self.begin()
        self._write(change)

    def _write(self, record: Data) -> None:
        assert self._file is not None
        try:
            self._file.write(json.dumps(record, ensure_ascii=False, separators=(",", ":")) + "\n")
            self._file.flush()
        except OSError as error:
            raise FileError(self.path, f"cannot be written ({error.strerror})", "", "Make room on the disk and save the project.") from None

    def close(self) -> None:
        if self._file is not None:
            self._file.close()
            self._file = None

    def remove(self) -> None:
        """Forget the journal: everything in it has been saved, or was declined."""
        self.close()
        self.path.unlink(missing_ok=True)


def _digest(path: Path | None) -> str | None:
    if path is None or not path.is_file():
        return None
    return hashlib.sha256(path.read_bytes()).hexdigest()


def recover(journal: Path, saved: Path | None) -> tuple[Project, int] | None:
    """Return the project with the journal's edits worked in, without motion, and how many there were; None if there is nothing.

    Raises FileError when the journal belongs to another state of the file.
    """
    try:
        lines = journal.read_text(encoding="utf-8").split("\n")
    except (OSError, UnicodeDecodeError):
        return None
    records: list[Data] = []
    for line in lines[:-1]:  # what follows the last newline was torn
        try:
            record = json.loads(line)
        except ValueError:
            break
        if not isinstance(record, dict):
            break
        records.append(record)
    if len(records) < 2:
        return None
    head = records[0]
    if head.get("saved") != _digest(saved):
        raise FileError(journal, "belongs to another state of the project file", "", "It is kept; rename it to look into it.")
    base = head.get("base")
    data = base if isinstance(base, dict) else to_data(read_project(saved) if saved is not None and saved.is_file() else Project())
    states = [data]
    for record in records[1:]:
        try:
            states.append(apply(states[-1], record))
        except (KeyError, TypeError, AttributeError):
            break
    while len(states) > 1:  # usually the last one is good at once
        try:
            return from_data(states[-1]), len(states) - 1
        except DataError:
            states.pop()
    return None


def journal_path(saved: Path) -> Path:
    """Return where the journal of a project file lies: beside it, hidden."""
    return saved.with_name(f".{saved.name}.journal")
