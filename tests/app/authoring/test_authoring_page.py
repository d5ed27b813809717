"""What docs/agents/authoring.md says is true: its example runs, and its table has all tools."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path

from app.authoring.desk import AuthorDesk, list_author_tools
from app.authoring.project_file import AuthoredFile
from app.authoring.tool import make_plain
from app.cli.parser import _parser
from metagraph.engines.verifying_exports import verify
from metagraph.live.mcp_protocol import MODERN

PAGE = (Path(__file__).parents[3] / "docs" / "agents" / "authoring.md").read_text(encoding="utf-8")


def test_the_table_has_each_tool_once() -> None:
    rows = re.findall(r"^\| ((?:`\w+`(?:, )?)+) \|", PAGE, re.M)
    assert [name for row in rows for name in re.findall(r"\w+", row)] == sorted(
        list_author_tools(), key=lambda name: PAGE.index(f"`{name}`", PAGE.index("## Tools"))
    )


def test_the_servers_line_is_a_command_line() -> None:
    client, message = re.findall(r"^```json\n(.*?)\n```$", PAGE, re.S | re.M)
    assert json.loads(message)["params"]["_meta"]["io.modelcontextprotocol/protocolVersion"] == MODERN[0]
    (command,) = json.loads(client)["mcpServers"].values()
    options = _parser("author").parse_args(command["args"])
    assert options.project == Path("my.metagraph.yaml") and options.folder == [Path("clips")]


def test_the_example_takes_clips_to_a_checked_export(few: Path, tmp_path: Path) -> None:
    shutil.copytree(few.parent / "clips", tmp_path / "clips")
    desk = AuthorDesk(AuthoredFile(tmp_path / "my.metagraph.yaml"))
    (lines,) = re.findall(r"^```jsonl\n(.*?)\n```$", PAGE, re.S | re.M)
    told = []
    for line in lines.splitlines():
        call = json.loads(line)
        told.append(make_plain(desk.call(call["name"], call["arguments"], lambda *_: None).told))
    assert [step.removesuffix(" (agent)") for step in told[-2]["done"][:2]] == ["Import clips", "Label clips"]
    assert len(told[-2]["done"]) == 3 and told[-1]["clips"] > 5
    assert not [fault for one in verify(tmp_path / "game") for fault in one.faults]
