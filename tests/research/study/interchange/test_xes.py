"""Logs for process mining: every task a trace, every step an event in time."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import pytest

from metagraph.research.study.interchange.xes import write_xes
from metagraph.research.study.logs.log import read_log
from metagraph.research.study.logs.withdrawal import note_withdrawal
from metagraph.research.study.simulation.files import write_study
from metagraph.research.study.simulation.people import Truth

X = "{http://www.xes-standard.org/}"


def value(node: ElementTree.Element, key: str) -> str:
    return next(child.attrib["value"] for child in node if child.attrib.get("key") == key)


def test_each_task_is_a_trace_of_what_was_done(tmp_path: Path) -> None:
    study = write_study(tmp_path / "study", Truth(participants=3))
    log = study.log("P01")
    log.write_text(log.read_text().replace("Change it", "Change \\u0001 & <it>"))
    note_withdrawal(study, "P03")
    assert write_xes(study, tmp_path / "out.xes") == 8
    root = ElementTree.parse(tmp_path / "out.xes").getroot()
    traces = root.findall(f"{X}trace")
    assert {value(t, "concept:name") for t in traces if value(t, "participant") == "P02"} == {
        f"P02 {task} {c}" for task in ("small", "large") for c in ("meta", "manual")
    }
    run = read_log(log).tasks()[0]
    mine = next(t for t in traces if value(t, "concept:name") == f"P01 {run.task} {run.condition}")
    events = mine.findall(f"{X}event")
    times = [value(e, "time:timestamp") for e in events]
    assert times == sorted(times) and {"edit place"} <= {value(e, "concept:name") for e in events}
    assert sum(float(value(e, "seconds")) for e in events) == pytest.approx(run.seconds, abs=5)
    assert sum(value(e, "concept:name").startswith("edit") for e in events) == run.edits
    assert any("Change \ufffd & <it>" in value(e, "words") for e in events if value(e, "sort") == "edit")
