"""What docs/agents/ says of the live session is true, and its clients run."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.cli.parser import _parser
from metagraph.graph.model import Project
from metagraph.live import hub, limits, messages, osc, schemas, tape
from metagraph.live.live_session import LiveSession
from tests.processes import metagraph, started

ROOT = Path(__file__).resolve().parents[2]
AGENTS = ROOT / "docs" / "agents"
PAGE = "\n".join(path.read_text(encoding="utf-8") for path in sorted(AGENTS.glob("*.md")))
CLIENTS = ROOT / "docs" / "clients"


def page(name: str) -> str:
    return (AGENTS / f"{name}.md").read_text(encoding="utf-8")


def section(name: str, title: str) -> str:
    return page(name).split(f"\n## {title}\n")[1].split("\n## ")[0]


def test_the_published_schemas_are_those_of_the_code() -> None:
    for path, text in schemas.make_schema_texts().items():
        assert path.read_bytes() == text, "write them anew: .venv/bin/python -m metagraph.live.schemas"


def test_every_request_and_its_fields_are_in_the_table() -> None:
    rows = page("requests")
    common = {"id", "at", "in", "priority", "told", "do"}
    parts = messages.make_live_schema()["$defs"]
    for name in (ref["$ref"].rpartition("/")[2] for ref in parts["Request"]["anyOf"]):
        word = parts[name]["properties"]["do"]["enum"][0]
        row = next((line for line in rows.splitlines() if re.match(rf"\| (`\w+`, )?`{word}`[, ]", line)), "")
        assert row, word
        assert not [
            field for field in parts[name]["properties"] if field not in common and f"`{field}`" not in row
        ], (word, row)
    assert all(f"| `{field}` |" in rows for field in common - {"do"})


def test_what_synthesisers_tell_is_said_as_the_page_shows_it(sample: Project) -> None:
    session = LiveSession(sample, idle=False)
    session.join(1)
    blocks = re.findall(r"```jsonl\n(.*?)```", page("speech"), re.S)
    lines = [line for block in blocks for line in block.splitlines()]
    assert len(lines) == 13
    for n, line in enumerate(lines):
        session.receive(1, line)
        (reply,) = session.tick(1.0 + 0.3 * n).replies
        wanted = "planned" if '"say"' in line else "done"
        assert isinstance(reply, messages.Reply) and reply.state == wanted, (line, reply)
    speech = next(s for s in session.plan.track.speeches if s.id.endswith("greet"))
    assert speech.text == "Hello there my friend"


@pytest.mark.parametrize(("part", "title"), [("Reply", "Replies"), ("Event", "Events"), ("Poses", "")])
def test_every_field_that_is_sent_back_is_described(part: str, title: str) -> None:
    text = section("replies", title) if title else page("poses")
    assert not [
        field
        for field in messages.make_live_schema()["$defs"][part]["properties"]
        if f"`{field}`" not in text
    ]


def test_every_address_is_listed_and_understood() -> None:
    text = page("osc")
    for word in re.findall(r"`/metagraph/(\w+)`", text):
        if word in ("pose", "root", "joint", "weight", "reply", "event", "json", "replies"):
            continue
        assert osc.read_osc_request(f"/metagraph/{word}", ("x",))["do"]
    known = re.findall(r'case ((?:"\w+"(?: \| )?)+):', Path(osc.__file__).read_text())
    assert not {
        word for words in known for word in re.findall(r"\w+", words) if f"`/metagraph/{word}`" not in text
    }


def test_the_limits_are_the_codes() -> None:
    text = page("access")
    kib = 1024
    for number in (
        f"{messages.LONGEST // kib} KiB",
        f"{messages.LONGEST_BML // kib} KiB",
        f"{messages.LONGEST_MESSAGE // kib} KiB, {messages.MOST} requests",
        f"| {limits.PER_TICK}, of which {limits.PLANNED_PER_TICK} change",
        f"| {limits.PENDING}, of all",
        f"| {limits.WAITING} of the same",
        f"| {limits.FARTHEST:g} s |",
        f"| {limits.SPEECH} characters |",
        f"names | {limits.NAMES} |",
        f"clients | {hub.CLIENTS} |",
        f"{hub.BACKLOG // kib // kib} MiB",
        f"{tape.MOST // kib // kib} MiB",
    ):
        assert number in text, number
    assert f"up to {messages.FASTEST:g}" in page("poses")
    assert f"within {hub.PROVE:g} seconds" in section("access", "Who may ask")


def test_the_examples_are_json_as_it_is_sent() -> None:
    (reply,), (pose,), (client,) = (
        [json.loads(x) for x in re.findall(r"^```json\n(.*?)\n```$", page(name), re.S | re.M)]
        for name in ("index", "poses", "language-models")
    )
    (command,) = client["mcpServers"].values()
    assert command["command"] == "metagraph" and _parser("live").parse_args(command["args"]).mcp
    assert set(reply) <= set(messages.Reply.__struct_fields__) and {
        "t",
        "root",
        "rotations",
        "weights",
    } == set(pose)


@pytest.mark.parametrize(("tag", "name"), [("py", "client.py"), ("js", "client.mjs")])
def test_the_clients_on_the_page_are_the_files_and_ten_lines_long(tag: str, name: str) -> None:
    (shown,) = re.findall(rf"^```{tag}\n(.*?)^```$", PAGE, re.S | re.M)
    assert shown == (CLIENTS / name).read_text(encoding="utf-8")
    assert len(shown.splitlines()) <= 10


@pytest.fixture(scope="module")
def port() -> Iterator[str]:
    """A session in a process of its own; the port it listens on."""
    words = [
        "live",
        ROOT / "sample_clips" / "sample.metagraph.yaml",
        "--json",
        "--port",
        "0",
        "--no-osc",
        "--no-stdin",
    ]
    with started(*metagraph(*words), stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        yield json.loads(process.stdout.readline())["websocket"].rpartition(":")[2]
        process.terminate()
        assert process.wait(30) == 0


def run(name: str, words: list[str], port: str, folder: Path) -> str:
    file = folder / name
    file.write_text((CLIENTS / name).read_text(encoding="utf-8").replace("8765", port), encoding="utf-8")
    done = subprocess.run([*words, str(file)], capture_output=True, text=True, timeout=60, cwd=ROOT)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.nightly
def test_the_python_client_runs(port: str, tmp_path: Path) -> None:
    first, second = run("client.py", [sys.executable], port, tmp_path).splitlines()
    assert "'state': 'planned'" in first or "'state': 'late'" in first
    assert "nod" in second


@pytest.mark.nightly
def test_the_talking_agent_talks_with_voice_lips_and_gestures(port: str, tmp_path: Path) -> None:
    """It hears something, and what it does about it is what was played: most gestures on their words."""
    if shutil.which("espeak-ng") is None:
        pytest.skip("espeak-ng is not here (python3 run.py test installs it)")
    text = (CLIENTS / "talking_agent.py").read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 45
    (tmp_path / "agent.py").write_text(text.replace("8765", port), encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "agent.py", str(ROOT / "sample_clips" / "sample.metagraph.yaml")],
        input="let us build a boat\n", capture_output=True, text=True, timeout=60, cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    said, *made = done.stdout.splitlines()
    assert "let us build a boat" in said and (tmp_path / "said.wav").stat().st_size > 10_000
    played = [words for words in made if words.strip().startswith("[")]
    assert len(made) >= 2 and played, made  # what the character was at may leave no time for the first


def test_the_javascript_client_runs(port: str, tmp_path: Path) -> None:
    node = shutil.which("node")
    if node is None:
        pytest.skip("Node is not here")
    version = subprocess.run([node, "--version"], capture_output=True, text=True, timeout=60).stdout
    major, minor = (int(x) for x in version.strip().removeprefix("v").split(".")[:2])
    if (major, minor) < (20, 10):
        pytest.skip(f"Node {version.strip()} has no WebSocket")
    out = run("client.mjs", [node, *(["--experimental-websocket"] if major < 22 else [])], port, tmp_path)
    assert out.count("state:") == 2 and "nod" in out
