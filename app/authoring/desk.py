"""Do what a program asks of a project: call tools, keep what they edit as steps, undo them, and run scripts
of calls as one step.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, Protocol

from msgspec import Meta, Struct

from app.authoring import (
    check_tools,
    edit_tools,
    file_tools,
    label_tools,
    listing_tools,
    pictures,
    play_tools,
)
from app.authoring.tool import (
    AuthorError,
    AuthorTool,
    EditReport,
    LastRehearsal,
    NoFields,
    Report,
    ToolOutcome,
    ToolWork,
    make_plain,
    shorten_lines,
)
from app.translation import tr
from metagraph.engines.export_error import ExportError
from metagraph.errors import FileError, describe_error
from metagraph.formats.project.limits import find_unwritable
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing.differences import describe_differences
from metagraph.graph.editing.half_labels import place_complete
from metagraph.graph.edits import find_added_actions
from metagraph.graph.model import Project

EXPLAINED = (AuthorError, EditError, FileError, ExportError, ValueError)  # what says why, in words
MOST_CALLS = 200  # of a script


class AuthoredProject(Protocol):
    """The project that is worked on: a file, or what a window has open. roots: folders that may be used."""

    roots: tuple[Path, ...]

    @property
    def project(self) -> Project: ...
    @property
    def path(self) -> Path: ...

    def hold(self) -> AbstractContextManager[object]:
        """Keep others from changing the project meanwhile. Raises AuthorError or FileError if one has it."""

    def find_refusal(self) -> str:
        """Return why nothing may be edited now, "" if it may."""

    def commit(self, title: str, after: Project) -> str:
        """Make the project this one, as one step; return the step's name. Raises FileError."""

    def list_steps(self) -> tuple[Sequence[str], Sequence[str]]:
        """Return the names of the steps that can be undone, the last one last, and of those that can be done
        again, the next one first.
        """

    def undo(self) -> None:
        """Undo the last step. Raises FileError."""

    def redo(self) -> None:
        """Do the next step again. Raises FileError."""


class StepCount(Struct, forbid_unknown_fields=True, omit_defaults=True):
    """steps: how many."""

    steps: Annotated[int, Meta(ge=1, le=100)] = 1


class History(Struct):
    """done: the steps that can be undone, the last one last. undone: those that redo does again, the next one
    first.
    """

    done: list[str]
    undone: list[str]


class ScriptCall(Struct, forbid_unknown_fields=True):
    """A call of a script."""

    tool: str
    arguments: dict[str, Any] = {}


class RunScript(Struct, forbid_unknown_fields=True, omit_defaults=True):
    """calls: in order; each sees what those before it did. name: of the one step that all of them are.
    dry_run: do everything but keep nothing, and tell what would change.
    """

    calls: Annotated[list[ScriptCall], Meta(min_length=1, max_length=MOST_CALLS)]
    name: Annotated[str, Meta(max_length=100)] = ""
    dry_run: bool = False


class ScriptReport(Struct, omit_defaults=True):
    """results: of each call, in order. step: the name of the step; "" for a dry run, and if nothing was
    edited. changes: what is different after all of them.
    """

    results: list[Any]
    step: str = ""
    changes: list[str] = []
    dry_run: bool = False


def list_author_tools() -> dict[str, AuthorTool]:
    """Return the tools by name, in the order in which they are used on a new project."""
    modules = (listing_tools, label_tools, edit_tools, check_tools, pictures, play_tools, file_tools)
    return {tool.name: tool for tool in (*(tool for m in modules for tool in m.TOOLS), *_STEPS)}


class AuthorDesk:
    """Calls tools on a project."""

    def __init__(self, authored: AuthoredProject) -> None:
        self.authored = authored
        self.tools = list_author_tools()
        self._rehearsal = LastRehearsal()

    def call(self, name: str, given: dict[str, Any], report: Report) -> ToolOutcome:
        """Return what a tool did. Raises AuthorError, whose message says why it cannot be done, after which
        nothing is different; CallCancelledError if `report` raises it.
        """
        if name not in self.tools:
            raise AuthorError(f"there is no tool '{name}'; there are {', '.join(self.tools)}")
        tool = self.tools[name]
        fields = tool.read(given)
        try:
            with self.authored.hold():
                return self._do(tool, fields, report)
        except EXPLAINED as error:
            raise error if isinstance(error, AuthorError) else AuthorError(_explain(error)) from error

    def _do(self, tool: AuthorTool, fields: Struct, report: Report) -> ToolOutcome:
        if tool.effect in ("edits", "steps") and tool.name != "history":
            why = self.authored.find_refusal()
            if why and not (isinstance(fields, RunScript) and fields.dry_run):
                raise AuthorError(why)
        if isinstance(fields, RunScript):
            return self._run_script(fields, report)
        if tool.effect == "steps":
            return self._step(tool.name, fields)
        outcome = tool.does(self._work(self.authored.project, report), fields)
        if tool.effect == "edits":
            before = self.authored.project
            outcome = settle_edit(before, outcome)
            assert outcome.project is not None
            step = self.authored.commit(outcome.title or tr(tool.title), outcome.project)
            assert isinstance(outcome.told, EditReport)
            outcome.told.step = step
        return outcome

    def _work(self, project: Project, report: Report) -> ToolWork:
        path = self.authored.path
        return ToolWork(project, path.resolve().parent, path, self.authored.roots, report, self._rehearsal)

    def _step(self, name: str, fields: Struct) -> ToolOutcome:
        """Undo or do again, and tell the history."""
        moves: dict[str, tuple[int, Callable[[], None]]] = {
            "undo": (0, self.authored.undo),
            "redo": (1, self.authored.redo),
        }
        if name in moves and isinstance(fields, StepCount):
            which, move = moves[name]
            there = len(self.authored.list_steps()[which])
            if there < fields.steps:
                many = f"steps: there are {there} to {name}, not {fields.steps}"
                raise AuthorError(many if there else f"there is nothing to {name}")
            for _ in range(fields.steps):
                move()
        done, undone = self.authored.list_steps()
        return ToolOutcome(History(list(done), list(undone)))

    def _run_script(self, script: RunScript, report: Report) -> ToolOutcome:
        """Do all calls on a project that is kept only at the end."""
        before = project = self.authored.project
        results: list[Any] = []
        shown: list[bytes] = []
        for number, call in enumerate(script.calls, 1):
            tell = _report_within(report, number - 1, len(script.calls))
            tell(0, 1, call.tool)
            try:
                outcome = self._call_of_script(project, call, tell)
            except EXPLAINED as error:
                words = error if isinstance(error, AuthorError) else _explain(error)
                kept = "Nothing was changed"
                raise AuthorError(f"call {number} ({call.tool}): {words}. {kept}") from error
            if outcome.project is not None:
                project = outcome.project
            results.append(make_plain(outcome.told))
            shown += outcome.pictures
        changes = shorten_lines([str(line) for line in describe_differences(before, project)])
        told = ScriptReport(results, "", changes, script.dry_run)
        if not script.dry_run and project is not before:
            told.step = self.authored.commit(
                script.name or tr("Script of {count} calls", count=len(results)), project
            )
        return ToolOutcome(told, pictures=tuple(shown))

    def _call_of_script(self, project: Project, call: ScriptCall, report: Report) -> ToolOutcome:
        tool = self.tools.get(call.tool)
        if tool is None:
            raise AuthorError(f"there is no tool '{call.tool}'")
        if tool.effect not in ("looks", "edits"):
            raise AuthorError("it cannot be part of a script, because it cannot be taken back; call it after")
        outcome = tool.does(self._work(project, report), tool.read(call.arguments))
        return settle_edit(project, outcome) if tool.effect == "edits" else outcome


def _report_within(report: Report, call: int, calls: int) -> Report:
    """Return what reports how far a call of a script is as how far the script is."""

    def tell(done: float, total: float, words: str) -> None:
        share = min(1.0, done / total) if total > 0 else 0.0
        report(call + share, calls, f"call {call + 1} of {calls}: {words}")

    return tell


def settle_edit(before: Project, outcome: ToolOutcome) -> ToolOutcome:
    """Return what an edit did with its changes in words, and clips placed whose labels are complete now.
    Raises AuthorError if it changed nothing, or if no file could hold it.
    """
    after, told = outcome.project, outcome.told
    assert after is not None and isinstance(told, EditReport)
    if after.graphs is not before.graphs and after.marks:
        after = place_complete(after)
    changes = [str(line) for line in describe_differences(before, after)]
    if after is before or (after == before and not changes):
        raise AuthorError("nothing changed: it is already as the call says")
    why = find_unwritable(before, after)
    if why is not None:
        raise AuthorError(str(why))
    told.changes = shorten_lines(changes)
    told.actions = list(find_added_actions(before, after))
    return replace(outcome, project=after)


def _explain(error: BaseException) -> str:
    return str(describe_error(error)).rstrip(".")


def _never(work: ToolWork, given: Struct) -> ToolOutcome:
    raise AssertionError("the desk does this itself")


_STEPS = (
    AuthorTool("undo", "Undo the last steps, whoever made them.", StepCount, History, _never, "steps"),
    AuthorTool("redo", "Do undone steps again.", StepCount, History, _never, "steps"),
    AuthorTool(
        "history", "List the steps that can be undone and redone.", NoFields, History, _never, "steps"
    ),
    AuthorTool(
        "run_script",
        "Run several calls as one step: all of them are kept, or none. `dry_run` tells what would change.",
        RunScript,
        ScriptReport,
        _never,
        "steps",
        long=True,
    ),
)
