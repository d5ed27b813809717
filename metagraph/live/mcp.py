"""What may be asked of the character as a language model's tools over the Model Context Protocol, and what
becomes of it as their results. A tool's call is a request of the session like any other.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import msgspec

from metagraph.graph.model import Project
from metagraph.graph.offered import ENGINES, list_tools
from metagraph.live.mcp_protocol import NO_PARAMETERS, McpRequest, ProtocolLine, make_result_schema
from metagraph.live.messages import Reply
from metagraph.speech.spoken_text import read_spoken_line
from metagraph.speech.text_gestures import (
    find_gesture_words,
    make_gesture_requests,
    propose_gestures,
    timed_words,
)

_LOOKS = {
    "status": "What is playing now, and how many requests wait.",
    "describe": "Everything this character can be asked to do: stances, actions and tags by layer, "
    "lines, points.",
}
_RESOURCES = {  # their addresses, and what the session is asked for them
    "metagraph://character": ("describe", "character"),
    "metagraph://now": ("status", "now"),
}


class MadeGesture(msgspec.Struct, frozen=True, omit_defaults=True):
    """A gesture that goes with what is said. word: the one it belongs to. stroke: when its most telling
    moment is wanted. at, until, actions, state, why: as in a reply.
    """

    do: str
    word: str
    state: str
    tags: tuple[str, ...] = ()
    stroke: float | None = None
    at: float | None = None
    until: float | None = None
    actions: tuple[str, ...] = ()
    why: str = ""


def list_play_tools(project: Project) -> list[dict[str, Any]]:
    """Return the tools that move a character as `tools/list` tells them."""
    reply = make_result_schema(Reply)
    gestures = {"type": "array", "items": make_result_schema(MadeGesture)}
    said = make_result_schema(Reply, gestures=gestures)
    made = [
        {
            "name": tool["name"],
            "description": tool["description"],
            "inputSchema": tool["input_schema"],
            "outputSchema": said if tool["name"] == "say" else reply,
        }
        for tool in list_tools(project, ENGINES)
    ]
    for name, words in _LOOKS.items():
        schema = {"type": "object", "properties": {}, "additionalProperties": False}
        hints = {"readOnlyHint": True}
        out = {"type": "object", "properties": {"state": {"type": "string"}}, "required": ["state"]}
        made.append(
            {
                "name": name,
                "description": words,
                "inputSchema": schema,
                "outputSchema": out,
                "annotations": hints,
            }
        )
    return made


@dataclass
class _Said:
    """Something that is said, until all gestures that go with it are answered. made: what became of them so
    far. wanted: how many there are.
    """

    asked: McpRequest
    told: dict[str, Any]
    wanted: int
    made: list[MadeGesture] = field(default_factory=list)


@dataclass(frozen=True)
class _Call:
    """A request that the session has to answer. asked: whose it is. text, words: what is said, where gestures
    go with it. uri: the resource that is read. goes_with: what a gesture goes with, and which gesture it is.
    """

    asked: McpRequest
    text: str = ""
    words: Any = None
    uri: str = ""
    goes_with: tuple[_Said, MadeGesture] | None = None


class McpLine(ProtocolLine):
    """A client that plays the character. take: called with each request as the session has it, and None at
    the end, on the event loop.
    """

    def __init__(
        self,
        project: Project,
        call: Callable[..., object],
        take: Callable[[bytes | None], None],
        source: int = 0,
        target: int = 1,
    ) -> None:
        super().__init__(call, lambda: take(None), source, target)
        self._project, self._ask = project, take
        self._calls: deque[_Call] = deque()  # what the session has not answered yet
        self._tags = {
            layer: {t for x in graph.actions.values() if x.kind == "gesture" for t in x.tags}
            for layer, graph in project.graphs.items()
        }
        self._gestured = 0

    def instruct(self) -> str:
        return _instructions(self._project)

    def list_mcp_tools(self) -> list[dict[str, Any]]:
        return list_play_tools(self._project)

    def list_mcp_resources(self) -> list[dict[str, Any]]:
        return [
            {"uri": uri, "name": name, "description": _LOOKS[word], "mimeType": "application/json"}
            for uri, (word, name) in _RESOURCES.items()
        ]

    def read_resource(self, asked: McpRequest, uri: str) -> bool:
        if uri not in _RESOURCES:
            self.fail_resource(asked, uri)
            return False
        self._calls.append(_Call(asked, uri=uri))
        self._ask(msgspec.json.encode({"do": _RESOURCES[uri][0]}))
        return True

    def call_tool(self, asked: McpRequest, name: str, given: dict[str, Any]) -> bool:
        if name not in (*ENGINES, *_LOOKS):
            self.fail(asked, NO_PARAMETERS, f"there is no tool '{name[:80]}'")
            return False
        request = {key: value for key, value in given.items() if key not in ("do", "after")}
        if "after" in given:
            request["in"] = given["after"]  # as the session calls it
        alone = name == "say" and request.get("gestures", True) is True and not request.get("line")
        text = request.get("text") if alone else None
        if isinstance(text, str):
            text, _ = read_spoken_line(text)
        self._calls.append(_Call(asked, text if isinstance(text, str) else "", request.get("words")))
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
        whole = _Said(said.asked, reply, len(requests))
        for gesture, request in zip(made, requests, strict=True):
            wanted = MadeGesture(gesture.do, gesture.word, "", gesture.tags, request.get("stroke"))
            self._calls.append(_Call(said.asked, goes_with=(whole, wanted)))
            self._ask(msgspec.json.encode(request))
        if not requests:
            self._tell_said(whole)

    def send(self, messages: list[tuple[bytes, bool]]) -> None:
        """Answer tools' calls, in their order; what happens later, and poses, are not told here. What is said
        is answered with the gestures that go with it, when all of them are.
        """
        for data, binary in messages:
            if binary or data.startswith(b'{"event"') or not self._calls:
                continue
            call = self._calls.popleft()
            if call.uri:
                self.answer_resource(call.asked, call.uri, data.decode())
                continue
            told = msgspec.json.decode(data)
            if call.goes_with is not None:
                self._take_gesture(*call.goes_with, told)
            elif call.text and isinstance(told.get("at"), int | float):
                self._gesture(call, told)
            else:
                self._answer_call(call.asked, told, data.decode())

    def _take_gesture(self, said: _Said, wanted: MadeGesture, told: dict[str, Any]) -> None:
        """Take what became of a gesture; answer what it goes with if it is the last one."""
        became = {key: told[key] for key in ("at", "until", "why") if key in told}
        actions, state = tuple(told.get("actions", ())), told.get("state", "refused")
        said.made.append(msgspec.structs.replace(wanted, state=state, actions=actions, **became))
        if len(said.made) == said.wanted:
            self._tell_said(said)

    def _tell_said(self, said: _Said) -> None:
        told = {**said.told, "gestures": msgspec.to_builtins(said.made)}
        self._answer_call(said.asked, told, msgspec.json.encode(told).decode())

    def _answer_call(self, asked: McpRequest, told: dict[str, Any], text: str) -> None:
        self.answer(asked, {
            "content": [{"type": "text", "text": text}],
            "structuredContent": told,
            "isError": "error" in told or told.get("state") == "refused",
        })  # fmt: skip


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
