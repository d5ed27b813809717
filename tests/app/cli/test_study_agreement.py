"""Two annotations of one recording are compared from the command line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.cli.parser import main

EAF = Path(__file__).resolve().parents[3] / "sample_clips" / "annotation" / "conversation.eaf"


def test_a_file_agrees_with_itself_and_less_with_one_whose_labels_were_changed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    other = tmp_path / "ben.eaf"
    other.write_bytes(EAF.read_bytes().replace(b">gesture<", b">fidget<", 5))
    assert main(["study", "agreement", str(EAF), str(EAF), "--tiers", "Left arm=Left arm", "--json"]) == 0
    whole = json.loads(capsys.readouterr().out)["tiers"]
    assert [row["kappa"] for row in whole] == [1.0] and whole[0]["matched"] == whole[0]["counts"][0]
    assert main(["study", "agreement", str(EAF), str(other), "--tiers", "Left arm=Left arm"]) == 0
    said = capsys.readouterr().out
    assert "Left arm and Left arm: kappa 0." in said and "'fidget'" in said
    assert main(["study", "agreement", str(EAF), "--tiers", "Left arm"]) == 1
    assert "--tiers is A=B, not 'Left arm'" in capsys.readouterr().err
