"""Define a tool with which a program works on a project: its name, its schemas, and a function that looks at
a project or returns another one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import msgspec
from msgspec import Struct

from metagraph.common.field_errors import explain_validation
from metagraph.common.files import is_inside
from metagraph.graph.model import Project
from metagraph.graph.problem import Problem
from metagraph.live.mcp_protocol import make_result_schema
from metagraph.playback.rehearsal import rehearse

# looks: nothing changes. edits: the project is another one after it, as one step. writes: files beside the
# project. steps: moves among the steps that there are.
Effect = Literal["looks", "edits", "writes", "steps"]
Report = Callable[[float, float, str], None]  # done, of how much, what; raises CallCancelledError

MOST_LINES = 200  # lines of changes or notes that a result has


class AuthorError(ValueError):
    """A tool cannot do what it was asked. The message says why and what to do; nothing was changed."""


class CallCancelledError(Exception):
    """The call was cancelled while it worked; nothing was changed."""


class NoFields(Struct, forbid_unknown_fields=True):
    """What a tool takes that needs nothing."""


class EditReport(Struct, omit_defaults=True):
    """What an edit did. step: its name in the history. changes: what is different, a line each. actions: ids
    of those it made. left: name -> why something was left as it was. notes: what else there is to know.
    """

    step: str = ""
    changes: list[str] = []
    actions: list[str] = []
    left: dict[str, str] = {}
    notes: list[str] = []


class LastRehearsal:
    """What was seen when a project was played last: finding problems and then mending them plays it once."""

    def __init__(self) -> None:
        self._project: Project | None = None
        self._seconds = 0.0
        self._seen: list[Problem] = []

    def see(self, project: Project, seconds: float, tell: Callable[..., None]) -> list[Problem]:
        """Return what a viewer would see go wrong in so many seconds; tell: (done, total)."""
        if project is not self._project or seconds != self._seconds:
            self._seen = rehearse(project, seconds, tell)
            self._project, self._seconds = project, seconds
        return self._seen


@dataclass(frozen=True)
class ToolWork:
    """What a tool works on. folder: what paths are relative to; `roots` are the folders in which it may read
    and write, of which this is the first. path: the project's file. report: told how far the work is.
    rehearsal: what was seen when it was played last.
    """

    project: Project
    folder: Path
    path: Path
    roots: tuple[Path, ...] = ()
    report: Report = lambda done, total, words: None
    rehearsal: LastRehearsal = field(default_factory=LastRehearsal)

    def find_path(self, name: str) -> Path:
        """Return a path that a call names, relative to the project's folder. Raises AuthorError for one that
        is outside of the folders it may use.
        """
        path = (self.folder / name).resolve()
        if not any(path == root or is_inside(path, root) for root in self.roots):
            known = ", ".join(str(root) for root in self.roots)
            raise AuthorError(
                f"'{name}' is outside of the folders that may be used: {known}. A person can add one with "
                "--folder"
            )
        return path

    def watch(self, words: str) -> Callable[..., None]:
        """Return a function that takes (done, total) and reports it in words."""
        return lambda done, total, *_: self.report(done, total, f"{words} {done} of {total}")


@dataclass(frozen=True)
class ToolOutcome:
    """What a tool did. told: its result. project: what it makes of the project, for one that edits. title:
    the name of the step, where the tool's own would say too little. pictures: PNG files, in the order in
    which the result names them.
    """

    told: Struct
    project: Project | None = None
    title: str = ""
    pictures: tuple[bytes, ...] = field(default=(), repr=False)


@dataclass(frozen=True)
class AuthorTool:
    """A tool. takes, gives: the types of its arguments and its result. does: the work; it raises AuthorError,
    EditError, FileError or ExportError where it cannot be done. title: the name of its step in the history.
    long: whether it may take seconds.
    """

    name: str
    about: str
    takes: type[Struct]
    gives: type[Struct]
    does: Callable[[ToolWork, Any], ToolOutcome]
    effect: Effect = "looks"
    title: str = ""
    long: bool = False

    def read(self, given: dict[str, Any]) -> Struct:
        """Return arguments as the tool takes them. Raises AuthorError, which names the field."""
        try:
            return msgspec.convert(given, self.takes)
        except (msgspec.ValidationError, RecursionError) as error:
            words = explain_validation(error, self.takes)
            raise AuthorError(words if " - at " in str(error) else f"arguments: {words}") from None

    def describe(self) -> dict[str, Any]:
        """Return the tool as `tools/list` tells it."""
        takes = make_result_schema(self.takes)
        takes["additionalProperties"] = False
        hints = {"readOnlyHint": self.effect == "looks", "destructiveHint": False, "openWorldHint": False}
        return {
            "name": self.name,
            "description": self.about,
            "inputSchema": takes,
            "outputSchema": make_result_schema(self.gives),
            "annotations": hints,
        }


def make_plain(told: Struct) -> dict[str, Any]:
    """Return a result as JSON has it; phrases become their English words."""
    plain: dict[str, Any] = msgspec.to_builtins(told, enc_hook=str)
    return plain


def shorten_lines(lines: list[str]) -> list[str]:
    """Return at most MOST_LINES lines, the last of which says how many more there are."""
    if len(lines) <= MOST_LINES:
        return lines
    return [*lines[: MOST_LINES - 1], f"and {len(lines) - MOST_LINES + 1} more"]
