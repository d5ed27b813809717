"""The Model Context Protocol: tools, calls and what becomes of them; also by a client that is not ours."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph.model import Project
from metagraph.graph.offered import ENGINES
from metagraph.live.mcp import McpLine, list_play_tools
from metagraph.live.mcp_protocol import BROKEN, NO_METHOD, NO_PARAMETERS, NO_REQUEST, VERSIONS
from metagraph.live.stdio import StdioLine

HERE = Path(__file__).parent
ROOT = HERE.parents[1]


class Session:
    """A line whose other sides are lists. asked: what the session is asked; told: what the client reads."""

    def __init__(self, project: Project, patch: pytest.MonkeyPatch) -> None:
        self.asked: list[bytes | None] = []
        self.told: list[dict[str, Any]] = []
        self.room = 0
        patch.setattr(
            StdioLine, "send", lambda line, messages: self.told.extend(json.loads(m) for m, _ in messages)
        )
        patch.setattr(StdioLine, "answered", lambda line, count: self._answered(count))
        self.line = McpLine(project, lambda call, *given: call(*given), self.asked.append)

    def _answered(self, count: int) -> None:
        self.room += count

    def heard(self, message: Any) -> dict[str, Any] | None:
        """Hear a message; return what was answered at once."""
        before = len(self.told)
        self.line._heard(message if isinstance(message, bytes) else json.dumps(message).encode())
        return self.told[before] if len(self.told) > before else None

    def called(self, method: str, ident: Any = 1, **parameters: Any) -> dict[str, Any] | None:
        return self.heard({"jsonrpc": "2.0", "id": ident, "method": method, "params": parameters})


@pytest.fixture
def session(sample: Project, monkeypatch: pytest.MonkeyPatch) -> Session:
    return Session(sample, monkeypatch)


@pytest.mark.parametrize("wanted", [*VERSIONS, "1999-01-01", None])
def test_it_speaks_the_clients_revision_where_it_knows_it(session: Session, wanted: str | None) -> None:
    told = session.called("initialize", protocolVersion=wanted)
    assert told is not None and told["id"] == 1 and session.room == 1
    assert told["result"]["protocolVersion"] == (wanted if wanted in VERSIONS else VERSIONS[0])
    assert "sample" in told["result"]["instructions"]


def test_its_tools_are_what_runtimes_take_and_two_to_look(session: Session, sample: Project) -> None:
    told = session.called("tools/list")
    assert told is not None and told["result"]["tools"] == json.loads(json.dumps(list_play_tools(sample)))
    tools = {tool["name"]: tool for tool in told["result"]["tools"]}
    assert set(tools) == {*ENGINES, "status", "describe"}
    assert "greeting" in tools["gesture"]["inputSchema"]["properties"]["tags"]["items"]["enum"]
    assert all(tool["inputSchema"]["type"] == "object" for tool in tools.values())


def test_calls_are_requests_and_answers_find_their_calls_in_order(session: Session) -> None:
    assert (
        session.called("tools/call", "a", name="gesture", arguments={"tags": ["greeting"], "after": 2})
        is None
    )
    assert session.called("tools/call", "b", name="nod") is None
    assert session.called("ping", "c") == {"jsonrpc": "2.0", "id": "c", "result": {}}
    assert [json.loads(x or b"") for x in session.asked] == [
        {"tags": ["greeting"], "in": 2, "do": "gesture"},
        {"do": "nod"},
    ]
    session.line.send(
        [(b'{"event":"begin"}', False), (b"pose", True), (b'{"state":"planned","at":1.5}', False)]
    )
    session.line.send([(b'{"state":"refused","why":"no"}', False), (b'{"state":"done"}', False)])
    first, second = session.told[-2:]
    assert first["id"] == "a" and not first["result"]["isError"]
    assert first["result"]["structuredContent"] == {"state": "planned", "at": 1.5}
    assert (
        second["id"] == "b"
        and second["result"]["isError"]
        and '"no"' in second["result"]["content"][0]["text"]
    )


def test_gestures_go_with_what_is_said_on_its_words_and_answer_to_nobody(session: Session) -> None:
    text = "Hello everybody, it is really wonderful to see you."
    for said in ({"text": text}, {"text": text, "gestures": False}, {"line": "hello", "text": text}):
        session.called("tools/call", json.dumps(said), name="say", arguments=said)
    session.line.send([(b'{"state":"planned","at":4.0}', False)] * 3)
    asked = [json.loads(x or b"") for x in session.asked[3:]]
    assert next(x["tags"] for x in asked if x["do"] == "gesture") == ["greeting"] and len(asked) >= 2
    assert all(x["stroke"] >= 4.0 and x["late"] > 0 for x in asked if x["do"] == "gesture")
    assert len(session.told) == 2  # what has gestures waits for what becomes of them
    session.line.send([(b'{"state":"planned","at":4.2,"actions":["wave"]}', False)] * (len(asked) - 1))
    session.line.send([(b'{"state":"refused","why":"too late"}', False)])
    assert len(session.told) == 3  # of the calls alone
    told = session.told[-1]["result"]["structuredContent"]
    assert told["at"] == 4.0 and len(told["gestures"]) == len(asked)
    greeting, *_, last = told["gestures"]
    assert greeting["word"] == "Hello" and greeting["actions"] == ["wave"] and greeting["at"] == 4.2
    assert last["state"] == "refused" and last["why"] == "too late"
    told = {"text": "Well, hello", "words": [["Well", 0.1, 0.4], ["hello", 3.0, 3.6]]}
    session.called("tools/call", name="say", arguments=told)
    session.line.send([(b'{"state":"planned","at":1.0}', False)])
    assert json.loads(session.asked[-1] or b"")["stroke"] == pytest.approx(4.1)


def test_what_cannot_be_understood_is_told_and_what_waits_for_no_answer_gets_none(session: Session) -> None:
    def code(message: Any) -> int | None:
        told = session.heard(message)
        return None if told is None else told["error"]["code"]

    assert code(b"{") == BROKEN and code(b"[" * 100_000) == BROKEN
    assert (
        code([1]) == NO_REQUEST
        and code({"id": 3}) == NO_REQUEST
        and code({"id": 3, "method": 4}) == NO_REQUEST
    )
    assert code({"id": 3, "method": "prompts/list"}) == NO_METHOD
    assert code({"id": 3, "method": "tools/call", "params": {"name": "bml"}}) == NO_PARAMETERS
    assert (
        code({"id": 3, "method": "tools/call", "params": {"name": "nod", "arguments": [1]}}) == NO_PARAMETERS
    )
    assert code({"id": 3, "method": "tools/call", "params": 7}) == NO_PARAMETERS
    assert code({"method": "notifications/initialized"}) is None
    assert code({"id": 9, "result": {}}) is None
    assert session.asked == [] and session.room == 11  # as many may come after them
    session.line._heard(None)
    assert session.asked == [None]


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.text(max_size=5),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(
            st.sampled_from(["id", "method", "params", "name", "arguments", "do"]), inner, max_size=4
        )
    ),
    max_leaves=12,
)


@given(JSON)
def test_whatever_is_said_is_survived(sample: Project, message: Any) -> None:
    with pytest.MonkeyPatch.context() as patch:
        session = Session(sample, patch)
        session.heard(message)
        assert session.room + len(session.asked) == 1


def test_a_client_that_is_not_ours_moves_the_character(tmp_path: Path) -> None:
    modules = HERE.parent / "node_modules" / "@modelcontextprotocol"
    if shutil.which("node") is None or not modules.is_dir():
        pytest.skip("needs Node and @modelcontextprotocol/sdk (python3 run.py test fetches it where npm is)")
    calls = [
        ["gesture", {"tags": ["greeting"]}],
        ["say", {"text": "Hello! How are you?", "after": 0.5}],
        ["action", {"action": "backflip"}],
        ["describe", {}],
        ["status", {}],
    ]
    (tmp_path / "calls.json").write_text(json.dumps(calls))
    live = [sys.executable, "-c", "from app.cli.parser import main; raise SystemExit(main())", "live"]
    script = tmp_path / "client.mjs"  # beside its packages, for Node
    (tmp_path / "node_modules").symlink_to(HERE.parent / "node_modules")
    shutil.copyfile(HERE / "run" / "mcp_client.mjs", script)
    command = ["node", str(script), str(tmp_path / "calls.json"), *live]
    command += [str(ROOT / "sample_clips" / "sample.metagraph.yaml"), "--mcp", "--seed", "3", "--no-idle"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr[-2000:]
    told = json.loads(done.stdout)
    assert told["name"] == "metagraph" and "gesture" in told["tools"]
    greeting, said, flip, described, playing = told["results"]
    assert greeting["told"]["actions"] == ["wave_hello_rt_01"] and not greeting["isError"]
    assert said["told"]["state"] == "planned" and said["told"]["at"] > 0.4
    assert flip["isError"] and "backflip" in flip["told"]["why"]
    assert described["told"]["project"] == "sample" and playing["told"]["t"] > 0


def test_what_a_text_made_goes_by_its_id_and_begins_with_its_own_words(session: Session) -> None:
    said = {"text": "Hello there! This is a very big idea.", "id": "answer"}
    session.called("tools/call", name="say", arguments=said)
    session.line.send([(b'{"id":"answer","state":"planned","at":1.0}', False)])
    made = [json.loads(x or b"") for x in session.asked[1:]]
    assert made and [x["id"] for x in made] == [f"answer/{n}" for n in range(len(made))]
    session.line.send([(b'{"state":"planned"}', False)] * len(made))
    before = len(session.asked)
    words = [["Hello", 2.0, 2.4], ["again", 2.5, 3.0]]
    more = {"text": "Hello again", "id": "answer", "words": words}
    session.called("tools/call", name="say", arguments=more)
    session.line.send([(b'{"id":"answer","state":"planned","at":4.0,"since":1.0}', False)])
    added = [json.loads(x or b"") for x in session.asked[before + 1 :]]
    assert added[0]["id"] == f"answer/{len(made)}" and added[0]["stroke"] == pytest.approx(4.0, abs=0.5)


@pytest.mark.parametrize("count", [0, 101])
def test_an_empty_batch_and_a_huge_one_are_refused(session: Session, count: int) -> None:
    session.line._heard(json.dumps([{"jsonrpc": "2.0", "id": 1, "method": "ping"}] * count).encode())
    assert session.told[-1]["error"]["code"] == NO_REQUEST


def test_a_batch_is_answered_together_when_all_of_it_is(session: Session) -> None:
    batch = [
        {"jsonrpc": "2.0", "id": "a", "method": "ping"},
        {"jsonrpc": "2.0", "method": "notifications/initialized"},
        {"jsonrpc": "2.0", "id": "b", "method": "tools/call", "params": {"name": "blink", "arguments": {}}},
        {"jsonrpc": "2.0", "id": "c", "method": "none"},
    ]
    before = len(session.told)
    session.line._heard(json.dumps(batch).encode())
    assert len(session.told) == before
    session.line.send([(b'{"state":"planned"}', False)])
    told = session.told[-1]
    assert len(session.told) == before + 1 and [x["id"] for x in told] == ["a", "c", "b"]
    assert told[1]["error"]["code"] == NO_METHOD


def test_what_is_said_without_gestures_to_make_is_answered_at_once(session: Session) -> None:
    session.called("tools/call", name="say", arguments={"text": "Mm."})
    session.line.send([(b'{"state":"planned","at":1.0}', False)])
    made = len(session.asked) - 1
    session.line.send([(b'{"state":"planned"}', False)] * made)
    assert len(session.told[-1]["result"]["structuredContent"]["gestures"]) == made == 0


def test_resources_are_what_can_be_asked_and_what_plays_now(session: Session) -> None:
    listed = session.called("resources/list")
    assert listed is not None
    assert [one["uri"] for one in listed["result"]["resources"]] == [
        "metagraph://character",
        "metagraph://now",
    ]
    session.called("resources/read", uri="metagraph://now")
    assert json.loads(session.asked[-1] or b"") == {"do": "status"}
    session.line.send([(b'{"state":"done","t":1.5}', False)])
    (content,) = session.told[-1]["result"]["contents"]
    assert content["uri"] == "metagraph://now" and json.loads(content["text"]) == {"state": "done", "t": 1.5}
