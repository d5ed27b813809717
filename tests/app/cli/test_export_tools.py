"""`metagraph export --tools`: what may be asked, as a file for a language model."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.cli.parser import main
from metagraph.formats.store import read_project
from metagraph.graph.offered import list_tools


@pytest.mark.nightly
def test_tools_are_written_beside_the_export_and_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    source = Path(__file__).resolve().parents[3] / "sample_clips" / "sample.metagraph.yaml"
    assert main(["export", str(source), "-o", str(tmp_path), "--tools", "--no-mesh"]) == 0
    written = tmp_path / "sample.tools.json"
    assert str(written) in capsys.readouterr().out
    assert json.loads(written.read_bytes()) == json.loads(json.dumps(list_tools(read_project(source))))
