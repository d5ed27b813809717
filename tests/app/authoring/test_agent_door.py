"""Programs that work on the project a window has open: only while a person allows it, only with the token,
each edit one step, and never over what the person did meanwhile.
"""

from __future__ import annotations

import json
import os
import socket
import subprocess
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import msgspec
import pytest
from PySide6.QtCore import QCoreApplication, QTimer

from app.authoring import desk
from app.authoring.agent_door import AgentDoor
from app.authoring.door_key import DoorHello, find_key
from app.authoring.relaying import connect_to_window
from app.project.document import Document
from metagraph.formats.locking import Lock
from metagraph.formats.store import open_project
from metagraph.graph import edits
from metagraph.live.mcp_protocol import MODERN
from tests.processes import metagraph, started

PREFIX = "io.modelcontextprotocol/"
WAVE = "wave_hello_rt_01"


class Guest:
    """A program that is connected."""

    def __init__(self, line: socket.socket) -> None:
        self.line, self.file, self.number = line, line.makefile("r", encoding="utf-8"), 0

    def send(self, method: str, **params: Any) -> None:
        self.number += 1
        meta = {f"{PREFIX}protocolVersion": MODERN[0], f"{PREFIX}clientCapabilities": {}}
        message = {"jsonrpc": "2.0", "id": self.number, "method": method, "params": {**params, "_meta": meta}}
        self.line.sendall(json.dumps(message).encode() + b"\n")


@pytest.fixture
def document(qapp: object, project_path: Path) -> Iterator[Document]:
    document = Document()
    document.load(open_project(project_path).project, project_path)
    yield document
    document.deleteLater()


@pytest.fixture
def door(document: Document) -> Iterator[AgentDoor]:
    door = AgentDoor(document)
    door.open()
    yield door
    door.close()


@pytest.fixture
def enter(door: AgentDoor, document: Document, qtbot: Any) -> Iterator[Callable[..., Guest]]:
    """Connects a program, as `metagraph author` does."""
    guests: list[Guest] = []

    def connect(token: str | None = None, look_only: bool = False) -> Guest:
        assert document.path is not None
        key = find_key(document.path)
        assert key is not None and key.pid == os.getpid()
        line = socket.create_connection(("127.0.0.1", key.port), 10)
        line.sendall(msgspec.json.encode(DoorHello(token or key.token, (), look_only)) + b"\n")
        guests.append(Guest(line))
        return guests[-1]

    yield connect
    for guest in guests:
        guest.file.close()
        guest.line.close()
    qtbot.waitUntil(lambda: door.count == 0, timeout=10_000)


@pytest.fixture
def hear(qtbot: Any) -> Callable[[Guest], dict[str, Any]]:
    """Returns the next message to a program, while the window goes on."""

    def wait(guest: Guest) -> dict[str, Any]:
        told: list[str] = []
        reader = threading.Thread(target=lambda: told.append(guest.file.readline()))
        reader.start()
        qtbot.waitUntil(lambda: bool(told), timeout=20_000)
        return json.loads(told[0])

    return wait


@pytest.fixture
def call(hear: Callable[[Guest], dict[str, Any]]) -> Callable[..., dict[str, Any]]:
    """Calls a tool; returns its result."""

    def do(guest: Guest, tool: str, **given: Any) -> dict[str, Any]:
        guest.send("tools/call", name=tool, arguments=given)
        return hear(guest)["result"]

    return do


def test_an_edit_of_a_program_is_a_step_that_is_seen_and_undone(
    enter, call, document: Document, door: AgentDoor, qtbot
) -> None:
    seen: list[str] = []
    door.edited.connect(seen.append)
    guest = enter()
    result = call(guest, "edit_action", actions=[WAVE], likelihood=2.5)
    assert not result["isError"], result
    action = next(a for a in document.project.actions() if a.name == WAVE)
    assert action.likelihood == 2.5 and document.dirty
    text = document.undo_stack.undoText()
    assert result["structuredContent"]["step"] == text and text.endswith("(agent)")
    qtbot.waitUntil(lambda: seen == [text])  # what is shown of it may come after the answer
    assert call(guest, "history")["structuredContent"] == {"done": [text], "undone": []}
    document.undo()  # by the person
    assert call(guest, "history")["structuredContent"] == {"done": [], "undone": [text]}
    assert call(guest, "redo")["structuredContent"]["done"] == [text]
    assert next(a for a in document.project.actions() if a.name == WAVE).likelihood == 2.5


def test_who_listens_hears_what_a_person_edits(enter, hear, document: Document) -> None:
    guest = enter()
    guest.send("subscriptions/listen", notifications={"resourceSubscriptions": ["metagraph://project"]})
    assert hear(guest)["method"] == "notifications/subscriptions/acknowledged"
    stance = next(iter(document.project.graphs["arms"].stances))
    document.edit("Mine", lambda project: edits.rename_stance(project, stance, "mine"))
    heard = hear(guest)
    assert heard["method"] == "notifications/resources/updated"
    assert heard["params"] == {"uri": "metagraph://project", "_meta": {f"{PREFIX}subscriptionId": 1}}


def test_what_a_person_edits_meanwhile_is_never_lost(enter, call, document: Document, monkeypatch) -> None:
    guest = enter()
    settle = desk.settle_edit

    def meanwhile(before: Any, outcome: Any) -> Any:
        """Let the person edit on the window's thread, while the call works on its own."""
        done = threading.Event()

        def edit() -> None:
            stance = next(iter(document.project.graphs["arms"].stances))
            document.edit("Mine", lambda project: edits.rename_stance(project, stance, "mine"))
            done.set()

        QTimer.singleShot(0, document, edit)
        assert done.wait(10)
        return settle(before, outcome)

    monkeypatch.setattr(desk, "settle_edit", meanwhile)
    result = call(guest, "edit_action", actions=[WAVE], likelihood=2.5)
    assert result["isError"] and "a person edited the project meanwhile" in result["content"][0]["text"]
    assert document.undo_stack.count() == 1
    assert next(a for a in document.project.actions() if a.name == WAVE).likelihood != 2.5


def test_nobody_enters_with_a_wrong_token_or_through_a_closed_door(
    enter, door: AgentDoor, document: Document, qtbot
) -> None:
    guest = enter(token="wrong")
    assert guest.file.readline() == "" and door.count == 0  # hung up on
    assert document.path is not None
    key = find_key(document.path)
    door.close()
    assert find_key(document.path) is None and key is not None
    with pytest.raises(OSError, match=r"refused|reset"):
        socket.create_connection(("127.0.0.1", key.port), 2)
    assert not connect_to_window(document.path, (), False)


def test_a_person_can_forbid_edits_at_any_time(
    enter, call, door: AgentDoor, document: Document, qtbot
) -> None:
    guest = enter()
    call(guest, "history")
    assert door.count == 1
    door.close()
    assert door.count == 0 and guest.file.readline() == ""
    before = document.project
    door.open()
    guest = enter(look_only=True)
    result = call(guest, "edit_action", actions=[WAVE], likelihood=2.5)
    assert result["isError"] and "forbidden" in result["content"][0]["text"]
    assert not call(guest, "show_graph", count=1)["isError"] and document.project is before


def test_another_project_closes_the_door(door: AgentDoor, document: Document, project_path: Path) -> None:
    document.load(document.project, None)
    assert not door.is_open and find_key(project_path) is None
    door.open()  # a project that was never saved has no folder to work in
    assert not door.is_open


def test_only_the_user_can_read_the_token(door: AgentDoor) -> None:
    assert door._key is not None and door._key.stat().st_mode & 0o077 == 0


def test_the_command_finds_the_window_that_has_the_project_open(
    door: AgentDoor, document: Document, project_path: Path, qtbot, monkeypatch
) -> None:
    names = QCoreApplication.organizationName(), QCoreApplication.applicationName()
    lock = Lock(project_path, document.owner)
    lock.acquire()
    door.close()
    QCoreApplication.setOrganizationName("Metagraph")
    QCoreApplication.setApplicationName("Metagraph")
    try:
        door.open()
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
        with started(*metagraph("author", project_path), **pipes) as process:
            told: list[str] = []
            meta = {f"{PREFIX}protocolVersion": MODERN[0], f"{PREFIX}clientCapabilities": {}}
            given = {
                "name": "edit_action",
                "arguments": {"actions": [WAVE], "likelihood": 3.0},
                "_meta": meta,
            }
            message = {"jsonrpc": "2.0", "id": 1, "method": "tools/call", "params": given}
            process.stdin.write(json.dumps(message) + "\n")
            process.stdin.flush()
            reader = threading.Thread(target=lambda: told.append(process.stdout.readline()))
            reader.start()
            qtbot.waitUntil(lambda: bool(told), timeout=30_000)
            assert not json.loads(told[0])["result"]["isError"], told
            assert document.undo_stack.count() == 1
            process.stdin.close()
            assert process.wait(20) == 0
    finally:
        lock.release()
        QCoreApplication.setOrganizationName(names[0])
        QCoreApplication.setApplicationName(names[1])
