"""What a journal gives back after a crash: whose sittings are over, and the projects with the edits worked
in.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path

import msgspec

from metagraph.errors import FileError
from metagraph.formats.data import from_data, to_data
from metagraph.formats.fields import Data, DataError
from metagraph.formats.journal import ABOUT, KEYED
from metagraph.formats.locking import Owner, is_gone
from metagraph.formats.store import file_digest, from_text, read_project
from metagraph.graph.model import LAYERS, Project
from metagraph.records import dataclass

_KEPT = "It is kept."
_ANOTHER = "belongs to another state of the project file"


# --- changes worked in


class Replay:
    """Project data that changes are worked into; lists are held by id, so that a change costs what it is
    large.
    """

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
        others = {k: v for k, v in change.items() if k not in ("layers", "manual", *ABOUT)}
        _work_in(self.top, others)

    def data(self) -> Data:
        out = {**_closed(self.top), "layers": {layer: _closed(part) for layer, part in self.layers.items()}}
        if not out.get("hidden", True):
            del out["hidden"]  # as a project without any is written
        return (
            {**out, "manual": {layer: _closed(part) for layer, part in self.manual.items()}}
            if self.manual
            else out
        )


def _opened(data: Data) -> Data:
    return {
        key: {item["id"]: item for item in value} if key in KEYED else value for key, value in data.items()
    }


def _closed(data: Data) -> Data:
    return {key: list(value.values()) if key in KEYED else value for key, value in data.items()}


def _work_in(data: Data, change: Data) -> None:
    for key, value in change.items():
        if key in KEYED:
            items = data.setdefault(key, {})
            for ident, item in value.items():
                if item is None:
                    items.pop(ident, None)
                else:
                    items[ident] = item
        elif not key.endswith(("_order", "_after")):
            data[key] = value
    for key in KEYED:
        if f"{key}_order" in change:
            data[key] = {i: data[key][i] for i in change[f"{key}_order"]}
        elif f"{key}_after" in change:
            data[key] = _inserted(data[key], change[f"{key}_after"])


def _inserted(items: Data, places: Mapping[str, str | None]) -> Data:
    """Return items in the order that puts each of `places` right behind another item, None being the
    beginning.
    """
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
    """Return project data with one change worked in. Raises KeyError, TypeError or AttributeError when they
    do not fit.
    """
    replay = Replay(data)
    replay.apply(change)
    return replay.data()


# --- files


@dataclass(frozen=True)
class Left:
    """A journal somebody left. project: with its edits worked in, without motion; edits: how many. written:
    when the last one was, in seconds since 1970. digest: of the file the edits build on. behind: the project
    file has changed since; the edits are whole, but not in step with it. worked_in: as it has, and the
    journal does not tell what it was: they are worked into what it is now. base: what the edits begin with,
    as plain data, of which `unsaved` edits are in no file; records: the edits after it.
    """

    path: Path
    project: Project
    edits: int
    owner: Owner | None
    written: float
    digest: str | None
    behind: bool
    base: Data
    unsaved: int
    records: tuple[Data, ...]
    worked_in: bool = False

    @property
    def common(self) -> Project | None:
        """What the file held that the edits build on, without motion; None where nobody knows."""
        return from_data(self.base, []) if self.digest is not None and not self.unsaved else None


def recover(journal: Path, saved: Path | None) -> tuple[Project, int] | None:
    """Return the project with the journal's edits worked in, without motion, and how many there were; None if
    there is nothing.

    Raises FileError when the journal belongs to another state of the file, or nothing in it can be used.
    """
    found = read_journal(journal, saved)
    if found is not None and (found.behind or found.worked_in):
        raise FileError(journal, _ANOTHER, "line 1", _KEPT)
    return (found.project, found.edits) if found is not None else None


def read_journal(journal: Path, saved: Path | None) -> Left | None:
    """Return what a journal holds, None if that is no edit.

    Raises FileError when nothing in it can be used.
    """
    try:
        content = journal.read_bytes()
        written = journal.stat().st_mtime
    except FileNotFoundError:
        return None
    except OSError as error:
        if journal.is_dir():
            return None
        raise FileError(journal, f"cannot be read ({error.strerror or error})", "", _KEPT) from None
    lines = content.split(b"\n")[:-1]  # what follows the last newline was torn
    if len(lines) < 2 and b'"unsaved":' not in content:
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
    head, now = records[0], file_digest(saved)
    begin = _settled(records, now)
    base = head.get("base") if begin == 1 else None
    before = head.get("unsaved", 0) if isinstance(base, dict) else 0
    edits = [record for record in records[begin:] if "mark" not in record]
    if not edits and not before and (len(records) > 1 or len(lines) < 2):
        return None
    changed = begin == 1 and head["saved"] != now
    if not isinstance(base, dict) and (changed or saved is None):
        base = _of_text(head.get("text"), journal)
    behind = changed and isinstance(base, dict)
    if not isinstance(base, dict):
        base = to_data(read_project(saved, []) if saved is not None and saved.is_file() else Project())
    # Usually all are good; else the longest beginning that is.
    good, bad = 0, len(edits) + 1
    count = len(edits)
    found = _replayed(base, []) if before else None
    while count > good:
        project = _replayed(base, edits[:count])
        if project is not None:
            good, found = count, project
        else:
            bad = count
        count = (good + bad) // 2
    if found is None:
        raise FileError(journal, _ANOTHER if changed and not behind else "is damaged", "line 2", _KEPT)
    return Left(
        journal,
        found,
        before + max(1, sum(record.get("how") != "merged" for record in edits[:good])) if good else before,
        _owner(head),
        written,
        head["saved"] if behind else now,
        behind,
        base,
        before,
        tuple(edits[:good]),
        changed and not behind,
    )


def _of_text(text: object, journal: Path) -> Data | None:
    """Return what a project file held whose text is in a journal."""
    with suppress(FileError):
        return to_data(from_text(text, journal, [])) if isinstance(text, str) else None
    return None


def _settled(records: Sequence[Data], digest: str | None) -> int:
    """Return the number of the first record that the file of a digest does not have."""
    marks = {
        record["mark"]: n
        for n, record in reversed(list(enumerate(records)))
        if "mark" in record and _is_number(record["mark"])
    }
    for record in reversed(records):
        if digest is not None and record.get("saved") == digest and record.get("mark") in marks:
            return marks[record["mark"]] + 1
    return 1


def _is_number(value: object) -> bool:
    return isinstance(value, int)


def _owner(head: Data) -> Owner | None:
    try:
        return msgspec.convert(head.get("owner"), Owner)
    except msgspec.ValidationError:
        return None


def _replayed(base: Data, records: Sequence[Data]) -> Project | None:
    try:
        replay = Replay(base)
        for record in records:
            replay.apply(record)
        return from_data(replay.data(), [])
    except (DataError, KeyError, TypeError, AttributeError):
        return None


def left_journals(saved: Path) -> list[Path]:
    """Return the journals of a project file whose sittings are over, the latest last; those that were put
    aside at first, when the file had changed, among them.
    """
    return journals_in(saved.parent, rf"{re.escape(f'.{saved.name}')}(\.[0-9a-f]+)?\.(journal|old)")


def journals_in(folder: Path, names: str) -> list[Path]:
    """Return the journals in a folder whose names a regular expression matches and whose sittings are over,
    the latest last.
    """
    wanted = re.compile(names)
    found: list[tuple[float, Path]] = []
    try:
        for path in folder.iterdir():
            if wanted.fullmatch(path.name) and path.is_file() and _is_left(path):
                found.append((path.stat().st_mtime, path))
    except OSError:
        pass  # what cannot be listed offers nothing
    return [path for _, path in sorted(found)]


def _is_left(path: Path) -> bool:
    """Return whether nobody writes to a journal any more; one that does not say whose it is was written
    before they did.
    """
    try:
        with path.open("rb") as file:
            head = msgspec.json.decode(file.readline())
    except (OSError, ValueError):  # ValueError: also what msgspec raises
        head = None
    owner = _owner(head) if isinstance(head, dict) else None
    return owner is None or is_gone(owner, path)
