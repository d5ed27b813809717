"""What `metagraph generate evaluate` writes: one page with the table and figures 6 to 8, the same as JSON,
and as CSV.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from math import isfinite
from pathlib import Path
from typing import Any

from metagraph.common.csv_text import format_csv
from metagraph.common.xml_text import escape
from metagraph.formats.atomic import write_together
from metagraph.generation.features import PARTNER, SELF
from metagraph.generation.statistics import MEASURES, MeasureRow, mean_landmarks
from metagraph.research.generation import figures
from metagraph.research.generation.evaluation import JudgedModels
from metagraph.research.study.reports.style import STYLE

REPORT = ("report.html", "report.json", "report.csv")  # what is written
NAMES = (*MEASURES, "diversity")
# What a perfect model has; "true": what recorded motion has itself.
PERFECT = {
    "distance": "floor",
    "speed": "1",
    "speed_w1": "floor",
    "acceleration": "1",
    "wrist_range": "1",
    "still": "1",
    "trembling": "1",
    "role": "true",
    "role_w1": "floor",
    "stroke": "true",
    "nods_responses": "true",
    "nods_hesitations": "true",
    "profile": "1",
    "frechet": "floor",
    "diversity": "true",
}
MEANINGS = {
    "distance": "distribution of the landmarks' distances from the mean pose: W1 divided by the mean "
    "distance",
    "speed": "mean speed divided by the recorded one; speed_w1: W1 of the speeds",
    "acceleration": "mean acceleration divided by the recorded one",
    "wrist_range": "interquartile range of the wrists' distances, divided by the recorded one",
    "still": "share of time a hand rests (mean over half a second below 4 cm/s), divided by the recorded one",
    "trembling": "mean acceleration of resting hands, divided by the recorded one",
    "role": "mean change of the distances while speaking, divided by that while listening; role_w1: W1 "
    "of figures 7, 8",
    "stroke": "speed of the hands within 0.25 s of own stresses, divided by their mean speed",
    "nods": "vertical speed of the nose relative to the head in the second after own responses and "
    "after the partner's hesitations, divided by its mean",
    "profile": "correlation of the hands' mean speed around own stresses with the recorded one",
    "frechet": "distance between Gaussians fitted to one-second pieces of motion",
    "diversity": "mean distance of the landmarks between two takes for the same speech, in cm",
}
_STYLE = f"""
body {{ max-width: 1180px; }} svg {{ max-width: 1000px; }} .wide-table {{ overflow-x: auto; }}
table {{ font-size: 12px; }} td:first-child {{ min-width: 110px; }} td .dim {{ font-size: 11px; }}
{figures.STYLE}"""


def report_as_data(rows: Sequence[MeasureRow], told: dict[str, Any]) -> dict[str, Any]:
    """Return the table as plain data, with null for unknown values. told: further entries beside the rows."""

    def plain(value: float) -> float | None:
        return round(value, 5) if isfinite(value) else None

    out = [
        {
            "name": row.name,
            "values": {n: plain(row.values[n]) for n in NAMES if n in row.values},
            "intervals": {n: [plain(a), plain(b)] for n, (a, b) in row.spread.items()},
        }
        for row in rows
    ]
    return {**told, "rows": out}


def report_as_text(rows: Sequence[MeasureRow]) -> str:
    """Return the table as text, with a line for each system."""
    wide = max([7, *(len(row.name) for row in rows)])
    short = [n.replace("nods_", "nods ").replace("_", " ") for n in NAMES]
    columns = [max(len(n), 6) for n in short]
    head = "  ".join(n.rjust(w) for n, w in zip(short, columns, strict=True))
    lines = [f"{'':{wide}}  {head}"]
    for row in rows:
        cells = (_number(row.values.get(n)).rjust(w) for n, w in zip(NAMES, columns, strict=True))
        lines.append(f"{row.name:{wide}}  {'  '.join(cells)}".rstrip())
    perfect = "  ".join(PERFECT[n].rjust(w) for n, w in zip(NAMES, columns, strict=True))
    return "\n".join([*lines, f"{'perfect':{wide}}  {perfect}"])


def report_as_csv(rows: Sequence[MeasureRow]) -> str:
    """Return the table as CSV, with name, measure, value and interval in each line."""
    lines = [["system", "measure", "value", "low", "high"]]
    for row in rows:
        for n in NAMES:
            if n in row.values:
                low, high = row.spread.get(n, (float("nan"), float("nan")))
                cells = (_number(v, 6) for v in (row.values[n], low, high))
                lines.append([row.name, n, *("" if c == "-" else c for c in cells)])
    return format_csv(lines)


def write_generation_report(
    judged: JudgedModels, told: dict[str, Any], notes: Sequence[str], folder: Path
) -> list[Path]:
    """Write the page and the tables into a folder; return what was written. Raises FileError."""
    content = {
        "report.html": format_generation_page(judged, told, notes),
        "report.json": json.dumps({**report_as_data(judged.rows, told), "notes": list(notes)}, indent=1)
        + "\n",
        "report.csv": report_as_csv(judged.rows),
    }
    assert tuple(content) == REPORT
    return write_together(folder, {name: text.encode() for name, text in content.items()})


def format_generation_page(judged: JudgedModels, told: dict[str, Any], notes: Sequence[str]) -> str:
    """Return the page."""
    mean = mean_landmarks(judged.true)
    systems = {"true": judged.true}
    systems |= {name: seeds[0] for name, seeds in judged.made.items()}
    far = {name: figures.measure_landmark_distances(motion, mean) for name, motion in systems.items()}
    most = max(float(v.max()) for v in far.values())
    parts = ["<h1>Generated and recorded motion</h1>", "<div class='card'>"]
    parts += [f"<p>{escape(str(k))}: {escape(str(v))}</p>" for k, v in told.items()]
    parts += ["</div>", *(f"<p class='warn'>{escape(n)}</p>" for n in notes)]
    parts += ["<h2>Table</h2>", format_report_table(judged.rows)]
    parts.append(
        "<p class='dim'>Under each value what 95 % of draws of blocks of 15 s give. <i>floor</i>: other "
        "motion as true as the recorded one; <i>mismatched</i>: recorded motion to other speech; <i>mean "
        "pose</i>: a figure that stands still. Read each value only together with these.</p>"
    )
    words = "".join(f"<dt>{escape(k)}</dt><dd>{escape(v)}</dd>" for k, v in MEANINGS.items())
    parts += [f"<dl>{words}</dl>", "<h2>Figure 6: distance from the mean pose</h2>"]
    for name, motion in systems.items():
        parts.append(_figure(figures.draw_over_time(motion[0], mean, most), f"{name}: the first take"))
    parts.append(
        _figure(figures.draw_boxes(far, "cm"), "All takes; Tukey's whiskers, notches around the median")
    )
    first = {name: motion[0] for name, motion in systems.items()}
    parts.append(
        _figure(figures.draw_overlaid(first), "Poses of the first take, one a second, from the front")
    )
    for number, who, words in ((7, SELF, "the speaker speaks"), (8, PARTNER, "the partner speaks")):
        parts.append(f"<h2>Figure {number}: how fast that distance changes while {words}</h2>")
        grown = {
            name: figures.measure_distance_changes(motion, mean, who) for name, motion in systems.items()
        }
        parts.append(_figure(figures.draw_boxes(grown, "cm/s"), "All takes; the first seed of each model"))
    head = "<meta charset='utf-8'><title>Generated motion</title>"
    return f"<!DOCTYPE html><html lang='en'><head>{head}<style>{STYLE}{_STYLE}</style></head><body>" + (
        "\n".join(parts) + "</body></html>\n"
    )


def format_report_table(rows: Sequence[MeasureRow]) -> str:
    """Return the table as HTML, with a row for each measure and a column for each system."""
    head = "".join(f"<th>{escape(n)}</th>" for n in ("", *(row.name for row in rows), "perfect"))
    body = []
    for n in NAMES:
        cells = [f"<td>{escape(n.replace('_', ' '))}</td>"]
        for row in rows:
            low, high = row.spread.get(n, (float("nan"), float("nan")))
            more = f"<br><span class='dim'>{_number(low)} to {_number(high)}</span>" if isfinite(low) else ""
            cells.append(f"<td>{_number(row.values.get(n))}{more}</td>")
        body.append(f"<tr>{''.join(cells)}<td class='dim'>{PERFECT[n]}</td></tr>")
    table = f"<table><thead><tr>{head}</tr></thead><tbody>{''.join(body)}</tbody></table>"
    return f"<div class='wide-table'>{table}</div>"


def _figure(svg: str, caption: str) -> str:
    return f"<figure>{svg}<figcaption>{escape(caption)}</figcaption></figure>"


def _number(value: float | None, digits: int = 3) -> str:
    return "-" if value is None or not isfinite(value) else f"{value:.{digits}g}"
