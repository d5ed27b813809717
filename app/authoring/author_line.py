"""The Model Context Protocol for a program that works on a project: tools, resources, and long jobs as tasks.

Calls are done one at a time, in their order, on the thread that calls `work`. Tasks are those of the
protocol's extension `io.modelcontextprotocol/tasks` (revision 2026-07-28).
"""

from __future__ import annotations

import base64
import queue
import sys
import threading
import uuid
from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import Any

import msgspec

from app.authoring.desk import AuthorDesk
from app.authoring.tool import AuthorError, CallCancelledError, ToolOutcome, make_plain
from metagraph.live.mcp_protocol import NO_PARAMETERS, TASKS, McpRequest, ProtocolLine

WAITING = 100  # calls that wait at most
KEPT = 100  # tasks that are remembered
LIFE = 3_600_000  # milliseconds for which a task is remembered, at least while there are not more
POLL = 500  # milliseconds between two looks at a task
FAILED = -32603  # JSON-RPC: something went wrong here
_RESOURCES = {
    "metagraph://project": ("show_graph", "project", "The stances and actions of the project."),
    "metagraph://history": ("history", "history", "The steps that can be undone and redone."),
}


@dataclass
class _Job:
    """A call that waits or is done. uri: the resource that is read with it. task: its number as a task, ""
    for none. words: how far it is. result, error: what came of it.
    """

    asked: McpRequest
    name: str
    given: dict[str, Any]
    uri: str = ""
    task: str = ""
    words: str = "waiting"
    cancelled: bool = False
    done: bool = False
    result: dict[str, Any] | None = None
    error: dict[str, Any] | None = None
    made: str = field(default_factory=lambda: _now())
    changed: str = field(default_factory=lambda: _now())


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")


class AuthorLine(ProtocolLine):
    """A client that works on a project."""

    def __init__(self, desk: AuthorDesk, source: int = 0, target: int = 1) -> None:
        super().__init__(lambda call, *given: call(*given), self._close, source, target)
        self._desk = desk
        self._queue: queue.Queue[_Job | None] = queue.Queue()
        self._guard = threading.Lock()
        self._jobs: list[_Job] = []  # that are not done
        self._tasks: dict[str, _Job] = {}

    def work(self) -> None:
        """Do calls until the client has gone and all are done."""
        while (job := self._queue.get()) is not None:
            self._do(job)

    # --- what is offered

    def instruct(self) -> str:
        name = self._desk.authored.path.name
        return (
            f"You work on the project '{name}': motion clips become stances, gestures, fidgets and "
            "transitions, of which a character's performances are made. On a new project call import_clips, "
            "propose_labels, accept_proposals, then find_problems and fix_problem, look at what you doubt, "
            "and export. Every edit is one step of the project's history; undo takes it back. run_script "
            "makes many calls one step, and with dry_run tells first what would change. A call that cannot "
            "be done changes nothing and says why."
        )

    def list_mcp_tools(self) -> list[dict[str, Any]]:
        return [tool.describe() for tool in self._desk.tools.values()]

    def list_mcp_resources(self) -> list[dict[str, Any]]:
        return [
            {"uri": uri, "name": name, "description": words, "mimeType": "application/json"}
            for uri, (_, name, words) in _RESOURCES.items()
        ]

    def list_watched(self) -> tuple[str, ...]:
        return tuple(_RESOURCES)

    def tell_edited(self) -> None:
        """Tell those who listen that the project is another one now."""
        self.tell_changed(*_RESOURCES)

    def list_extensions(self) -> dict[str, dict[str, Any]]:
        return {TASKS: {}}

    def read_resource(self, asked: McpRequest, uri: str) -> bool:
        if uri not in _RESOURCES:
            self.fail_resource(asked, uri)
        else:
            self._put(_Job(asked, _RESOURCES[uri][0], {}, uri))
        return False

    def call_tool(self, asked: McpRequest, name: str, given: dict[str, Any]) -> bool:
        tool = self._desk.tools.get(name)
        if tool is None:
            self.fail(asked, NO_PARAMETERS, f"there is no tool '{name[:80]}'")
            return False
        job = _Job(asked, name, given)
        if tool.long and asked.modern and TASKS in asked.extensions:
            job.task = uuid.uuid4().hex
            with self._guard:
                self._tasks[job.task] = job
                self._forget()
            if self._put(job):
                self.answer(asked, {"resultType": "task", **_describe_task(job)})
        else:
            self._put(job)
        return False

    def cancel_request(self, ident: Any) -> None:
        with self._guard:
            for job in self._jobs:
                if job.asked.ident == ident and not job.task:
                    job.cancelled = True

    def answer_extension(self, asked: McpRequest) -> bool:
        if not asked.modern or asked.method not in ("tasks/get", "tasks/cancel", "tasks/update"):
            return False
        with self._guard:
            job = self._tasks.get(str(asked.params.get("taskId")))
            if job is not None and asked.method == "tasks/cancel" and not job.done:
                job.cancelled = True
        if job is None:
            self.fail(asked, NO_PARAMETERS, "there is no such task; one is remembered for an hour")
        elif asked.method == "tasks/get":
            self.answer(asked, _describe_task(job))
        else:
            self.answer(asked, {})  # cancelled soon; and nothing is ever asked of the client
        return True

    # --- what is done

    def _close(self) -> None:
        self._queue.put(None)

    def _put(self, job: _Job) -> bool:
        """Let a call wait for its turn; return whether there is room."""
        with self._guard:
            room = len(self._jobs) < WAITING
            if room:
                self._jobs.append(job)
            else:
                self._tasks.pop(job.task, None)
        if room:
            self._queue.put(job)
        else:
            self.answer(job.asked, _make_refusal(f"{WAITING} calls wait already; wait for their results"))
        return room

    def _do(self, job: _Job) -> None:
        """Do a call and answer it."""

        told = -1.0

        def report(done: float, total: float, words: str) -> None:
            nonlocal told
            if job.cancelled:
                raise CallCancelledError
            job.words, job.changed = words, _now()
            if not job.task and done > told:  # the protocol wants it to grow
                told = done
                self.report_progress(job.asked, done, total, words)

        try:
            if job.cancelled:
                raise CallCancelledError
            job.result = _make_result(self._desk.call(job.name, job.given, report))
        except AuthorError as error:
            job.result = _make_refusal(str(error))
        except CallCancelledError:
            job.cancelled = True
        except Exception as error:  # it must not end the server; nothing was kept
            print(f"{job.name}: {type(error).__name__}: {error}", file=sys.stderr, flush=True)
            job.error = {"code": FAILED, "message": f"{job.name} failed ({type(error).__name__}: {error})"}
        else:
            job.cancelled = False  # it came too late
            if self._desk.tools[job.name].effect in ("edits", "steps") and job.name != "history":
                self.tell_edited()
        with self._guard:
            job.done, job.changed = True, _now()
            self._jobs.remove(job)
        if not job.task:
            self._answer_job(job)

    def _answer_job(self, job: _Job) -> None:
        if job.cancelled and job.result is None and job.error is None:
            return  # who cancels a request waits for no answer
        if job.error is not None:
            self.fail(job.asked, job.error["code"], job.error["message"])
        elif job.uri and job.result is not None and not job.result["isError"]:
            self.answer_resource(job.asked, job.uri, job.result["content"][0]["text"])
        elif job.uri and job.result is not None:
            self.fail(job.asked, FAILED, job.result["content"][0]["text"])
        elif job.result is not None:
            self.answer(job.asked, job.result)

    def _forget(self) -> None:
        """Forget the oldest tasks that are done, where there are too many."""
        done = [ident for ident, job in self._tasks.items() if job.done]
        for ident in done[: max(0, len(self._tasks) - KEPT)]:
            del self._tasks[ident]


def _make_result(outcome: ToolOutcome) -> dict[str, Any]:
    """Return what a tool did as the result of `tools/call`."""
    told = make_plain(outcome.told)
    pictures = [
        {"type": "image", "data": base64.b64encode(png).decode(), "mimeType": "image/png"}
        for png in outcome.pictures
    ]
    return {
        "content": [{"type": "text", "text": msgspec.json.encode(told).decode()}, *pictures],
        "structuredContent": told,
        "isError": False,
    }


def _make_refusal(words: str) -> dict[str, Any]:
    return {
        "content": [{"type": "text", "text": words}],
        "structuredContent": {"error": words},
        "isError": True,
    }


def _describe_task(job: _Job) -> dict[str, Any]:
    """Return a task as it is now."""
    status = "working" if not job.done else "completed" if job.result is not None else "failed"
    if job.done and job.cancelled:
        status = "cancelled"
    out: dict[str, Any] = {
        "taskId": job.task,
        "status": status,
        "statusMessage": job.words,
        "createdAt": job.made,
        "lastUpdatedAt": job.changed,
        "ttlMs": LIFE,
        "pollIntervalMs": POLL,
    }
    if status == "completed":
        out["result"] = {"resultType": "complete", **(job.result or {})}
    if status == "failed":
        out["error"] = job.error
    return out
