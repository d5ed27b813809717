"""Values that would end up in a project are refused before anything is done that would be lost with them."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.cli.parser import main

SAMPLE = Path(__file__).resolve().parents[3] / "sample_clips"


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (["annotate", "p", "talk.eaf", "--perform", "x" * 300], "300 letters; at most 200"),
        (["live", "p", "--keep", "x" * 201], "201 letters"),
        (["live", "p", "--keep", "talk", "--seed", "-1"], "not a seed"),
        (["live", "p", "--seed", "4294967296"], "not a seed"),
        (["live", "p", "--seed", "\u0663"], "not a seed"),
    ],
)
def test_what_no_project_could_hold_is_wrong_usage(
    words: list[str], why: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        main([str(SAMPLE / "sample.metagraph.yaml") if word == "p" else word for word in words])
    assert ended.value.code == 2
    assert why in capsys.readouterr().err
