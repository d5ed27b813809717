"""Withdrawing: a participant's data is left out from then on, or deleted. What was deleted, and when, is
noted; nothing of its content is.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from typing import Protocol

import msgspec

from metagraph import __version__
from metagraph.common.budgets import LOG_FILE
from metagraph.common.files import read_file
from metagraph.errors import FileError
from metagraph.formats.atomic import append_line
from metagraph.research.study.logs.log import Writer, format_wall_time, read_log
from metagraph.research.study.logs.watching import LOCK, is_open

DELETIONS = "deletions.jsonl"


class Keeping(Protocol):
    """A study that keeps a log of each participant in a folder of theirs."""

    @property
    def folder(self) -> Path:
        """Return where the study is."""

    @property
    def path(self) -> Path:
        """Return its plan."""

    def known(self, participant: str) -> None:
        """Raises ValueError for a stranger."""

    def data(self, participant: str) -> Path:
        """Return the folder of all that is kept of somebody."""

    def log(self, participant: str) -> Path:
        """Return somebody's log."""


def note_withdrawal(
    study: Keeping, participant: str, why: str = "", now: Callable[[], datetime] = lambda: datetime.now(UTC)
) -> bool:
    """Note in a participant's log that they withdrew, so that no report or export uses it; return whether it
    was not noted yet. why: in words, of the person who notes it. Raises FileError if there is no log,
    ValueError for a stranger.
    """
    study.known(participant)
    path = study.log(participant)
    if read_log(path).standing == "withdrawn":
        return False
    writer = Writer(path, now=now)
    try:
        writer.add("withdrawn", **({"why": why} if why else {}))
    finally:
        writer.close()
    return True


def delete_data(
    study: Keeping, participant: str, now: Callable[[], datetime] = lambda: datetime.now(UTC)
) -> dict[str, object]:
    """Delete all that is kept of a participant beside the study file, and note that it was done: who, when,
    how many files. Return the note. Raises FileError if nothing is kept, or the disk refuses; ValueError for
    a stranger.
    """
    study.known(participant)
    folder = study.data(participant)
    if not folder.is_dir():
        raise FileError(
            folder, "is not there", participant, "There is nothing of this participant to delete."
        )
    if is_open(folder / LOCK):
        raise FileError(folder, "a window has this sitting open", participant, "Close it first.")
    files = [p for p in folder.rglob("*") if p.is_file()]
    note: dict[str, object] = {
        "deleted": format_wall_time(now()),
        "participant": participant,
        "files": len(files),
        "version": __version__,
    }
    path = study.folder / DELETIONS
    try:
        shutil.rmtree(folder)
        append_line(path, json.dumps(note))
    except OSError as error:
        raise FileError(
            Path(error.filename or folder),
            f"cannot be deleted ({error.strerror or error})",
            participant,
            "Close what has it open, check your rights, and delete again.",
        ) from None
    return note


def read_deleted(study: Keeping) -> frozenset[str]:
    """Return whose data was deleted. Damaged lines are left out."""
    path = study.folder / DELETIONS
    if not path.is_file():
        return frozenset()
    out = set()
    for line in read_file(path, LOG_FILE).splitlines():
        try:
            out.add(str(msgspec.json.decode(line)["participant"]))
        except (msgspec.DecodeError, KeyError, TypeError):
            continue
    return frozenset(out)


def find_mentions(study: Keeping, participant: str) -> list[Path]:
    """Return the files in the study's folder, apart from the plan and the data, that still hold the
    pseudonym: reports and exports written before.
    """
    out = []
    skipped, kept = {study.path, study.folder / DELETIONS}, study.data(participant).parent
    for path in sorted(study.folder.rglob("*")):
        if path in skipped or kept in path.parents or not path.is_file():
            continue
        if participant in path.relative_to(study.folder).as_posix():
            out.append(path)
        elif path.suffix in (".html", ".csv", ".tsv", ".json", ".jsonl", ".xes", ".svg"):
            try:
                if participant.encode() in path.read_bytes():
                    out.append(path)
            except OSError:
                continue
    return out
