"""The Model Context Protocol on standard input and output: what may be asked of the character as a language
model's tools, and what becomes of it as their results.

Revisions 2024-11-05 to 2025-11-25 of the protocol (modelcontextprotocol.io): JSON-RPC 2.0, a message a line;
`initialize`, `ping`, `tools/list`, `tools/call`. A tool's call is a request of the session like any other.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import msgspec

from metagraph import __version__
from metagraph.graph.model import Project
from metagraph.graph.offered import ENGINES, list_tools
from metagraph.live.stdio import StdioLine
from metagraph.speech.spoken_text import read_spoken_line
from metagraph.speech.text_gestures import (
    find_gesture_words,
    make_gesture_requests,
    propose_gestures,
    timed_words,
)

VERSIONS = ("2025-11-25", "2025-06-18", "2025-03-26", "2024-11-05")
BROKEN, NO_REQUEST, NO_METHOD, NO_PARAMETERS = -32700, -32600, -32601, -32602  # JSON-RPC's codes
_LOOKS = {
    "status": "What is playing now, and how many requests wait.",
    "describe": "Everything this character can be asked to do: stances, actions and tags by layer, "
    "lines, points.",
}


def list_mcp_tools(project: Project) -> list[dict[str, Any]]:
    """Return the tools as `tools/list` tells them."""
    made = [
        {"name": tool["name"], "description": tool["description"], "inputSchema": tool["input_schema"]}
        for tool in list_tools(project, ENGINES)
    ]
    for name, words in _LOOKS.items():
        schema = {"type": "object", "properties": {}, "additionalProperties": False}
        hints = {"readOnlyHint": True}
        made.append({"name": name, "description": words, "inputSchema": schema, "annotations": hints})
    return made


_NOBODY = object()  # whose call it is that the line itself made
BATCH = 100  # messages


@dataclass
class _Batch:
    """Messages that were sent together. `wanted` of them are answered; `told` has the answers so far."""

    wanted: int
    told: list[dict[str, Any]] = field(default_factory=list)


class _InBatch(NamedTuple):
    """The id of a message in a batch."""

    ident: Any
    batch: _Batch


class _Call(NamedTuple):
    """A request that the session has to answer. text, words: what is said, where gestures go with it."""

    ident: Any
    text: str = ""
    words: Any = None


class McpLine(StdioLine):
    """The client that started the session, where it speaks this protocol. take: called with each request as
    the session has it, and None at the end, on the event loop.
    """

    def __init__(
        self,
        project: Project,
        call: Callable[..., object],
        take: Callable[[bytes | None], None],
        source: int = 0,
        target: int = 1,
    ) -> None:
        super().__init__(call, self._heard, source, target)
        self._project, self._ask = project, take
        self._calls: deque[_Call] = deque()  # what the session has not answered yet
        self._tags = {
            layer: {t for x in graph.actions.values() if x.kind == "gesture" for t in x.tags}
            for layer, graph in project.graphs.items()
        }
        self._gestured = 0
        self._batch: _Batch | None = None  # the one that is being heard

    def _heard(self, line: bytes | None) -> None:
        if line is None:
            self._ask(None)
            return
        try:
            message = msgspec.json.decode(line)
        except (msgspec.DecodeError, RecursionError) as error:
            self._fail(None, BROKEN, f"it is not JSON ({error})")
            self.answered(1)
            return
        if isinstance(message, list):
            self._heard_batch(message)
            self.answered(1)
        elif not self._hear(message):
            self.answered(1)

    def _heard_batch(self, messages: list[Any]) -> None:
        """Hear the messages of a batch (JSON-RPC 2.0, section 6): its answers go out together."""
        if not 0 < len(messages) <= BATCH:
            self._fail(None, NO_REQUEST, f"a batch has 1 to {BATCH} messages")
            return
        wanted = sum(isinstance(m, dict) and m.get("id") is not None and "method" in m for m in messages)
        self._batch = _Batch(wanted)
        for message in messages:
            self._hear(message)
        self._batch = None

    def _hear(self, message: Any) -> bool:
        """Hear one message; return whether the session has to answer."""
        ident = message.get("id") if isinstance(message, dict) else None
        if not isinstance(message, dict) or not isinstance(message.get("method"), str):
            if not isinstance(message, dict) or not ("result" in message or "error" in message):
                self._fail(ident, NO_REQUEST, "a message needs a 'method'")
            return False  # nothing was asked of the client, so no result is awaited
        if ident is not None and self._batch is not None:
            ident = _InBatch(ident, self._batch)
        parameters = message.get("params")
        return self._called(message["method"], ident, parameters if isinstance(parameters, dict) else {})

    def _called(self, method: str, ident: Any, parameters: dict[str, Any]) -> bool:
        """Do what a message asks for; return whether the session has to answer."""
        if ident is None:
            return False  # a notification: that it is there, or that it waits no more
        if method == "initialize":
            wanted = parameters.get("protocolVersion")
            self._answer(ident, {
                "protocolVersion": wanted if wanted in VERSIONS else VERSIONS[0],
                "capabilities": {"tools": {}},
                "serverInfo": {"name": "metagraph", "version": __version__},
                "instructions": _instructions(self._project),
            })  # fmt: skip
        elif method == "ping":
            self._answer(ident, {})
        elif method == "tools/list":
            self._answer(ident, {"tools": list_mcp_tools(self._project)})
        elif method == "tools/call":
            return self._tool(ident, parameters.get("name"), parameters.get("arguments") or {})
        else:
            self._fail(ident, NO_METHOD, f"there is no method '{method[:80]}'")
        return False

    def _tool(self, ident: Any, name: Any, given: Any) -> bool:
        if name not in (*ENGINES, *_LOOKS):
            self._fail(ident, NO_PARAMETERS, f"there is no tool '{str(name)[:80]}'")
            return False
        if not isinstance(given, dict):
            self._fail(ident, NO_PARAMETERS, "'arguments' should be an object")
            return False
        request = {key: value for key, value in given.items() if key not in ("do", "after")}
        if "after" in given:
            request["in"] = given["after"]  # as the session calls it
        alone = name == "say" and request.get("gestures", True) is True and not request.get("line")
        text = request.get("text") if alone else None
        if isinstance(text, str):
            text, _ = read_spoken_line(text)
        self._calls.append(_Call(ident, text if isinstance(text, str) else "", request.get("words")))
        self._ask(msgspec.json.encode({**request, "do": name}))
        return True

    def _gesture(self, said: _Call, reply: dict[str, Any]) -> None:
        """Ask for the gestures that go with what is said, by its id."""
        try:
            told = [(str(word), float(start), float(end)) for word, start, end in said.words or ()]
        except (TypeError, ValueError):
            told = []  # as objects, or without ends: as long as lips take
        begins = float(reply["at"])
        if told and "since" in reply:  # it is when the first of these words is said
            begins -= told[0][1]
        lexicon = find_gesture_words(said.text)
        made = propose_gestures(timed_words(said.text, told), self._tags, lexicon, self._gestured + 1)
        requests = make_gesture_requests(made, begins, str(reply.get("id", "said")), self._gestured)
        self._gestured += len(requests) or 1
        for request in requests:
            self._calls.append(_Call(_NOBODY))
            self._ask(msgspec.json.encode(request))

    def send(self, messages: list[tuple[bytes, bool]]) -> None:
        """Answer tools' calls, in their order; what happens later, and poses, are not told here."""
        for data, binary in messages:
            if binary or data.startswith(b'{"event"') or not self._calls:
                continue
            told = msgspec.json.decode(data)
            call = self._calls.popleft()
            if call.ident is _NOBODY:
                continue
            if call.text and isinstance(told.get("at"), int | float):
                self._gesture(call, told)
            self._answer(call.ident, {
                "content": [{"type": "text", "text": data.decode()}],
                "structuredContent": told,
                "isError": "error" in told or told.get("state") == "refused",
            })  # fmt: skip

    def _answer(self, ident: Any, result: dict[str, Any]) -> None:
        self._tell_client(ident, {"result": result})

    def _tell_client(self, ident: Any, said: dict[str, Any]) -> None:
        """Send an answer or an error; of a message of a batch, when all of it is answered."""
        batch = ident.batch if isinstance(ident, _InBatch) else None
        message = {"jsonrpc": "2.0", "id": ident.ident if batch is not None else ident, **said}
        if batch is None:
            super().send([(msgspec.json.encode(message), False)])
            return
        batch.told.append(message)
        if len(batch.told) >= batch.wanted:
            super().send([(msgspec.json.encode(batch.told), False)])

    def _fail(self, ident: Any, code: int, words: str) -> None:
        self._tell_client(ident, {"error": {"code": code, "message": words}})


def _instructions(project: Project) -> str:
    """Return what a model should know before it calls a tool."""
    return (
        f"You move the body of a character ('{project.name}') that stands before whom you talk with. It "
        "idles, breathes, blinks and looks about by itself. Call `say` with what you say: gestures that go "
        "with its words are made (`gestures` false leaves them to you). `gesture` with a tag, `nod`, `shake` "
        "and `look` do more where it matters; `mode` 'listening' while the other speaks, 'thinking' "
        "while you prepare an answer, 'reacting' for a second when something surprises you, `mood` when it "
        "changes. Call `interrupt` when the other begins to speak while you do: its result tells what was "
        "heard of your words. Times are seconds; without `at` or `after` things begin as soon as can be. A "
        "result tells when it plays, or in `why` why it does not."
    )
