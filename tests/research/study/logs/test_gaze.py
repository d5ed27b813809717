"""Recordings of eyes, made up in the forms that Tobii and Pupil export, on panels that lay there."""

from __future__ import annotations

import json
from datetime import datetime
from pathlib import Path

import numpy as np
import pytest

from metagraph.errors import FileError
from metagraph.research.study.logs.gaze import read_gaze, tabulate_dwell
from metagraph.research.study.logs.log import StudyLog, read_log

AREAS = {"library": [0, 0, 400, 1000], "graph": [400, 0, 800, 1000], "graph stance": [700, 300, 200, 200]}
START = datetime.fromisoformat("2026-03-01T09:00:00+00:00").timestamp()


@pytest.fixture
def log(tmp_path: Path) -> StudyLog:
    """A clap at 10 s, a task of 20 s from then; the screen is 1600 x 1000, two device pixels for each."""
    task = {"name": "task", "condition": "meta", "task": "ten", "index": 1}
    told = [
        (
            0,
            {
                "type": "begin",
                "participant": "P01",
                "machine": {"screen": {"width": 1600, "height": 1000, "ratio": 2}},
            },
        ),
        (5, {"type": "view", "what": "layout", "areas": AREAS}),
        (10, {"type": "phase", "state": "begin", **task}),
        (10, {"type": "marker", "name": "clap", "number": 1}),
        (30, {"type": "phase", "state": "end", "why": "done", **task}),
    ]
    lines = [
        json.dumps({"n": n, "run": "a", "mono": float(at), "wall": f"2026-03-01T09:00:{at:02}Z", **e})
        for n, (at, e) in enumerate(told)
    ]
    path = tmp_path / "log.jsonl"
    path.write_text("\n".join(lines) + "\n")
    return read_log(path)


def looks() -> list[tuple[float, float, float]]:
    """Seconds after the clap, and places in logical pixels: 5 s library, 10 s stance node, 2 s nowhere, 3 s away."""
    out = []
    for n in range(1000):
        t = n / 50 + 0.001
        x, y = (
            (100, 100) if t < 5 else (800, 400) if t < 15 else (1500, 500) if t < 17 else (float("nan"),) * 2
        )
        out.append((t, x, y))
    return out


def check(rows: list[tuple]) -> None:
    found = {row[3]: row for row in rows}
    assert {k: round(v[4], 1) for k, v in found.items()} == {
        "graph stance": 10.0,
        "library": 5.0,
        "elsewhere": 2.0,
    }
    assert found["library"][5] == pytest.approx(5 / 17, abs=0.01) and found["library"][6] == 1
    assert found["library"][7] == pytest.approx(0.15, abs=0.01), "what was not measured is told"


def test_tobii(log: StudyLog, tmp_path: Path) -> None:
    lines = ["Recording timestamp [μs]\tSensor\tGaze point X [DACS px]\tGaze point Y [DACS px]"]
    for t, x, y in looks():
        cells = ("", "") if np.isnan(x) else (f"{2 * x:g}", f"{2 * y:g}")
        lines.append(f"{(t + 3.5) * 1e6:.0f}\tEye Tracker\t{cells[0]}\t{cells[1]}")
        lines.append(f"{(t + 3.5) * 1e6:.0f}\tMouse\t\t")
    path = tmp_path / "tobii.tsv"
    path.write_text("\n".join(lines), encoding="utf-8-sig")
    check(tabulate_dwell(log, read_gaze(path), clap=3.5)[1])
    with pytest.raises(ValueError, match="clap"):
        tabulate_dwell(log, read_gaze(path))


def test_pupil_player(log: StudyLog, tmp_path: Path) -> None:
    lines = ["world_timestamp,world_index,gaze_timestamp,x_norm,y_norm,x_scaled,y_scaled,on_surf,confidence"]
    for t, x, y in looks():
        there = not np.isnan(x)
        place = f"{x / 1600},{1 - y / 1000}" if there else "0.5,0.5"
        lines.append(f"0,0,{t + 812.25},{place},0,0,{there},{0.9 if there else 0.1}")
    path = tmp_path / "gaze_positions_on_surface_Screen.csv"
    path.write_text("\n".join(lines))
    check(tabulate_dwell(log, read_gaze(path), clap=812.25)[1])


def test_pupil_cloud_has_the_time_of_day(log: StudyLog, tmp_path: Path) -> None:
    lines = [
        "section id,recording id,timestamp [ns],gaze detected on surface,gaze position on surface x [normalized],gaze position on surface y [normalized]"
    ]
    for t, x, y in looks():
        place = "," if np.isnan(x) else f"{x / 1600},{y / 1000}"
        lines.append(f"a,b,{round((START + 10 + t) * 1e9)},{not np.isnan(x)},{place}")
    path = tmp_path / "gaze.csv"
    path.write_text("\n".join(lines))
    check(tabulate_dwell(log, read_gaze(path))[1])


def test_what_is_no_recording_is_told(tmp_path: Path, log: StudyLog) -> None:
    path = tmp_path / "else.csv"
    path.write_text("a,b\n1,2\n")
    with pytest.raises(FileError, match=r"else\.csv"):
        read_gaze(path)
    path.write_text("")
    with pytest.raises(FileError, match="no export"):
        read_gaze(path)
    path.write_text("gaze_timestamp,x_norm,y_norm\n2,0,0\n1,0,0\n")
    with pytest.raises(FileError, match="do not ascend"):
        read_gaze(path)
    path.write_text("gaze_timestamp,x_norm,y_norm\n1,0,0\n2,0,0\n")
    bare = StudyLog(log.path, tuple(e for e in log.events if e["type"] != "marker"))
    with pytest.raises(ValueError, match="has no clap"):
        tabulate_dwell(bare, read_gaze(path), clap=1.0)
