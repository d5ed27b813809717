"""A study as other tools read it: BIDS, the Brain Imaging Data Structure, whose part for behaviour alone is
what a timing study needs.

`participants.tsv`, and for each task of each participant
`sub-P01/beh/sub-P01_task-small_acq-meta_events.tsv`, with JSON beside them that says what the columns are.
Times in seconds from the task's begin, by the clock of the program, pauses included.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from metagraph import __version__
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.study.analysis import Results
from metagraph.study.log import Event, read
from metagraph.study.report_tables import clips, participants, table
from metagraph.study.study_plan import Study
from metagraph.study.tasks import moment

BIDS = "1.9.0"
SKIPPED = frozenset({"phase", "artefact", "begin", "end", "answer"})
COLUMNS = (
    "onset",
    "duration",
    "trial_type",
    "what",
    "clips",
    "words",
    "keys",
    "pointings",
    "buttons",
    "drags",
    "homings",
    "drag_seconds",
)
OPS = ("K", "P", "B", "D", "H", "drag_s")

DESCRIBED: Mapping[str, dict[str, Any]] = {
    "onset": {"Description": "When it happened, from the begin of the task", "Units": "s"},
    "duration": {
        "Description": "How long it lasted; 0 for what has no length, n/a where it is not known",
        "Units": "s",
    },
    "trial_type": {
        "Description": "What kind of event it was",
        "Levels": {
            "edit": "a change of the graph",
            "undo": "a step back",
            "redo": "a step forward again",
            "view": "another layer, stance, zoom",
            "playback": "the preview was played, paused or moved",
            "dialog": "a dialog was opened or closed",
            "error": "something was refused",
            "idle": "nothing was done for a while",
            "pause": "the sitting was paused or went on",
            "ops": "operators since the event before",
            "import": "clips were added",
            "save": "the project was saved",
            "export": "it was exported",
            "note": "a note was taken",
            "resumed": "the program was started again",
        },
    },
    "what": {"Description": "What exactly, of edits, views, playback and dialogs"},
    "clips": {"Description": "The clips it was about, with blanks between"},
    "words": {"Description": "As the window calls it"},
    "keys": {"Description": "Keys pressed (operator K)"},
    "pointings": {"Description": "Movements of the mouse to a target (operator P)"},
    "buttons": {"Description": "Mouse buttons pressed or released (operator B)"},
    "drags": {"Description": "Drags (operator D)"},
    "homings": {"Description": "Changes of the hand between keyboard and mouse (operator H)"},
    "drag_seconds": {"Description": "How long the drags lasted", "Units": "s"},
}

PEOPLE: Mapping[str, dict[str, Any]] = {
    "participant_id": {"Description": "Pseudonym"},
    "order": {"Description": "The conditions in the order in which they were done"},
    "tasks_begun": {"Description": "How many tasks were begun"},
    "tasks_done": {"Description": "How many of them were brought to an end"},
    "meta_seconds": {
        "Description": "Active seconds a task with the meta-graph, geometric mean",
        "Units": "s",
    },
    "manual_seconds": {
        "Description": "Active seconds a task with the state machine drawn by hand, geometric mean",
        "Units": "s",
    },
    "ratio": {"Description": "manual_seconds / meta_seconds"},
    "sus_meta": {"Description": "System Usability Scale, 0 to 100, more is better; meta-graph"},
    "sus_manual": {"Description": "System Usability Scale, 0 to 100, more is better; by hand"},
    "tlx_meta": {"Description": "Raw NASA-TLX, 0 to 100, less is better; meta-graph"},
    "tlx_manual": {"Description": "Raw NASA-TLX, 0 to 100, less is better; by hand"},
}


def write_bids(study: Study, results: Results, out: Path) -> list[Path]:
    """Write a study into a folder as a BIDS dataset, and per-clip times as `derivatives/clips.csv`; return
    what was written.

    Raises FileError, also where two pseudonyms or tasks would be called alike: BIDS allows letters and digits
    only.
    """
    names = _labels(study, [*study.plan.ids], "participants")
    tasks = _labels(study, [t.id for t in study.plan.tasks], "tasks")
    columns, people = participants(results)
    there = [(f"sub-{names[row[0]]}", *row[1:]) for row in people if study.log(row[0]).is_file()]
    content: dict[str, str] = {
        "dataset_description.json": _json(
            {
                "Name": study.plan.title,
                "BIDSVersion": BIDS,
                "DatasetType": "raw",
                "GeneratedBy": [{"Name": "metagraph", "Version": __version__}],
            }
        ),
        "README": (
            f"{study.plan.title}\n\nTimes of authoring, recorded and written by metagraph {__version__}."
        )
        + ("\nNobody took part: these participants were simulated." if results.data.simulated else "")
        + "\n",
        "participants.tsv": table(("participant_id", *columns[1:]), there, "\t"),
        "participants.json": _json({c: PEOPLE[c] for c in ("participant_id", *columns[1:]) if c in PEOPLE}),
        "derivatives/clips.csv": table(*clips(results.data)),
    }
    for who, label in names.items():
        if not study.log(who).is_file():
            continue
        for (task, condition), rows in _tasks(read(study.log(who)).events).items():
            if task in tasks:
                stem = f"sub-{label}/beh/sub-{label}_task-{tasks[task]}_acq-{condition}_events"
                content[f"{stem}.tsv"] = table(COLUMNS, sorted(rows, key=lambda row: row[0]), "\t")
                about = {
                    "TaskName": study.plan.task(task).name,
                    "Instructions": study.plan.task(task).instructions,
                }
                content[f"{stem}.json"] = _json({**about, **DESCRIBED})
    for name, text in content.items():
        write_atomically(out / name, text.encode())
    return [out / name for name in content]


def _labels(study: Study, idents: Sequence[str], where: str) -> dict[str, str]:
    out = {ident: re.sub(r"[^A-Za-z0-9]", "", ident) for ident in idents}
    if len({label.casefold() for label in out.values()}) < len(out):
        cause = "two of them are the same in letters and digits, and BIDS knows nothing else"
        raise FileError(study.path, cause, where, "Name them so that they differ in letters or digits.")
    return out


def _tasks(events: Sequence[Event]) -> dict[tuple[str, str], list[tuple[Any, ...]]]:
    """Return (task, condition) -> rows. Time goes on over a restart of the program by the clock on the
    wall.
    """
    out: dict[tuple[str, str], list[tuple[Any, ...]]] = {}
    rows: list[tuple[Any, ...]] | None = None
    at, before = 0.0, None
    for e in events:
        if before is not None:
            same = before["run"] == e["run"]
            at += max(
                0.0, e["mono"] - before["mono"] if same else (moment(e) - moment(before)).total_seconds()
            )
        before = e
        if e["type"] == "phase":
            begins = e.get("name") == "task" and e.get("state") == "begin"
            rows = out.setdefault((str(e.get("task")), str(e.get("condition"))), []) if begins else None
            at = 0.0 if begins else at
        elif rows is not None and e["type"] not in SKIPPED:
            rows.append(_row(e, at))
    return out


def _row(e: Event, at: float) -> tuple[Any, ...]:
    lasted = float(e.get("seconds", 0.0)) if e["type"] in ("ops", "idle", "import") else 0.0
    named = e.get("clips") if isinstance(e.get("clips"), list) else None
    what = e.get("what", e.get("name", e.get("state")))
    words = str(e["words"]).replace("\t", " ").replace("\n", " ") if e.get("words") else None
    ops = tuple(e.get(k, 0) if e["type"] == "ops" else None for k in OPS)
    return (
        round(max(0.0, at - lasted), 6),
        lasted,
        e["type"],
        what,
        " ".join(named) if named else None,
        words,
        *ops,
    )


def _json(data: Any) -> str:
    return json.dumps(data, indent=2, ensure_ascii=False) + "\n"
