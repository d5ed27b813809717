"""The folder of a perceptual study: what people are shown, apart from what nobody may see.

`show/` is what they get: `index.html` and `videos/`. Beside it lie the plan, the secret, `key.json`, what was
frozen, `allocation.jsonl`, `answers/<participant>/log.jsonl` and `report/`.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from importlib.resources import files
from pathlib import Path
from typing import Any

import msgspec

from metagraph import __version__
from metagraph.common.budgets import TEXT_FILE
from metagraph.common.files import read_file
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.formats.clips import digest
from metagraph.research.study.logs.log import NAME, format_wall_time
from metagraph.research.study.perceive.design import Design, Key
from metagraph.research.study.perceive.perceive_plan import FILE, PerceivePlan, read_perceive_plan
from metagraph.research.study.perceive.sealed import seal_sessions
from metagraph.research.study.plan import allocation
from metagraph.research.study.plan.drawn_orders import LOG
from metagraph.research.study.plan.freeze import ABSENT, find_changed_names, seal

KEY, LOCK, SHOW, PAGE = "key.json", "perceive.frozen.json", "show", "index.html"
PLACE = "__STUDY__"  # in the page, where what it shows is put


@dataclass(frozen=True)
class Perceived:
    """A study and where it is. path: of its plan."""

    path: Path
    plan: PerceivePlan
    key: Key

    @property
    def folder(self) -> Path:
        return self.path.parent

    @property
    def show(self) -> Path:
        return self.folder / SHOW

    def known(self, participant: str) -> None:
        """Raises ValueError for a stranger."""
        if participant not in self.key.sessions:
            few = ", ".join([*self.key.sessions][:4])
            raise ValueError(f"'{participant}' does not take part; there are {few} ...")

    def data(self, participant: str) -> Path:
        return self.folder / "answers" / participant

    def log(self, participant: str) -> Path:
        return self.data(participant) / NAME

    def video(self, name: str) -> Path:
        return self.show / "videos" / f"{name}.mp4"

    def differences(self) -> list[str]:
        """Return in words what is not as it was frozen. Raises FileError."""
        before = _frozen(self.folder)
        now = perceive_manifest(self.folder)
        return [
            f"{n} {'is not there any more' if now.get(n, ABSENT) == ABSENT else 'is not as it was frozen'}"
            for n in find_changed_names(before, now)
        ]


def write_folder(folder: Path, plan: PerceivePlan, text: bytes, made: Design) -> Perceived:
    """Write all of a study but its videos, which are there; freeze it. text: the plan's file. Raises
    FileError.
    """
    page = files(__package__).joinpath("page.html").read_text("utf-8")
    shown = {**made.public, "sessions": seal_sessions(made.public["sessions"], made.public["design"])}
    # Nothing in a text may end the script that holds it.
    told = json.dumps(shown, ensure_ascii=True, separators=(",", ":")).replace("<", "\\u003c")
    write_atomically(folder / SHOW / PAGE, page.replace(PLACE, told).encode())
    write_atomically(folder / FILE, text)
    write_atomically(folder / KEY, msgspec.json.format(msgspec.json.encode(made.key), indent=1) + b"\n")
    with suppress(OSError):  # some disks know no rights
        (folder / KEY).chmod(0o600)
    log = folder / LOG
    if not log.is_file():
        at = datetime.now(UTC).isoformat(timespec="seconds")
        for place, (who, s) in enumerate(made.key.sessions.items()):
            note = {"place": place, "participant": who, "number": s.number, "at": at}
            allocation.append_durably(log, note, who)
    digests = perceive_manifest(folder)
    data = {
        "frozen": format_wall_time(datetime.now(UTC)),
        "version": __version__,
        "seal": seal(digests),
        "digests": digests,
    }
    write_atomically(folder / LOCK, (json.dumps(data, indent=1) + "\n").encode())
    return Perceived(folder / FILE, plan, made.key)


def perceive_manifest(folder: Path) -> dict[str, str]:
    """Return name -> SHA-256 of the plan, the key, the page and the videos."""
    paths = [
        folder / FILE,
        folder / KEY,
        folder / SHOW / PAGE,
        *sorted((folder / SHOW / "videos").glob("*.mp4")),
    ]
    return {p.relative_to(folder).as_posix(): digest(p) for p in paths if p.is_file()}


def _frozen(folder: Path) -> Mapping[str, str]:
    path = folder / LOCK
    try:
        data: Any = msgspec.json.decode(read_file(path, TEXT_FILE))
        found = {str(k): str(v) for k, v in data["digests"].items()}
        if seal(found) != data["seal"]:
            raise KeyError("seal")
    except (msgspec.DecodeError, KeyError, TypeError, AttributeError, RecursionError):
        raise FileError(
            path,
            "is damaged, or was changed by hand",
            "digests",
            "Take it from a copy, or make the study anew.",
        ) from None
    return found


def read_folder(path: str | Path) -> Perceived:
    """Return the study in a folder that `make` or `simulate` wrote. Raises FileError."""
    folder = Path(path)
    folder = folder.parent if folder.name in (FILE, KEY) else folder
    place = folder / KEY
    if folder.is_dir() and not place.is_file():
        raise FileError(
            folder,
            "holds no perceptual study",
            KEY,
            "Give the folder that 'metagraph study perceive make' wrote.",
        )
    try:
        key = msgspec.json.decode(read_file(place, TEXT_FILE), type=Key)
    except (msgspec.DecodeError, RecursionError) as error:
        raise FileError(place, f"is damaged ({error})", "the key", "Take it from a copy.") from None
    return Perceived((folder / FILE).resolve(), read_perceive_plan(folder / FILE), key)


def level_times(folder: Path) -> None:
    """Give all videos the same time, so that the order they were drawn in tells nothing."""
    for path in (folder / SHOW / "videos").glob("*.mp4"):
        os.utime(path, (0, 0))
