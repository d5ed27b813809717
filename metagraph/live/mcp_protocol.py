"""The Model Context Protocol on standard input and output, whatever is offered over it.

Revisions 2024-11-05 to 2026-07-28 (modelcontextprotocol.io): JSON-RPC 2.0, a message a line. Up to 2025-11-25
a client begins with `initialize`. Since 2026-07-28 each request says in `_meta` which revision it speaks and
what its client can do, and `server/discover` tells what is here. Both kinds are served side by side.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import msgspec

from metagraph import __version__
from metagraph.live.stdio import StdioLine

MODERN = ("2026-07-28",)  # revisions without a handshake
VERSIONS = ("2025-11-25", "2025-06-18", "2025-03-26", "2024-11-05")  # those that begin with `initialize`
BATCHING = ("2025-03-26", "2024-11-05")  # revisions that have batches
BROKEN, NO_REQUEST, NO_METHOD, NO_PARAMETERS = -32700, -32600, -32601, -32602  # JSON-RPC's codes
NO_RESOURCE = -32002  # up to 2025-11-25; later it is NO_PARAMETERS
NO_VERSION = -32022  # the protocol's code for a revision that is not spoken here
BATCH = 100  # messages
LISTENERS = 16  # requests to listen at a time
OFTEN = 60_000  # milliseconds for which a list of tools or resources may be kept
TASKS = "io.modelcontextprotocol/tasks"  # the extension for long jobs
_PREFIX = "io.modelcontextprotocol/"
_SERVER = {"name": "metagraph", "version": __version__}


@dataclass
class MessageBatch:
    """Messages that were sent together. `wanted` of them are answered; `told` has the answers so far."""

    wanted: int
    told: list[dict[str, Any]] = field(default_factory=list)


@dataclass(frozen=True)
class McpRequest:
    """A request of a client. modern: it speaks a revision without a handshake. extensions: what its client
    declared. progress: the token under which it wants to hear how far its work is; None for not at all.
    """

    ident: Any
    method: str
    params: Mapping[str, Any]
    modern: bool = False
    extensions: frozenset[str] = frozenset()
    progress: str | int | None = None
    batch: MessageBatch | None = None


class ProtocolLine(StdioLine):
    """The client that started this program, where it speaks the protocol. A subclass says what is offered:
    tools, resources, extensions.

    call: brings a line to where it is heard, as in `StdioLine`. end: called when the client has gone.
    """

    def __init__(
        self, call: Callable[..., object], end: Callable[[], object], source: int = 0, target: int = 1
    ) -> None:
        super().__init__(call, self._heard, source, target)
        self._end = end
        self._revision: str | None = None  # as `initialize` agreed; None for clients that do not call it
        self._batch: MessageBatch | None = None  # the one that is being heard
        self._watching: dict[Any, frozenset[str]] = {}  # resources, by who listens to them

    # --- what a subclass offers

    def instruct(self) -> str:
        """Return what a model should know before it calls a tool."""
        return ""

    def list_mcp_tools(self) -> list[dict[str, Any]]:
        """Return the tools as `tools/list` tells them."""
        return []

    def list_mcp_resources(self) -> list[dict[str, Any]]:
        """Return the resources as `resources/list` tells them."""
        return []

    def list_watched(self) -> tuple[str, ...]:
        """Return the addresses of the resources whose changes are reported to who listens."""
        return ()

    def list_extensions(self) -> dict[str, dict[str, Any]]:
        """Return the extensions of the protocol that are understood, with their settings."""
        return {}

    def call_tool(self, asked: McpRequest, name: str, given: dict[str, Any]) -> bool:
        """Call a tool; return whether it is answered later, by something that then reads on."""
        self.fail(asked, NO_PARAMETERS, f"there is no tool '{name[:80]}'")
        return False

    def read_resource(self, asked: McpRequest, uri: str) -> bool:
        """Read a resource; return whether it is answered later, by something that then reads on."""
        self.fail_resource(asked, uri)
        return False

    def answer_extension(self, asked: McpRequest) -> bool:
        """Answer a method of an extension; return whether it is one."""
        return False

    def cancel_request(self, ident: Any) -> None:
        """Stop working on a request, if that can be."""

    # --- answers

    def answer(self, asked: McpRequest, result: dict[str, Any], fresh: int | None = None) -> None:
        """Send a result. fresh: milliseconds for which the client may keep it; None if that is not said."""
        if asked.modern:
            about = {f"{_PREFIX}serverInfo": _SERVER}
            result = {"resultType": "complete", **result, "_meta": {**result.get("_meta", {}), **about}}
            if fresh is not None:
                result |= {"ttlMs": fresh, "cacheScope": "private"}
        self._tell_client(asked, {"result": result})

    def answer_resource(self, asked: McpRequest, uri: str, text: str) -> None:
        """Send what a resource holds now: JSON."""
        content = {"uri": uri, "mimeType": "application/json", "text": text}
        self.answer(asked, {"contents": [content]}, 0)

    def fail(self, asked: McpRequest | None, code: int, words: str, data: Any = None) -> None:
        """Send an error. asked: None if the request could not be read."""
        error = {"code": code, "message": words}
        self._tell_client(asked, {"error": error if data is None else {**error, "data": data}})

    def fail_resource(self, asked: McpRequest, uri: str) -> None:
        """Say that there is no such resource."""
        known = ", ".join(str(one["uri"]) for one in self.list_mcp_resources())
        words = f"there is no resource '{uri[:200]}'; known are {known}"
        self.fail(asked, NO_PARAMETERS if asked.modern else NO_RESOURCE, words, {"uri": uri})

    def report_progress(self, asked: McpRequest, done: float, total: float | None, words: str) -> None:
        """Tell the client how far a request is, if it wants to hear that. done must grow."""
        if asked.progress is None:
            return
        said: dict[str, Any] = {"progressToken": asked.progress, "progress": done, "message": words}
        if total is not None:
            said["total"] = total
        message = {"jsonrpc": "2.0", "method": "notifications/progress", "params": said}
        super().send([(msgspec.json.encode(message), False)])

    def tell_changed(self, *uris: str) -> None:
        """Tell those who listen that resources have changed. May be called on any thread."""
        for ident, wanted in list(self._watching.items()):
            for uri in uris:
                if uri in wanted:
                    self._notify("notifications/resources/updated", ident, {"uri": uri})

    def _notify(self, method: str, listener: Any, params: dict[str, Any]) -> None:
        meta = {f"{_PREFIX}subscriptionId": listener}
        message = {"jsonrpc": "2.0", "method": method, "params": {**params, "_meta": meta}}
        super().send([(msgspec.json.encode(message), False)])

    def _listen(self, asked: McpRequest) -> None:
        """Begin to tell a client what changes; it is answered with changes alone, until it cancels."""
        wanted = asked.params.get("notifications")
        uris = wanted.get("resourceSubscriptions") if isinstance(wanted, dict) else None
        known = [uri for uri in self.list_watched() if isinstance(uris, list) and uri in uris]
        if len(self._watching) >= LISTENERS:
            self.fail(asked, NO_PARAMETERS, f"{LISTENERS} requests listen already; cancel one")
            return
        self._watching[asked.ident] = frozenset(known)
        honoured = {"notifications": {"resourceSubscriptions": known} if known else {}}
        self._notify("notifications/subscriptions/acknowledged", asked.ident, honoured)

    def _tell_client(self, asked: McpRequest | None, said: dict[str, Any]) -> None:
        """Send an answer or an error; of a message of a batch, when all of it is answered."""
        batch = asked.batch if asked is not None else None
        message = {"jsonrpc": "2.0", "id": asked.ident if asked is not None else None, **said}
        if batch is None:
            super().send([(msgspec.json.encode(message), False)])
            return
        batch.told.append(message)
        if len(batch.told) >= batch.wanted:
            super().send([(msgspec.json.encode(batch.told), False)])

    # --- what is heard

    def _heard(self, line: bytes | None) -> None:
        if line is None:
            self._end()
            return
        try:
            message = msgspec.json.decode(line)
        except (msgspec.DecodeError, RecursionError) as error:
            self.fail(None, BROKEN, f"it is not JSON ({error})")
            self.answered(1)
            return
        if isinstance(message, list):
            self._hear_batch(message)
            self.answered(1)
        elif not self._hear(message):
            self.answered(1)

    def _hear_batch(self, messages: list[Any]) -> None:
        """Hear the messages of a batch (JSON-RPC 2.0, section 6): its answers go out together."""
        if self._revision is not None and self._revision not in BATCHING:
            words = f"revision {self._revision} has no batches; send each message on a line of its own"
            self.fail(None, NO_REQUEST, words)
            return
        if not 0 < len(messages) <= BATCH:
            self.fail(None, NO_REQUEST, f"a batch has 1 to {BATCH} messages")
            return
        wanted = sum(isinstance(m, dict) and m.get("id") is not None and "method" in m for m in messages)
        self._batch = MessageBatch(wanted)
        for message in messages:
            self._hear(message)
        self._batch = None

    def _hear(self, message: Any) -> bool:
        """Hear one message; return whether it is answered later."""
        ident = message.get("id") if isinstance(message, dict) else None
        if not isinstance(message, dict) or not isinstance(message.get("method"), str):
            if not isinstance(message, dict) or not ("result" in message or "error" in message):
                self.fail(McpRequest(ident, "", {}), NO_REQUEST, "a message needs a 'method'")
            return False  # nothing was asked of the client, so no result is awaited
        params = message.get("params")
        params = params if isinstance(params, dict) else {}
        if ident is None:  # a notification: that the client is there, or that it waits no more
            if message["method"] == "notifications/cancelled":
                ident = params.get("requestId")
                if isinstance(ident, str | int):
                    self._watching.pop(ident, None)
                self.cancel_request(ident)
            return False
        asked = self._understand(McpRequest(ident, message["method"], params, batch=self._batch))
        return asked is not None and self._called(asked)

    def _understand(self, asked: McpRequest) -> McpRequest | None:
        """Return a request with what its `_meta` says; None if that cannot be served, and is answered."""
        meta = asked.params.get("_meta")
        meta = meta if isinstance(meta, dict) else {}
        token = meta.get("progressToken")
        token = token if isinstance(token, str | int) and not isinstance(token, bool) else None
        known = McpRequest(asked.ident, asked.method, asked.params, progress=token, batch=asked.batch)
        revision = meta.get(f"{_PREFIX}protocolVersion")
        if revision is None:
            if asked.method == "server/discover":
                self.fail(known, NO_PARAMETERS, f"_meta needs '{_PREFIX}protocolVersion'")
                return None
            return known
        if revision not in MODERN:
            data = {"supported": [*MODERN, *VERSIONS], "requested": revision}
            self.fail(known, NO_VERSION, f"revision '{str(revision)[:40]}' is not spoken here", data)
            return None
        can = meta.get(f"{_PREFIX}clientCapabilities")
        if not isinstance(can, dict):
            self.fail(known, NO_PARAMETERS, f"_meta needs '{_PREFIX}clientCapabilities', an object")
            return None
        if asked.batch is not None:
            words = f"revision {revision} has no batches; send each message on a line of its own"
            self.fail(known, NO_REQUEST, words)
            return None
        extensions = can.get("extensions")
        named = frozenset(extensions) if isinstance(extensions, dict) else frozenset[str]()
        return McpRequest(asked.ident, asked.method, asked.params, True, named, token)

    def _called(self, asked: McpRequest) -> bool:
        """Do what a message asks for; return whether it is answered later."""
        method, params = asked.method, asked.params
        if method == "tools/call":
            return self._call_tool(asked)
        if method == "resources/read":
            uri = params.get("uri")
            if isinstance(uri, str):
                return self.read_resource(asked, uri)
            self.fail(asked, NO_PARAMETERS, "'uri' should be a text")
        elif method == "tools/list":
            self.answer(asked, {"tools": self.list_mcp_tools()}, OFTEN)
        elif method == "resources/list":
            self.answer(asked, {"resources": self.list_mcp_resources()}, OFTEN)
        elif method == "resources/templates/list":
            self.answer(asked, {"resourceTemplates": []}, OFTEN)
        elif method == "server/discover":
            about = {"supportedVersions": [*MODERN, *VERSIONS], "capabilities": self._offer(modern=True)}
            self.answer(asked, {**about, "instructions": self.instruct()}, OFTEN)
        elif method == "initialize":
            wanted = params.get("protocolVersion")
            self._revision = wanted if wanted in VERSIONS else VERSIONS[0]
            about = {"protocolVersion": self._revision, "capabilities": self._offer(modern=False)}
            self.answer(asked, {**about, "serverInfo": _SERVER, "instructions": self.instruct()})
        elif method == "subscriptions/listen" and asked.modern:
            self._listen(asked)
        elif method == "ping" and not asked.modern:
            self.answer(asked, {})
        elif not self.answer_extension(asked):
            self.fail(asked, NO_METHOD, f"there is no method '{method[:80]}'")
        return False

    def _offer(self, modern: bool) -> dict[str, Any]:
        offered: dict[str, Any] = {"tools": {}}
        if self.list_mcp_resources():
            offered["resources"] = {"subscribe": True} if modern and self.list_watched() else {}
        if modern and (extensions := self.list_extensions()):
            offered["extensions"] = extensions
        return offered

    def _call_tool(self, asked: McpRequest) -> bool:
        name, given = asked.params.get("name"), asked.params.get("arguments")
        given = {} if given is None else given
        if not isinstance(name, str):
            self.fail(asked, NO_PARAMETERS, "'name' should be a text")
            return False
        if not isinstance(given, dict):
            self.fail(asked, NO_PARAMETERS, "'arguments' should be an object")
            return False
        return self.call_tool(asked, name, given)


def make_result_schema(kind: type[msgspec.Struct], **more: dict[str, Any]) -> dict[str, Any]:
    """Return the JSON Schema (draft 2020-12) of a value as a tool's `outputSchema`, whose root is an object.
    more: further properties.
    """
    (root,), parts = msgspec.json.schema_components([kind], ref_template="#/$defs/{name}")
    schema = dict(parts.pop(kind.__name__, root))
    schema["properties"] = {**schema["properties"], **more}
    return {**schema, "$defs": parts} if parts else schema
