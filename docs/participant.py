"""Let the scripted participant do the labelling task in both conditions: `python docs/participant.py`, under
Xvfb.

With 10, 20, 50, 100 and 152 of the sample clips, or with the numbers given, through the real windows with
real events (needs xdotool; half an hour for all). Writes docs/participant.md, a table, and
docs/participant.svg, how each grows. A run that was interrupted goes on where it was; `--anew` begins again.
"""

from __future__ import annotations

import json
import math
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from PySide6.QtCore import QPoint, QSettings  # noqa: E402
from PySide6.QtTest import QTest  # noqa: E402

from app.main import prepare  # noqa: E402

SIZES = (10, 20, 50, 100, 152)
NAMES = {
    "meta": "meta-graph",
    "manual": "state machine, to and from stances only",
    "manual, every connection": "state machine, every connection",
}
COLORS = {"meta": "#2a9d8f", "manual": "#e09f3e", "manual, every connection": "#c1554b"}
OPERATORS = "KPBHM"
TICKS = {1: "1 min", 3: "3 min", 10: "10 min", 30: "30 min", 60: "1 h", 180: "3 h", 600: "10 h"}


ABOVE = """# What each way of authoring costs an expert's hands

Made by `xvfb-run -a -s "-screen 0 1920x1200x24" python docs/participant.py`: a scripted participant that makes no mistakes does the same
task in both conditions through the real windows, with real drags, clicks and keys, one clip after another. Operators are counted by the
program's own recorder; times are those of the keystroke-level model (K 0.28, P 1.10, B 0.10, H 0.40, M 1.35 s; a drag is P B P B; a
thought stands before each clip, each link, each other setting and each command). Scrolling and waiting are not counted, nor is looking at
motion or trying out times.

The state machine is drawn twice: *every connection* a meta-graph implies, which is the equivalent machine, and only those *to and from
stances*, which lets every clip play but none follow another without coming to rest. A request link between two clips gets its exit time.

![How the predicted time grows with the clips](participant.svg)

| clips | condition | K | P | B | H | M | predicted | a clip | times the meta-graph | connections | missing | mistakes | processor |
|---|---|---|---|---|---|---|---|---|---|---|---|---|---|
"""
BELOW = """

*Missing*: connections of the meta-graph's machine that were not drawn. *Mistakes*: wrong, unwanted or ill-timed ones. *Processor*: what
the program and the software renderer took meanwhile, on two shared cores without a graphics card; the script waits for nothing else.

These are predictions of what hands do, for somebody who never errs and knows what is right. In the paper one animator took 8 hours with
a meta-graph and 63 with a state machine for 152 clips, most of it looking, deciding and finding mistakes.
"""


class Bot:
    """Waits, as the tests' own does."""

    def waitUntil(self, until: Callable[[], bool], timeout: int) -> None:
        end = time.monotonic() + timeout / 1000
        while not until():
            if time.monotonic() > end:
                raise TimeoutError("what was waited for did not come")
            QTest.qWait(10)

    def wait(self, milliseconds: int) -> None:
        QTest.qWait(milliseconds)


def done(condition: str, clips: int) -> dict[str, Any]:
    """Do a task; return what it took."""
    from app.main import make_window
    from app.project.files import SAMPLE
    from metagraph.formats.store import open_project
    from tests.app.conftest import Driver
    from tests.app.participant import Participant, bare, task

    QSettings().clear()
    window = make_window()
    window.resize(1680, 1020)
    window.show()
    window.make_late_panels()
    window.activateWindow()
    corner = window.statusBar().mapToGlobal(QPoint(300, 8))
    subprocess.run(
        ["xdotool", "mousemove", str(corner.x()), str(corner.y()), "click", "1"], check=True, timeout=10
    )
    QTest.qWait(300)
    drive = Driver(window, Bot())
    given = task(open_project(SAMPLE).project, clips)
    bare(drive, given, condition)
    result = Participant(drive, given).do(condition)
    window.shell.document.undo_stack.setClean()
    window.close()
    QTest.qWait(50)
    s = result.score
    return {
        "condition": condition,
        "clips": clips,
        "operators": dict(result.operators),
        "predicted": result.predicted,
        "seconds": result.seconds,
        "ours": result.ours,
        "connections": s.right,
        "missing": s.missing,
        "mistakes": s.extra + s.wrong + sum(m.count for m in s.mistakes if m.what != "missing"),
    }


def table(rows: Sequence[Mapping[str, Any]]) -> str:
    """Return what was found as a page."""
    lines = []
    for row in sorted(rows, key=lambda r: (r["clips"], list(NAMES).index(r["condition"]))):
        base = next((r for r in rows if r["clips"] == row["clips"] and r["condition"] == "meta"), row)
        cells = [
            row["clips"],
            NAMES[row["condition"]],
            *(f"{row['operators'].get(k, 0):,}" for k in OPERATORS),
        ]
        cells += [
            time_words(row["predicted"]),
            f"{row['predicted'] / row['clips']:.1f} s",
            f"{row['predicted'] / base['predicted']:.1f}",
        ]
        cells += [f"{row['connections']:,}", f"{row['missing']:,}", row["mistakes"], f"{row['ours']:.0f} s"]
        lines.append(f"| {' | '.join(map(str, cells))} |")
    return f"{ABOVE}{chr(10).join(lines)}{BELOW}"


def time_words(seconds: float) -> str:
    return f"{seconds / 3600:.1f} h" if seconds >= 5400 else f"{seconds / 60:.1f} min"


def plot(rows: Sequence[Mapping[str, Any]]) -> str:
    """Return predicted minutes over clips, both on log scales, as SVG that stands on light and dark pages."""
    wide, high, left, top, right, bottom = 760, 430, 64, 20, 250, 48
    sizes = sorted({r["clips"] for r in rows})
    minutes = [r["predicted"] / 60 for r in rows]
    x1, x2 = math.log(min(sizes) * 0.9), math.log(max(sizes) * 1.1)
    y1, y2 = math.log10(0.7 * min(minutes)), math.log10(1.6 * max(minutes))

    def x(clips: float) -> float:
        return left + (wide - left - right) * (math.log(clips) - x1) / max(1e-9, x2 - x1)

    def y(value: float) -> float:
        return high - bottom - (high - top - bottom) * (math.log10(value) - y1) / (y2 - y1)

    gray = "#858d99"
    parts = []
    for value, words in TICKS.items():
        if y1 <= math.log10(value) <= y2:
            at = y(value)
            parts.append(
                f'<line x1="{left}" x2="{wide - right}" y1="{at:.1f}" y2="{at:.1f}" stroke="{gray}" '
                'stroke-opacity=".3"/>'
            )
            parts.append(
                f'<text x="{left - 8}" y="{at + 4:.1f}" text-anchor="end" fill="{gray}">{words}</text>'
            )
    for size in sizes:
        parts.append(
            f'<text x="{x(size):.1f}" y="{high - bottom + 20}" text-anchor="middle" '
            f'fill="{gray}">{size}</text>'
        )
    parts.append(
        f'<text x="{(left + wide - right) / 2}" y="{high - 6}" text-anchor="middle" '
        f'fill="{gray}">clips</text>'
    )
    for condition, color in COLORS.items():
        mine = sorted((r for r in rows if r["condition"] == condition), key=lambda r: r["clips"])
        if not mine:
            continue
        points = [(x(r["clips"]), y(r["predicted"] / 60)) for r in mine]
        way = " ".join(f"{a:.1f},{b:.1f}" for a, b in points)
        parts.append(f'<polyline points="{way}" fill="none" stroke="{color}" stroke-width="2.5"/>')
        parts += [f'<circle cx="{a:.1f}" cy="{b:.1f}" r="4" fill="{color}"/>' for a, b in points]
        last = mine[-1]
        *first, words = NAMES[condition].split(", ")
        for n, line in enumerate([*first, f"{words}, {time_words(last['predicted'])}"]):
            parts.append(
                f'<text x="{points[-1][0] + 14:.1f}" y="{points[-1][1] + 4 + 15 * n:.1f}" '
                f'fill="{color}">{line}</text>'
            )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide} {high}" font-family="sans-serif" '
        'font-size="12" role="img" '
        f'aria-label="Predicted time of both conditions over the number of clips">{"".join(parts)}</svg>\n'
    )


def main(arguments: Sequence[str]) -> None:
    sizes = [int(a) for a in arguments if a.isdigit()] or SIZES
    kept = Path(tempfile.gettempdir()) / "metagraph-participant.jsonl"
    if "--anew" in arguments:
        kept.unlink(missing_ok=True)
    rows = [json.loads(line) for line in kept.read_text().splitlines()] if kept.is_file() else []
    prepare()
    for size in sizes:
        for condition in NAMES:
            if any(r["clips"] == size and r["condition"] == condition for r in rows):
                continue
            row = done(condition, size)
            print(
                f"{size} clips, {NAMES[condition]}: {time_words(row['predicted'])} predicted, "
                f"{row['seconds']:.0f} s here",
                flush=True,
            )
            rows.append(row)
            with kept.open("a") as file:
                file.write(json.dumps(row) + "\n")
    (ROOT / "docs" / "participant.md").write_text(table(rows), encoding="utf-8")
    (ROOT / "docs" / "participant.svg").write_text(plot(rows), encoding="utf-8")
    print("docs/participant.md\ndocs/participant.svg")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        import os

        os.environ["XDG_CONFIG_HOME"] = os.environ["XDG_DATA_HOME"] = folder
        QSettings.setDefaultFormat(QSettings.Format.IniFormat)
        QSettings.setPath(QSettings.Format.IniFormat, QSettings.Scope.UserScope, folder)
        main(sys.argv[1:])
