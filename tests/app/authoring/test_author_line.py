"""A project worked on over the Model Context Protocol: results, pictures, progress, tasks, cancelling; also by the
protocol's own client, and by a script that takes a folder to an export.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from importlib.util import find_spec
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from app.authoring import author_line
from app.authoring.author_line import FAILED, AuthorLine
from app.authoring.desk import AuthorDesk
from app.authoring.tool import AuthorTool, NoFields, ToolOutcome
from metagraph.live.mcp_protocol import MODERN, NO_METHOD, NO_PARAMETERS, TASKS, VERSIONS
from metagraph.live.stdio import StdioLine

ROOT = Path(__file__).parents[3]
AUTHOR = (sys.executable, "-c", "from app.cli.parser import main; raise SystemExit(main())", "author")
CLIENT = ROOT / "tests" / "live" / "run" / "mcp_sdk_client.py"
SCRIPT = ROOT / "docs" / "clients" / "author_folder.py"
DATA = ROOT.parent / "shared" / "data" / "kaykit-rogue"
PREFIX = "io.modelcontextprotocol/"
WAVE = "wave_hello_rt_01"


class Client:
    """A client whose calls are done when it wants."""

    def __init__(self, desk: AuthorDesk, patch: pytest.MonkeyPatch) -> None:
        self.told: list[dict[str, Any]] = []
        patch.setattr(
            StdioLine, "send", lambda line, messages: self.told.extend(json.loads(m) for m, _ in messages)
        )
        patch.setattr(StdioLine, "answered", lambda line, count: None)
        self.line = AuthorLine(desk)
        self.number = 0

    def send(self, method: str, tasks: bool = False, token: str | None = None, **params: Any) -> int:
        self.number += 1
        meta: dict[str, Any] = {
            f"{PREFIX}protocolVersion": MODERN[0],
            f"{PREFIX}clientCapabilities": {"extensions": {TASKS: {}}} if tasks else {},
        }
        if token is not None:
            meta["progressToken"] = token
        message = {"jsonrpc": "2.0", "id": self.number, "method": method, "params": {**params, "_meta": meta}}
        self.line._heard(json.dumps(message).encode())
        return self.number

    def work(self) -> None:
        """Do all calls that wait."""
        self.line._close()
        self.line.work()

    def answer(self, number: int) -> dict[str, Any]:
        (told,) = [message for message in self.told if message.get("id") == number]
        return told

    def ask(self, method: str, **given: Any) -> dict[str, Any]:
        number = self.send(method, **given)
        self.work()
        return self.answer(number)


@pytest.fixture
def client(desk: AuthorDesk, monkeypatch: pytest.MonkeyPatch) -> Client:
    return Client(desk, monkeypatch)


def test_what_is_offered_is_told(client: Client) -> None:
    found = client.ask("server/discover")["result"]
    assert found["capabilities"]["extensions"] == {TASKS: {}} and "sample" in found["instructions"]
    tools = {tool["name"] for tool in client.ask("tools/list")["result"]["tools"]}
    wanted = "list_clips propose_labels set_labels edit_action find_problems fix_problem look count_rates"
    assert {*wanted.split(), "export", "merge", "undo", "redo", "history", "run_script"} <= tools


def test_a_call_gives_what_its_tool_told_as_text_and_as_structure(client: Client) -> None:
    result = client.ask("tools/call", name="show_graph", arguments={"count": 1})["result"]
    assert result["resultType"] == "complete" and not result["isError"]
    assert json.loads(result["content"][0]["text"]) == result["structuredContent"]
    assert result["structuredContent"]["project"] == "sample"


def test_an_error_of_a_tool_is_a_result_and_an_unknown_tool_is_an_error(client: Client) -> None:
    bad = client.ask("tools/call", name="edit_action", arguments={"actions": [WAVE], "speed": 2})["result"]
    assert bad["isError"] and "speed" in bad["content"][0]["text"]
    assert client.ask("tools/call", name="dance")["error"]["code"] == NO_PARAMETERS


@pytest.mark.gl
def test_pictures_come_as_images(client: Client) -> None:
    given = {"clip": f"hands_at_sides__{WAVE}", "at": 0.5, "width": 96}
    content = client.ask("tools/call", name="look", arguments=given)["result"]["content"]
    assert [part["type"] for part in content] == ["text", "image"] and content[1]["mimeType"] == "image/png"


def test_resources_are_the_graph_and_the_history(client: Client) -> None:
    listed = client.ask("resources/list")["result"]["resources"]
    assert [one["uri"] for one in listed] == ["metagraph://project", "metagraph://history"]
    (content,) = client.ask("resources/read", uri="metagraph://history")["result"]["contents"]
    assert json.loads(content["text"]) == {"done": [], "undone": []}
    assert "error" in client.ask("resources/read", uri="metagraph://none")


def test_a_long_job_is_a_task_for_those_who_know_tasks_alone(client: Client) -> None:
    plain = client.ask("tools/call", name="propose_labels")["result"]
    assert plain["resultType"] == "complete"
    short = client.ask("tools/call", name="show_graph", tasks=True)["result"]
    assert short["resultType"] == "complete"
    made = client.answer(client.send("tools/call", name="propose_labels", tasks=True))["result"]
    assert made["resultType"] == "task" and made["status"] == "working" and made["pollIntervalMs"] > 0
    before = client.answer(client.send("tasks/get", taskId=made["taskId"]))["result"]
    assert before["resultType"] == "complete" and before["status"] == "working" and "result" not in before
    client.work()
    after = client.answer(client.send("tasks/get", taskId=made["taskId"]))["result"]
    assert (
        after["status"] == "completed" and after["result"]["structuredContent"] == plain["structuredContent"]
    )
    assert after["lastUpdatedAt"] >= after["createdAt"]
    assert len([m for m in client.told if m.get("id") == 3]) == 1  # the task's own call is answered once


def test_a_task_that_waits_can_be_cancelled_and_does_nothing(client: Client, project_path: Path) -> None:
    before = project_path.read_bytes()
    calls = [{"tool": "edit_action", "arguments": {"actions": [WAVE], "likelihood": 2}}]
    number = client.send("tools/call", name="run_script", arguments={"calls": calls}, tasks=True)
    task = client.answer(number)["result"]["taskId"]
    assert client.answer(client.send("tasks/cancel", taskId=task))["result"]["resultType"] == "complete"
    client.work()
    assert client.answer(client.send("tasks/get", taskId=task))["result"]["status"] == "cancelled"
    assert project_path.read_bytes() == before
    assert client.answer(client.send("tasks/get", taskId="none"))["error"]["code"] == NO_PARAMETERS
    legacy = {"jsonrpc": "2.0", "id": "old", "method": "tasks/get", "params": {"taskId": task}}
    client.line._heard(json.dumps(legacy).encode())
    assert client.told[-1]["error"]["code"] == NO_METHOD


def test_a_cancelled_request_is_not_answered(client: Client, project_path: Path) -> None:
    before = project_path.read_bytes()
    number = client.send("tools/call", name="edit_action", arguments={"actions": [WAVE], "likelihood": 2})
    note = {"jsonrpc": "2.0", "method": "notifications/cancelled", "params": {"requestId": number}}
    client.line._heard(json.dumps(note).encode())
    client.work()
    assert not client.told and project_path.read_bytes() == before


def test_progress_grows_and_comes_before_the_answer(client: Client) -> None:
    client.ask("tools/call", name="propose_labels", token="p")
    *notes, last = client.told
    told = [note["params"]["progress"] for note in notes]
    assert told and all(a < b for a, b in pairwise(told)) and "result" in last
    assert all(note["params"]["progressToken"] == "p" for note in notes)


def test_who_listens_hears_of_edits_until_it_cancels(client: Client) -> None:
    assert client.ask("server/discover")["result"]["capabilities"]["resources"] == {"subscribe": True}
    wanted = {"resourceSubscriptions": ["metagraph://history", "metagraph://none"], "toolsListChanged": True}
    number = client.send("subscriptions/listen", notifications=wanted)
    meta = {f"{PREFIX}subscriptionId": number}
    honoured = {"resourceSubscriptions": ["metagraph://history"]}
    assert client.told[-1]["params"] == {"notifications": honoured, "_meta": meta}
    client.ask("tools/call", name="show_graph", arguments={"count": 1})
    updates = [m for m in client.told if m.get("method") == "notifications/resources/updated"]
    assert updates == []
    client.ask("tools/call", name="edit_action", arguments={"actions": [WAVE], "likelihood": 2})
    updates = [m for m in client.told if m.get("method") == "notifications/resources/updated"]
    assert [u["params"] for u in updates] == [{"uri": "metagraph://history", "_meta": meta}]
    note = {"jsonrpc": "2.0", "method": "notifications/cancelled", "params": {"requestId": number}}
    client.line._heard(json.dumps(note).encode())
    client.ask("tools/call", name="undo")
    assert len([m for m in client.told if m.get("method") == "notifications/resources/updated"]) == 1
    assert not [m for m in client.told if m.get("id") == number]


def test_calls_are_done_in_their_order(client: Client) -> None:
    first = client.send("tools/call", name="edit_action", arguments={"actions": [WAVE], "name": "hi"})
    second = client.send("tools/call", name="edit_action", arguments={"actions": ["hi"], "likelihood": 2})
    client.work()
    assert not client.answer(first)["result"]["isError"] and not client.answer(second)["result"]["isError"]


def test_what_fails_unforeseen_is_told_and_the_next_call_is_done(client: Client, monkeypatch, capsys) -> None:
    def fail(work: object, given: object) -> ToolOutcome:
        raise ZeroDivisionError("by accident")

    broken = AuthorTool("broken", "Fails.", NoFields, NoFields, fail)
    monkeypatch.setitem(client.line._desk.tools, "broken", broken)
    number = client.send("tools/call", name="broken")
    assert client.ask("tools/call", name="history")["result"]["isError"] is False
    error = client.answer(number)["error"]
    assert error["code"] == FAILED and "by accident" in error["message"]
    assert "ZeroDivisionError" in capsys.readouterr().err


def test_too_many_calls_at_once_are_refused(client: Client, monkeypatch) -> None:
    monkeypatch.setattr(author_line, "WAITING", 2)
    numbers = [client.send("tools/call", name="history") for _ in range(3)]
    assert client.answer(numbers[2])["result"]["isError"]
    client.work()
    assert not client.answer(numbers[1])["result"]["isError"]


@pytest.mark.parametrize("mode", ["legacy", "auto", *MODERN])
def test_the_protocols_own_client_works_on_a_project(project_path: Path, tmp_path: Path, mode: str) -> None:
    if find_spec("mcp") is None:
        pytest.skip("needs the package mcp 2.3 or newer (pip install mcp)")
    calls = tmp_path / "calls.json"
    edit = {"actions": [WAVE], "likelihood": 2.5}
    calls.write_text(
        json.dumps(
            [["list_clips", {"count": 3}], ["edit_action", edit], ["edit_action", edit], ["history", {}]]
        )
    )
    command = [sys.executable, str(CLIENT), mode, str(calls), *AUTHOR, str(project_path)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr[-2000:]
    told = json.loads(done.stdout)
    assert told["revision"] == (VERSIONS[0] if mode == "legacy" else MODERN[0])
    assert all(told["tools"].values())  # each has an output schema, by which the client checks
    listed, edited, again, history = told["results"]
    assert len(listed["told"]["clips"]) == 3 and edited["told"]["step"] == history["told"]["done"][0]
    assert again["isError"] and "nothing changed" in again["told"]["error"]
    assert set(told["honoured"] or ()) == (set() if mode == "legacy" else set(told["resources"]))
    assert bool(told["polls"]) == (mode != "legacy")  # list_clips was a task
    assert bool(told["progress"]) == (mode == "legacy")


def test_a_client_in_another_language_works_on_a_project(project_path: Path, tmp_path: Path) -> None:
    modules = ROOT / "tests" / "node_modules"
    if shutil.which("node") is None or not (modules / "@modelcontextprotocol").is_dir():
        pytest.skip("needs Node and @modelcontextprotocol/sdk (python3 run.py test fetches it where npm is)")
    calls = [
        ["show_graph", {"count": 2}],
        ["edit_action", {"actions": [WAVE], "name": "hi"}],
        ["history", {}],
    ]
    (tmp_path / "calls.json").write_text(json.dumps(calls))
    (tmp_path / "node_modules").symlink_to(modules)
    script = Path(shutil.copy(ROOT / "tests" / "live" / "run" / "mcp_client.mjs", tmp_path / "client.mjs"))
    command = ["node", str(script), str(tmp_path / "calls.json"), *AUTHOR, str(project_path)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr[-2000:]
    shown, edited, history = json.loads(done.stdout)["results"]
    assert len(shown["told"]["actions"]) == 2
    assert history["told"]["done"] == [edited["told"]["step"]]


def make_unlabelled(folder: Path, count: int) -> Path:
    """Copy so many sample clips, under names that say nothing."""
    folder.mkdir()
    every = sorted((ROOT / "sample_clips" / "clips").glob("*.glb"))
    for number, path in enumerate(every[1 :: len(every) // count][:count]):
        shutil.copy(path, folder / f"clip_{number:03}.glb")
    return folder


@pytest.mark.gl
@pytest.mark.nightly
@pytest.mark.parametrize("count", [12, 76])
def test_a_script_takes_a_folder_without_labels_to_a_checked_export(tmp_path: Path, count: int) -> None:
    folder = make_unlabelled(tmp_path / "clips", count)
    out = run_script(folder, tmp_path / "new.metagraph.yaml")
    assert f"imported: {count} clips read" in out and "'error': 0" in out.rpartition("problems: ")[2]
    assert "files 3 of 3 are as they were written" in out
    assert "Import clips (agent); Label the folder (agent)" in out
    assert (tmp_path / "game" / "new.glb").is_file() and (tmp_path / "seen.png").is_file()


@pytest.mark.gl
@pytest.mark.nightly
def test_so_it_does_with_76_clips_made_by_others(tmp_path: Path) -> None:
    if not DATA.is_dir():
        pytest.skip("needs ../shared/data/kaykit-rogue beside the project")
    out = run_script(DATA, tmp_path / "rogue.metagraph.yaml")
    assert "imported: 76 clips read" in out and "files 3 of 3 are as they were written" in out


def run_script(folder: Path, project: Path) -> str:
    """Run the client of the manual on a folder; return what it printed."""
    command = [sys.executable, str(SCRIPT), str(folder), str(project), *AUTHOR]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr[-2000:]
    return done.stdout
