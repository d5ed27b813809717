"""The Model Context Protocol itself: revisions with a handshake and without one, discovery, resources,
batches, errors; also by the protocol's own client.
"""

from __future__ import annotations

import json
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

from metagraph.live.mcp_protocol import (
    BATCHING,
    MODERN,
    NO_METHOD,
    NO_PARAMETERS,
    NO_REQUEST,
    NO_RESOURCE,
    NO_VERSION,
    VERSIONS,
    McpRequest,
    ProtocolLine,
    make_result_schema,
)
from metagraph.live.messages import Reply
from metagraph.live.stdio import StdioLine

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
LIVE = (sys.executable, "-c", "from app.cli.parser import main; raise SystemExit(main())", "live")
CLIENT = HERE / "run" / "mcp_sdk_client.py"
PREFIX = "io.modelcontextprotocol/"


class Echo(ProtocolLine):
    """Offers a tool that answers with what it was given, and a resource."""

    def instruct(self) -> str:
        return "Call echo."

    def list_mcp_tools(self) -> list[dict[str, Any]]:
        return [{"name": "echo", "inputSchema": {"type": "object"}}]

    def list_mcp_resources(self) -> list[dict[str, Any]]:
        return [{"uri": "metagraph://one", "name": "one"}]

    def call_tool(self, asked: McpRequest, name: str, given: dict[str, Any]) -> bool:
        if name != "echo":
            return super().call_tool(asked, name, given)
        self.report_progress(asked, 1, 2, "half")
        self.answer(asked, {"content": [], "structuredContent": given})
        return False

    def read_resource(self, asked: McpRequest, uri: str) -> bool:
        if uri != "metagraph://one":
            return super().read_resource(asked, uri)
        self.answer_resource(asked, uri, "1")
        return False


class Said:
    """A line, and what its client reads."""

    def __init__(self, patch: pytest.MonkeyPatch) -> None:
        self.told: list[Any] = []
        patch.setattr(
            StdioLine, "send", lambda line, messages: self.told.extend(json.loads(m) for m, _ in messages)
        )
        patch.setattr(StdioLine, "answered", lambda line, count: None)
        self.line = Echo(lambda call, *given: call(*given), lambda: None)

    def hear(self, message: Any) -> Any:
        """Hear a message; return the last answer."""
        before = len(self.told)
        self.line._heard(json.dumps(message).encode())
        return self.told[-1] if len(self.told) > before else None

    def ask(self, method: str, revision: str | None = MODERN[0], **params: Any) -> Any:
        meta = params.pop("_meta", {})
        if revision is not None:
            meta = {
                f"{PREFIX}protocolVersion": revision,
                f"{PREFIX}clientCapabilities": {},
                **meta,
            }
        return self.hear({"jsonrpc": "2.0", "id": 1, "method": method, "params": {**params, "_meta": meta}})


@pytest.fixture
def said(monkeypatch: pytest.MonkeyPatch) -> Said:
    return Said(monkeypatch)


def test_discovery_tells_the_revisions_what_is_offered_and_how_long_that_holds(said: Said) -> None:
    found = said.ask("server/discover")["result"]
    assert found["supportedVersions"] == [*MODERN, *VERSIONS] and found["resultType"] == "complete"
    assert found["capabilities"] == {"tools": {}, "resources": {}} and found["instructions"] == "Call echo."
    assert found["ttlMs"] > 0 and found["cacheScope"] == "private"
    assert found["_meta"][f"{PREFIX}serverInfo"]["name"] == "metagraph"


def test_each_result_of_the_newest_revision_has_a_type_and_those_before_have_none(said: Said) -> None:
    newest = said.ask("tools/call", name="echo", arguments={"a": 1})["result"]
    assert newest["resultType"] == "complete" and newest["structuredContent"] == {"a": 1}
    before = said.ask("tools/call", None, name="echo", arguments={"a": 1})["result"]
    assert before == {"content": [], "structuredContent": {"a": 1}}
    assert (
        "ttlMs" in said.ask("tools/list")["result"] and "ttlMs" not in said.ask("tools/list", None)["result"]
    )


@pytest.mark.parametrize("revision", ["1900-01-01", "2025-11-25", 7])
def test_another_revision_in_a_request_is_refused_with_those_that_are_spoken(
    said: Said, revision: Any
) -> None:
    error = said.ask("tools/list", revision)["error"]
    assert error["code"] == NO_VERSION
    assert error["data"] == {"supported": [*MODERN, *VERSIONS], "requested": revision}


def test_a_request_without_what_its_client_can_do_is_refused(said: Said) -> None:
    error = said.ask("tools/list", _meta={f"{PREFIX}clientCapabilities": None})["error"]
    assert error["code"] == NO_PARAMETERS and "clientCapabilities" in error["message"]
    error = said.ask("server/discover", None)["error"]
    assert error["code"] == NO_PARAMETERS and "protocolVersion" in error["message"]


def test_ping_is_gone_in_the_newest_revision_alone(said: Said) -> None:
    assert said.ask("ping")["error"]["code"] == NO_METHOD
    assert said.ask("ping", None)["result"] == {}


def test_a_resource_is_read_and_one_that_is_not_there_is_an_error_that_names_those_that_are(
    said: Said,
) -> None:
    read = said.ask("resources/read", uri="metagraph://one")["result"]
    assert read["contents"] == [{"uri": "metagraph://one", "mimeType": "application/json", "text": "1"}]
    for revision, code in ((MODERN[0], NO_PARAMETERS), (None, NO_RESOURCE)):
        error = said.ask("resources/read", revision, uri="metagraph://two")["error"]
        assert error["code"] == code and "metagraph://one" in error["message"]
    assert said.ask("resources/read")["error"]["code"] == NO_PARAMETERS
    assert said.ask("resources/templates/list")["result"]["resourceTemplates"] == []


@pytest.mark.parametrize("revision", VERSIONS)
def test_batches_are_heard_where_the_revision_has_them(said: Said, revision: str) -> None:
    said.ask("initialize", None, protocolVersion=revision)
    told = said.hear([{"jsonrpc": "2.0", "id": 5, "method": "ping"}])
    if revision in BATCHING:
        assert told == [{"jsonrpc": "2.0", "id": 5, "result": {}}]
    else:
        assert told["error"]["code"] == NO_REQUEST and "no batches" in told["error"]["message"]


def test_a_message_of_the_newest_revision_is_refused_in_a_batch(said: Said) -> None:
    meta = {f"{PREFIX}protocolVersion": MODERN[0], f"{PREFIX}clientCapabilities": {}}
    (told,) = said.hear([{"jsonrpc": "2.0", "id": 5, "method": "tools/list", "params": {"_meta": meta}}])
    assert told["error"]["code"] == NO_REQUEST


def test_who_listens_is_told_what_is_honoured_and_too_many_are_refused(said: Said) -> None:
    assert said.ask("subscriptions/listen", None)["error"]["code"] == NO_METHOD
    told = said.ask("subscriptions/listen", notifications={"resourceSubscriptions": ["metagraph://one"]})
    assert told["method"] == "notifications/subscriptions/acknowledged"
    assert told["params"] == {"notifications": {}, "_meta": {f"{PREFIX}subscriptionId": 1}}
    for number in range(2, 18):
        said.line._watching[number] = frozenset()
    assert "cancel one" in said.ask("subscriptions/listen", notifications={})["error"]["message"]


def test_progress_is_told_to_those_who_give_a_token_alone(said: Said) -> None:
    said.ask("tools/call", name="echo", _meta={"progressToken": "p"})
    progress = {"progressToken": "p", "progress": 1, "total": 2, "message": "half"}
    assert said.told[0] == {"jsonrpc": "2.0", "method": "notifications/progress", "params": progress}
    said.told.clear()
    said.ask("tools/call", name="echo")
    assert len(said.told) == 1


def test_the_schema_of_a_result_has_an_object_at_its_root_and_what_it_refers_to() -> None:
    schema = make_result_schema(Reply, gestures={"type": "array"})
    assert schema["type"] == "object" and schema["properties"]["gestures"] == {"type": "array"}
    assert set(schema["$defs"]) == {"Part"}


@pytest.mark.parametrize("mode", ["legacy", "auto", *MODERN])
def test_the_protocols_own_client_plays_the_character(tmp_path: Path, mode: str) -> None:
    if find_spec("mcp") is None:
        pytest.skip("needs the package mcp 2.3 or newer (pip install mcp)")
    calls = tmp_path / "calls.json"
    calls.write_text(
        json.dumps(
            [
                ["gesture", {"tags": ["greeting"]}],
                ["say", {"text": "Hello! How are you?", "after": 0.5}],
                ["action", {"action": "backflip"}],
            ]
        )
    )
    command = [sys.executable, str(CLIENT), mode, str(calls), *LIVE]
    command += [str(ROOT / "sample_clips" / "sample.metagraph.yaml"), "--mcp", "--seed", "3", "--no-idle"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr[-2000:]
    told = json.loads(done.stdout)
    assert told["revision"] == (VERSIONS[0] if mode == "legacy" else MODERN[0])
    assert all(told["tools"].values()) and "gesture" in told["tools"]  # each has an output schema
    assert set(told["resources"]) == {"metagraph://character", "metagraph://now"}
    assert told["resources"]["metagraph://now"]["t"] > 0
    greeting, say, flip = told["results"]
    assert greeting["told"]["actions"] == ["wave_hello_rt_01"] and not greeting["isError"]
    assert say["told"]["gestures"] and say["told"]["gestures"][0]["word"]
    assert flip["isError"] and "backflip" in flip["told"]["why"]
