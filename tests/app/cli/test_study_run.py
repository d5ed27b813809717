"""`metagraph study check` and `run`, as far as no window is needed."""

from __future__ import annotations

import json

import pytest

from app.cli.parser import main


def test_orders_and_problems_are_printed(tiny, capsys):
    assert main(["study", "check", str(tiny)]) == 3
    out = capsys.readouterr().out
    (second,) = [line for line in out.splitlines() if line.split()[:1] == ["P02"]]
    assert "manual: nods; meta: nods" in second
    assert "problem: task 'nods'" in out
    assert main(["study", "check", str(tiny.parent), "--json"]) == 3
    data = json.loads(capsys.readouterr().out)
    assert data["orders"]["P01"][0] == {"condition": "meta", "tasks": ["nods"]}


def test_a_study_without_faults_has_no_problems(capsys):
    from sample_clips.make.study import FOLDER

    assert main(["study", "check", str(FOLDER)]) == 0
    assert "problem" not in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "told"),
    [(["nowhere"], "cannot be read"), (["STUDY", "--participant", "P77"], "'P77' does not take part")],
)
def test_what_cannot_be_run_is_told_before_a_window_opens(tiny, words, told, capsys):
    assert main(["study", "run", *(str(tiny) if w == "STUDY" else w for w in words)]) == 1
    assert told in capsys.readouterr().err
