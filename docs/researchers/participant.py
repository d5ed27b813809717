"""Let scripted experts do the labelling task in both conditions: `python docs/researchers/participant.py`,
under Xvfb.

With 10, 20, 50, 100 and 152 of the sample clips, or with the numbers given, through the real windows with
real events (needs xdotool; half an hour for all), each in the quickest way known; ways that nobody would go
who knows the tool are counted with the real edits, without the window. Writes the tables of
docs/researchers/experts-paths.md, experts-paths-tables.md and experts-paths-search.md, and
docs/images/participant.svg. A run that was interrupted continues where it was; `--again` starts from the beginning.
`--takes 500` prints what so many clips take without proposals, counted without the window.
"""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from PySide6.QtCore import QPoint, QSettings  # noqa: E402
from PySide6.QtTest import QTest  # noqa: E402

from app.main import prepare_application  # noqa: E402
from metagraph.research.study.machines.klm import predict_seconds  # noqa: E402

SIZES = (10, 20, 50, 100, 152)
PROPOSED, FROM_NAMES, BY_FIELDS, ONE_BY_ONE = (
    "meta-graph, proposals",
    "meta-graph, no proposals",
    "meta-graph, no patterns either",
    "meta-graph, clip by clip",
)
BEST, FROM_ANY = "state machine, best way found", "state machine, from any state"
EVERY = "state machine, link by link"
SHOWN = (PROPOSED, FROM_NAMES, BY_FIELDS, ONE_BY_ONE, BEST, FROM_ANY, EVERY)
COLORS = dict(
    zip(SHOWN, ("#2a9d8f", "#55a99b", "#7fb8a4", "#b5cfc2", "#c1554b", "#e09f3e", "#d9b98a"), strict=True)
)
OPERATORS = "KPBHMS"
TICKS = {
    0.1: "6 s",
    0.3: "20 s",
    1: "1 min",
    3: "3 min",
    10: "10 min",
    30: "30 min",
    60: "1 h",
    180: "3 h",
    600: "10 h",
}
IN_WINDOW = 50  # clips, up to which states laid out by hand are in reach of a rubber band in one window
LOOK = {"K": 2}  # on to the next clip in the library, and play it


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


def window() -> Any:
    """Return a hand in a new window."""
    from app.main import make_window
    from tests.app.conftest import Driver

    QSettings().clear()
    made = make_window()
    made.resize(1680, 1020)
    made.show()
    made.make_late_panels()
    made.activateWindow()
    corner = made.statusBar().mapToGlobal(QPoint(300, 8))
    subprocess.run(
        ["xdotool", "mousemove", str(corner.x()), str(corner.y()), "click", "1"], check=True, timeout=10
    )
    QTest.qWait(300)
    return Driver(made, Bot())


def looked_at(row: Mapping[str, Any]) -> dict[str, Any]:
    """Return a row of clips dropped one by one with each looked at before: keys and the clips' own time."""
    from app.project.files import SAMPLE
    from metagraph.formats.store import open_project
    from tests.app.participant import task

    clips = task(open_project(SAMPLE).project, row["clips"]).project.clips.values()
    operators = dict(row["operators"])
    for name, count in LOOK.items():
        operators[name] += count * len(clips)
    every = sum(e.duration for e in clips)
    times = {"hands": predict_seconds(operators), "seconds": predict_seconds({**operators, "L": every})}
    return {**row, "look": True, "operators": operators, **times}


def done(condition: str, clips: int, named: bool, look: bool) -> dict[str, Any]:
    """Do a task; return what it took."""
    from app.project.files import SAMPLE
    from metagraph.formats.store import open_project
    from metagraph.research.study.machines.by_hand import Way
    from metagraph.research.study.machines.counted_fields import label_by_fields
    from metagraph.research.study.machines.counted_hand import search_ways, try_way
    from metagraph.research.study.machines.normal_machine import normalize_machines
    from metagraph.research.study.scores.machines import score
    from tests.app.expert import Expert, Reviewer, TableExpert, hidden, without_times
    from tests.app.participant import Participant, bare, task

    given = task(open_project(SAMPLE).project, clips)
    given = given if named else hidden(given)
    row: dict[str, Any] = {"condition": condition, "clips": clips, "named": named, "look": look}
    every = sum(e.duration for e in given.project.clips.values())
    counted: Any = None
    if condition == BEST and not named and clips > IN_WINDOW:
        counted = search_ways(given.reference, named, look)[0]
        row["counted"] = True
    elif condition in (FROM_ANY, EVERY):
        links: Any = "from any state" if condition == FROM_ANY else "one by one"
        counted = try_way(Way("one by one", links, "clicks", "each", named), given.reference)
    if counted is not None:
        operators = dict(counted.operators)
        for name, count in LOOK.items():
            operators[name] += count * clips * look * (condition != BEST)
        return row | told(operators, every * look, counted.score)
    drive = window()
    bare(drive, given, "manual" if condition == BEST else "meta")
    began = time.process_time()
    if condition == BEST:
        best = search_ways(given.reference, named)[0]
        row["way"], row["links"] = str(best.way), best.edges
        row["least"] = [w.cover.least for w in _works(given)]
        row["rectangles"] = [len(w.cover.rectangles) for w in _works(given)]
        row["tried"] = [
            [str(t.way), round(t.seconds, 1), t.edges, len(t.score.mistakes)]
            for t in search_ways(given.reference, named)
        ]
        expert = Expert(drive, given)
        expert.act = lambda _: expert.draw(best.way, look)  # type: ignore[method-assign]
        result = expert.do("best")
    elif condition == PROPOSED:
        reviewer = Reviewer(drive, given)
        reviewer.act = lambda _: reviewer.review(look)  # type: ignore[method-assign]
        result = reviewer.do("meta")
        row["corrected"] = reviewer.corrected
    elif condition in (FROM_NAMES, BY_FIELDS):
        filled = label_by_fields(given.reference, condition == FROM_NAMES)
        row["predicted without the window"] = filled.seconds
        typist = TableExpert(drive, given)
        typist.act = lambda _: typist.fill(filled.steps)  # type: ignore[method-assign]
        result = typist.do("meta")
    else:
        result = Participant(drive, given).do("meta")
    project = drive.document.project
    plain = project if condition == BEST else without_times(project)
    found = score(normalize_machines(plain), normalize_machines(given.reference))
    drive.shell.document.undo_stack.setClean()
    drive.window.close()
    QTest.qWait(50)
    operators = dict(result.operators)
    row["processor"] = time.process_time() - began
    return row | told(operators, every * look, found)


def _works(given: Any) -> list[Any]:
    from metagraph.research.study.machines.by_hand import list_works

    return list_works(given.reference)


def told(operators: dict[str, float], looked: float, found: Any) -> dict[str, Any]:
    """Return what a task took, and how right it is."""
    return {
        "operators": operators,
        "hands": predict_seconds(operators),
        "seconds": predict_seconds({**operators, "L": looked}),
        "connections": found.right,
        "missing": found.missing,
        "mistakes": found.extra + found.wrong + sum(m.count for m in found.mistakes if m.what != "missing"),
    }


def tasks(sizes: Sequence[int]) -> list[tuple[str, int, bool, bool]]:
    """Return (condition, clips, names tell, each is looked at), in the order they are done."""
    out = []
    for size in sizes:
        for named, look in ((True, False), (True, True), (False, True)):
            some = SHOWN if named else (PROPOSED, BEST, FROM_ANY)
            fields = () if look else (FROM_NAMES, BY_FIELDS)  # nobody watches who goes by names
            out += [(c, size, named, look) for c in some if c not in (FROM_NAMES, BY_FIELDS) or c in fields]
    return out


def key(row: Mapping[str, Any]) -> tuple[str, int, bool, bool]:
    return row["condition"], row["clips"], row["named"], row["look"]


def times(rows: Sequence[Mapping[str, Any]], row: Mapping[str, Any], base: str = PROPOSED) -> str:
    """Return how many times as long a row takes as another condition of the same task."""
    first = next((r for r in rows if key(r) == (base, *key(row)[1:])), None)
    return f"{row['seconds'] / first['seconds']:.1f}" if first is not None else ""


KINDS = (
    (True, False, "Informative names; clips not watched"),
    (True, True, "Informative names; each clip watched once"),
    (False, True, "Uninformative names; each clip watched once"),
)


def fair(rows: Sequence[Mapping[str, Any]]) -> str:
    """Return the best against the best, by sizes."""
    sizes = sorted({r["clips"] for r in rows})
    by = {key(r): r for r in rows}
    out = [
        "| clips | "
        + " | ".join(title.lower() for *_, title in KINDS)
        + " | no proposals | no proposals, no patterns of names |"
    ]
    out.append("|---|" + "---|" * (len(KINDS) + 2))
    for size in sizes:
        cells = []
        for ours, theirs, named, look in (
            *((PROPOSED, BEST, named, look) for named, look, _ in KINDS),
            (FROM_NAMES, BEST, True, False),
            (BY_FIELDS, BEST, True, False),
        ):
            a, b = by.get((ours, size, named, look)), by.get((theirs, size, named, look))
            cells.append(
                f"{time_words(a['seconds'])} : {time_words(b['seconds'])} = **{b['seconds'] / a['seconds']:.1f}**"
                if a is not None and b is not None
                else ""
            )
        out.append(f"| {size} | {' | '.join(cells)} |")
    return "\n".join(out)


def table(rows: Sequence[Mapping[str, Any]]) -> str:
    """Return what was found as tables."""
    out = []
    for named, look, title in KINDS:
        out += [f"### {title}", ""]
        out.append(
            f"| clips | way | {' | '.join(OPERATORS)} | waits | hands | total | ratio to proposals | connections | mistakes |"
        )
        out.append("|---" * (len(OPERATORS) + 8) + "|")
        mine = [r for r in rows if (r["named"], r["look"]) == (named, look)]
        for row in sorted(mine, key=lambda r: (r["clips"], SHOWN.index(r["condition"]))):
            cells = [row["clips"], row["condition"] + " (counted)" * row.get("counted", False)]
            cells += [f"{row['operators'].get(k, 0):,.0f}" for k in OPERATORS]
            cells += [
                f"{row['operators'].get('R', 0):.0f} s",
                time_words(row["hands"]),
                time_words(row["seconds"]),
            ]
            ratio = times(rows, row) if row["condition"] in (PROPOSED, FROM_NAMES, BY_FIELDS, BEST) else ""
            cells += [ratio, f"{row['connections']:,}", row["mistakes"]]
            out.append(f"| {' | '.join(map(str, cells))} |")
        out.append("")
    return "\n".join(out)


def search_table(rows: Sequence[Mapping[str, Any]]) -> str:
    """Return every way that was tried at the largest task, and how few aliases there must be."""
    size = max(r["clips"] for r in rows)
    row = next(r for r in rows if key(r) == (BEST, size, True, False))
    enough, least = (", ".join(map(str, row[name])) for name in ("rectangles", "least"))
    out = [
        f"With {size} clips, the layers body, arms and head need {enough} aliases. The lower bounds are {least}.",
        "",
        "| way | predicted time | links | mistakes |",
        "|---|---|---|---|",
    ]
    out += [f"| {way} | {time_words(s)} | {links:,} | {wrong} |" for way, s, links, wrong in row["tried"]]
    return "\n".join(out)


def time_words(seconds: float) -> str:
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 3600:.1f} h" if seconds >= 5400 else f"{seconds / 60:.1f} min"


def plot(rows: Sequence[Mapping[str, Any]]) -> str:
    """Return predicted minutes over clips, both on log scales, as SVG that stands on light and dark pages."""
    wide, high, left, top, right, bottom = 800, 430, 64, 20, 290, 48
    rows = [r for r in rows if r["named"] and r["look"]]
    sizes = sorted({r["clips"] for r in rows})
    minutes = [r["seconds"] / 60 for r in rows]
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
        points = [(x(r["clips"]), y(r["seconds"] / 60)) for r in mine]
        way = " ".join(f"{a:.1f},{b:.1f}" for a, b in points)
        parts.append(f'<polyline points="{way}" fill="none" stroke="{color}" stroke-width="2.5"/>')
        parts += [f'<circle cx="{a:.1f}" cy="{b:.1f}" r="4" fill="{color}"/>' for a, b in points]
        last = mine[-1]
        parts.append(
            f'<text x="{points[-1][0] + 12:.1f}" y="{points[-1][1] + 4:.1f}" '
            f'fill="{color}">{condition}, {time_words(last["seconds"])}</text>'
        )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide} {high}" font-family="sans-serif" '
        'font-size="12" role="img" '
        f'aria-label="Predicted time of both conditions over the number of clips">{"".join(parts)}</svg>\n'
    )


def count_takes(clips: int) -> None:
    """Print what so many clips take without proposals: the sample's, with more takes of gestures and fidgets.
    Counted without the window. The state machine is drawn in the way that is quickest for the sample.
    """
    from app.project.files import SAMPLE
    from metagraph.formats.store import open_project
    from metagraph.graph import edits
    from metagraph.research.study.machines.by_hand import Way
    from metagraph.research.study.machines.counted_fields import label_by_fields
    from metagraph.research.study.machines.counted_hand import try_way
    from tests.app.participant import task

    reference = task(open_project(SAMPLE).project, SIZES[-1]).reference
    repeated = [a for a in reference.actions() if a.kind in ("gesture", "fidget")]
    for n in range(clips - len(reference.clips)):
        action, take = repeated[n % len(repeated)], n // len(repeated) + 1
        clip = reference.clips[action.clip]
        assert clip.motion is not None
        name = f"{clip.name[:-2]}{int(clip.name[-2:]) + 10 * take}"  # wave_01, wave_11, wave_21
        more = edits.add_clips(reference, [(f"{name}.glb", 0, "", clip.motion.renamed(name))])
        added = next(c for c in more.clips if c not in reference.clips)
        reference = edits.place_clips(more, [added], action.layer, action.kind, action.stance, None)
    best = try_way(Way("many at once", "from aliases", "words", "many at once", True), reference)
    for title, found in (
        (FROM_NAMES, label_by_fields(reference)),
        (BY_FIELDS, label_by_fields(reference, False)),
        (BEST, best),
    ):
        print(f"{title}: {time_words(found.seconds)}, {len(found.score.mistakes)} kinds of mistakes")


def main(arguments: Sequence[str]) -> None:
    if "--takes" in arguments:
        count_takes(int(arguments[arguments.index("--takes") + 1]))
        return
    sizes = [int(a) for a in arguments if a.isdigit()] or SIZES
    kept = Path(tempfile.gettempdir()) / "metagraph-participant-3.jsonl"
    if "--again" in arguments:
        kept.unlink(missing_ok=True)
    rows = [json.loads(line) for line in kept.read_text().splitlines()] if kept.is_file() else []
    prepare_application()
    for one in tasks(sizes):
        if any(key(r) == one for r in rows):
            continue
        started = time.monotonic()
        plain = next((r for r in rows if key(r) == (*one[:3], False)), None)
        row = looked_at(plain) if one[0] == ONE_BY_ONE and one[3] and plain is not None else done(*one)
        print(*one, f"{time_words(row['seconds'])} predicted, {row['mistakes']} mistakes,", end=" ")
        print(f"{time.monotonic() - started:.0f} s here", flush=True)
        rows.append(row)
        with kept.open("a") as file:
            file.write(json.dumps(row) + "\n")
    rows = [r for r in rows if r["clips"] in sizes]
    for name, place, text in (
        ("experts-paths.md", "fair", fair(rows)),
        ("experts-paths-tables.md", "ways", table(rows)),
        ("experts-paths-search.md", "search", search_table(rows)),
    ):
        path = ROOT / "docs" / "researchers" / name
        before, _, rest = path.read_text(encoding="utf-8").partition(f"<!-- {place} -->")
        _, last, after = rest.partition(f"<!-- end of {place} -->")
        path.write_text(f"{before}<!-- {place} -->\n{text}\n{last}{after}", encoding="utf-8")
        print(f"docs/researchers/{name}")
    (ROOT / "docs" / "images" / "participant.svg").write_text(plot(rows), encoding="utf-8")
    print("docs/images/participant.svg")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        os.environ["XDG_CONFIG_HOME"] = os.environ["XDG_DATA_HOME"] = folder
        QSettings.setDefaultFormat(QSettings.Format.IniFormat)
        QSettings.setPath(QSettings.Format.IniFormat, QSettings.Scope.UserScope, folder)
        main(sys.argv[1:])
