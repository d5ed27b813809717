"""`metagraph author`: what it needs before it answers, and that it ends with its client."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import pytest

from app.cli.parser import main
from tests.processes import metagraph, started


def run(path: Path, *lines: dict, words: tuple[object, ...] = ()) -> tuple[int, list[dict], str]:
    """Start the command, send lines and end its input; return its code, its answers and its words."""
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with started(*metagraph("author", path, *words), **pipes) as process:
        out, err = process.communicate("".join(json.dumps(line) + "\n" for line in lines), timeout=60)
    return process.returncode, [json.loads(line) for line in out.splitlines()], err


def ask(number: int, tool: str, **given: object) -> dict:
    params = {"name": tool, "arguments": given}
    return {"jsonrpc": "2.0", "id": number, "method": "tools/call", "params": params}


def test_calls_that_were_sent_are_done_before_it_ends_with_its_client(few, tmp_path) -> None:
    shutil.copytree(few.parent / "clips", tmp_path / "clips")
    code, told, err = run(tmp_path / "new", ask(1, "import_clips", paths=["clips"]), ask(2, "history"))
    assert code == 0 and [x["id"] for x in told] == [1, 2] and "new.metagraph.yaml can be edited" in err
    assert told[1]["result"]["structuredContent"]["done"] == ["Import clips (agent)"]
    assert (tmp_path / "new.metagraph.yaml").is_file()


def test_folders_outside_of_the_projects_are_used_only_if_a_person_names_them(few, tmp_path) -> None:
    clips = few.parent / "clips"
    call = ask(1, "import_clips", paths=[str(clips)])
    _, (refused,), _ = run(tmp_path / "new", call)
    assert refused["result"]["isError"] and "--folder" in refused["result"]["content"][0]["text"]
    assert not list(tmp_path.glob("new*"))
    _, (done,), _ = run(tmp_path / "new", call, words=("--folder", clips))
    assert not done["result"]["isError"]


def test_a_link_out_of_the_folder_is_no_way_around_that(few, tmp_path) -> None:
    (tmp_path / "clips").symlink_to(few.parent / "clips")
    _, (refused,), _ = run(tmp_path / "new", ask(1, "import_clips", paths=["clips"]))
    assert refused["result"]["isError"] and "outside" in refused["result"]["content"][0]["text"]


def test_a_person_can_let_it_look_only(few, tmp_path) -> None:
    calls = ask(1, "show_graph"), ask(2, "edit_action", actions=["wave_hello_rt_01"], likelihood=2)
    before = few.read_bytes()
    _, (shown, edited), _ = run(few, *calls, words=("--look-only",))
    assert not shown["result"]["isError"] and edited["result"]["isError"] and few.read_bytes() == before


def test_what_cannot_be_opened_is_told_before_anything_is_asked(tmp_path, capsys) -> None:
    assert main(["author", str(tmp_path / "none" / "new.metagraph.yaml")]) == 1
    assert "there is no such folder" in capsys.readouterr().err
    (tmp_path / "odd.metagraph.yaml").write_text("metagraph: [")
    assert main(["author", str(tmp_path / "odd.metagraph.yaml")]) == 1
    assert "odd.metagraph.yaml" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main(["author"])
