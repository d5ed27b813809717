"""Eye tracking beside a sitting: samples as Tobii and Pupil export them, in the time of the log, on the
panels and nodes that lay there.

Which file it is follows from its columns: Tobii Pro Lab's TSV, Pupil Player's surfaces, Pupil Cloud's (Neon,
Invisible) gaze on a picture of the screen.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.budgets import LOG_FILE
from metagraph.common.files import read_file
from metagraph.errors import FileError
from metagraph.research.study.logs.log import StudyLog
from metagraph.research.study.reports.tables import Table
from metagraph.research.study.scores.tasks import Event, read_moment

Array = NDArray[np.float64]
GAP = 0.1  # seconds between samples beyond which nothing was measured
ELSEWHERE = "elsewhere"
LEAST = 0.6  # of Pupil's confidence


@dataclass(frozen=True)
class GazeRecording:
    """Samples of a recording: seconds `[n]` (since 1970 where epoch, else by the recorder's own clock),
    places on the screen `[n, 2]`, pixels or, where scaled, shares of its width and height; NaN if nothing was
    seen.
    """

    seconds: Array
    places: Array
    scaled: bool
    epoch: bool


def read_gaze(path: Path) -> GazeRecording:
    """Read an export. Raises FileError with what was expected."""
    text = read_file(path, LOG_FILE).decode("utf-8-sig", "replace")
    first = text.split("\n", 1)[0]
    rows = list(csv.DictReader(StringIO(text), delimiter="\t" if "\t" in first else ","))
    columns = {c.strip().lower(): c for c in (rows[0] if rows else ()) if c}
    for kind in (_tobii, _pupil_surface, _pupil_cloud):
        found = kind(rows, columns)
        if found is not None:
            if not np.isfinite(found.seconds).all() or (np.diff(found.seconds) < 0).any():
                raise FileError(
                    path, "its times do not ascend", "timestamps", "Export one recording at a time."
                )
            return found
    raise FileError(
        path,
        "is no export of gaze that is known",
        "its columns",
        "Export from Tobii Pro Lab (TSV with Recording timestamp and Gaze point X, Y), Pupil Player "
        "(gaze_positions_on_surface) or Pupil Cloud (gaze.csv on a reference image of the screen).",
    )


def _column(rows: Sequence[Mapping[str, str]], name: str | None) -> Array:
    def number(text: str | None) -> float:
        try:
            return float((text or "nan").replace(",", "."))
        except ValueError:
            return float("nan")

    return np.array([number(r.get(name or "")) for r in rows], np.float64)


def _named(columns: Mapping[str, str], *starts: str) -> str | None:
    return next((c for start in starts for low, c in columns.items() if low.startswith(start)), None)


def _tobii(rows: Sequence[Mapping[str, str]], columns: Mapping[str, str]) -> GazeRecording | None:
    time, x, y = (
        _named(columns, "recording timestamp"),
        _named(columns, "gaze point x"),
        _named(columns, "gaze point y"),
    )
    if time is None or x is None or y is None:
        return None
    sensor = _named(columns, "sensor")
    kept = [r for r in rows if sensor is None or "eye" in (r.get(sensor) or "eye").lower()]
    scale = 1e-3 if "[ms]" in time else 1e-6
    return GazeRecording(
        _column(kept, time) * scale, np.stack([_column(kept, x), _column(kept, y)], 1), False, False
    )


def _pupil_surface(rows: Sequence[Mapping[str, str]], columns: Mapping[str, str]) -> GazeRecording | None:
    time, x, y = (
        _named(columns, "gaze_timestamp", "timestamp"),
        _named(columns, "x_norm"),
        _named(columns, "y_norm"),
    )
    if time is None or x is None or y is None:
        return None
    places = np.stack([_column(rows, x), 1 - _column(rows, y)], 1)  # Pupil counts from below
    sure = _named(columns, "confidence")
    if sure is not None:
        places[_column(rows, sure) < LEAST] = np.nan
    on = _named(columns, "on_surf")
    if on is not None:
        places[[str(r[on]).strip().lower() not in ("true", "1") for r in rows]] = np.nan
    return GazeRecording(_column(rows, time), places, True, False)


def _pupil_cloud(rows: Sequence[Mapping[str, str]], columns: Mapping[str, str]) -> GazeRecording | None:
    time = _named(columns, "timestamp [ns]")
    x = _named(columns, "gaze position in reference image x", "gaze position on surface x", "gaze x [px]")
    y = _named(columns, "gaze position in reference image y", "gaze position on surface y", "gaze y [px]")
    if time is None or x is None or y is None:
        return None
    # Whole nanoseconds since 1970 have more digits than a float; a float's are good to a quarter of a
    # microsecond.
    return GazeRecording(
        _column(rows, time) * 1e-9, np.stack([_column(rows, x), _column(rows, y)], 1), "surface" in x, True
    )


# --- on what it lay


def find_clock_offset(log: StudyLog, gaze: GazeRecording, clap: float | None) -> float:
    """Return the seconds to add to a recording's times to have those since 1970. clap: when the recording
    shows the sitting's first clap, in its own seconds; None if its times are those since 1970. Raises
    ValueError.
    """
    if clap is None:
        if gaze.epoch:
            return 0.0
        raise ValueError("say when the recording shows the first clap: its times are the recorder's own")
    marks = [e for e in log.events if e["type"] == "marker"]
    if not marks:
        raise ValueError(f"the log of {log.participant} has no clap; set 'claps: true' in the study file")
    return read_moment(marks[0]).timestamp() - clap


def tabulate_dwell(log: StudyLog, gaze: GazeRecording, clap: float | None = None) -> Table:
    """Return how long each panel, and each node in it, was looked at in each task: seconds, share of what was
    measured, visits. Raises ValueError if the times cannot be brought together.
    """
    shift = find_clock_offset(log, gaze, clap)
    size = _screen(log)
    ratio = size.get("ratio") or 1.0
    places = gaze.places / ratio
    if gaze.scaled:
        places = gaze.places * [size.get("width", 1.0), size.get("height", 1.0)]
    seconds = gaze.seconds + shift
    lasts = np.minimum(np.diff(seconds, append=seconds[-1:]), GAP) if len(seconds) else seconds
    rows: list[tuple[Any, ...]] = []
    for begun, ended, layouts in _tasks(log):
        inside = (seconds >= begun[0]) & (seconds < ended)
        seen = inside & np.isfinite(places).all(1)
        found: dict[str, list[float]] = {}
        before = ""
        for n in np.flatnonzero(seen).tolist():
            name = _area(_layout(layouts, seconds[n]), *places[n].tolist())
            mine = found.setdefault(name, [0.0, 0.0])
            mine[0] += float(lasts[n])
            mine[1] += name != before
            before = name
        total = sum(s for s, _ in found.values())
        lost = 1 - seen.sum() / max(1, inside.sum())
        rows += [
            (
                log.participant,
                begun[1].get("condition"),
                begun[1].get("task"),
                name,
                s,
                s / total if total else 0.0,
                int(v),
                float(lost),
            )
            for name, (s, v) in sorted(found.items(), key=lambda item: -item[1][0])
        ]
    return ("participant", "condition", "task", "area", "seconds", "share", "visits", "samples_lost"), rows


def _screen(log: StudyLog) -> dict[str, float]:
    """Return what the log says of the screen: width and height, logical pixels, and device pixels for
    each.
    """
    for e in log.events:
        machine = e.get("machine")
        if e["type"] == "begin" and isinstance(machine, dict) and isinstance(machine.get("screen"), dict):
            return {str(k): float(v) for k, v in machine["screen"].items() if isinstance(v, int | float)}
    return {}


Layout = Mapping[str, Sequence[float]]


def _tasks(log: StudyLog) -> list[tuple[tuple[float, Event], float, list[tuple[float, Layout]]]]:
    """Return each task's begin, end, and the layouts of the screen up to then."""
    out = []
    layouts: list[tuple[float, Layout]] = []
    begun: tuple[float, Event] | None = None
    for e in log.events:
        at = read_moment(e).timestamp()
        if e["type"] == "view" and e.get("what") == "layout" and isinstance(e.get("areas"), dict):
            layouts.append((at, e["areas"]))
        if e["type"] == "phase":
            if begun is not None:
                out.append((begun, at, layouts))
            begins = e.get("name") == "task" and e.get("state") == "begin"
            begun = (at, e) if begins else None
    return out


def _layout(layouts: Sequence[tuple[float, Layout]], at: float) -> Layout:
    return next((areas for when, areas in reversed(layouts) if when <= at), layouts[0][1] if layouts else {})


def _area(areas: Layout, x: float, y: float) -> str:
    """Return the smallest area a place lies in."""
    hits = [
        (float(a[2]) * float(a[3]), name)
        for name, a in areas.items()
        if len(a) == 4 and a[0] <= x < a[0] + a[2] and a[1] <= y < a[1] + a[3]
    ]
    return min(hits)[1] if hits else ELSEWHERE
