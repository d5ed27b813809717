"""A session whose lines are in a process of their own."""

from __future__ import annotations

import json
import socket
import subprocess
import sys
import threading
import time
from typing import Any

import pytest
from websockets.sync.client import connect

from metagraph.graph.model import Project
from metagraph.live.live_session import LiveSession
from metagraph.live.relay import Relay
from metagraph.live.server import LiveError, Options


def until(condition: Any, relay: Relay, session: LiveSession, begin: float) -> None:
    """Tick as a window does until something is so."""
    deadline = time.monotonic() + 30
    while not condition():
        assert time.monotonic() < deadline, relay.error
        relay.tick(session, time.monotonic() - begin)
        time.sleep(0.005)


def test_a_window_answers_clients_that_another_process_talks_to(sample: Project) -> None:
    session, relay, begin = LiveSession(sample), Relay(Options(port=0, osc=0)), time.monotonic()
    relay.start()
    try:
        until(lambda: relay.ready is not None, relay, session, begin)
        assert relay.ready is not None and not relay.error and relay.ready.websocket and relay.ready.osc
        got: list[Any] = []

        def client() -> None:
            with connect(str(relay.ready.websocket)) as line:  # type: ignore[union-attr]
                line.send(
                    '[{"do":"nod","id":"n"},{"do":"dance"},{"do":"hello","poses":{"rate":60,"format":"binary"}}]'
                )
                got.append(json.loads(line.recv()))
                got.append(line.recv())
                line.send("nonsense")
                while isinstance(data := line.recv(), bytes):
                    pass
                got.append(json.loads(data))
            got.append("over")

        thread = threading.Thread(target=client)
        thread.start()
        until(lambda: "over" in got, relay, session, begin)
        thread.join()
        assert (
            got[0][0]["state"] in ("planned", "late")
            and "error" in got[0][1]
            and got[0][2]["poses"]["rate"] == 60
        )
        assert got[1].startswith(b"MGP1") and "not JSON" in got[2]["error"]
        until(lambda: not session.clients, relay, session, begin)
    finally:
        relay.close(wait=True)


def test_what_is_sent_while_other_requests_wait_is_answered_at_the_next_tick(sample: Project) -> None:
    session, relay, begin = LiveSession(sample), Relay(Options(port=0, osc=None)), time.monotonic()
    relay.start()
    try:
        until(lambda: relay.ready is not None, relay, session, begin)
        assert relay.ready is not None
        address = str(relay.ready.websocket)
        with connect(address) as flood, connect(address) as line:
            until(lambda: len(session.clients) == 2, relay, session, begin)  # that they came is reported, too
            flood.send('{"do":"nod"}')
            deadline = time.monotonic() + 30
            while relay._in.empty():
                assert time.monotonic() < deadline
                time.sleep(0.005)
            line.send('{"do":"interrupt","id":"now"}')
            while relay._in.qsize() < 2:
                assert time.monotonic() < deadline, "it waits until the other request is answered"
                time.sleep(0.005)
            relay.tick(session, time.monotonic() - begin)
            assert json.loads(line.recv(timeout=30))["id"] == "now"
            assert json.loads(flood.recv(timeout=30))["state"] in ("planned", "late")
    finally:
        relay.close(wait=True)


def test_a_port_that_is_taken_is_told_to_the_window(sample: Project) -> None:
    session, begin = LiveSession(sample), time.monotonic()
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        relay = Relay(Options(port=other.getsockname()[1], osc=None))
        relay.start()
        try:
            until(lambda: relay.error, relay, session, begin)
            assert "cannot listen" in relay.error and "Choose another port" in relay.error
        finally:
            relay.close(wait=True)


def test_what_is_not_safe_is_not_even_started() -> None:
    with pytest.raises(LiveError, match="needs a token"):
        Relay(Options(host="0.0.0.0"))


def test_a_child_that_ends_is_noticed(sample: Project) -> None:
    session, relay, begin = LiveSession(sample), Relay(Options(port=0, osc=None)), time.monotonic()
    relay.start()
    try:
        until(lambda: relay.ready is not None, relay, session, begin)
        assert relay._child is not None
        relay._child.process.terminate()
        until(lambda: relay.error, relay, session, begin)
        assert "process" in relay.error and "ended" in relay.error
    finally:
        relay.close(wait=True)


def test_closing_what_was_never_started_is_fine() -> None:
    Relay(Options()).close()
    Relay(Options()).close(wait=True)


def test_the_child_loads_nothing_of_the_planner() -> None:
    heavy = ("numpy", "numba", "PySide6", "yaml", "metagraph.playback")
    code = (
        "import sys, metagraph.live.relay_child, metagraph.live.websocket, metagraph.live.osc; print([m "
        f"for m in {heavy} if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.stdout.strip() == "[]", done.stderr
