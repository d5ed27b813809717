"""A study as other tools read it: BIDS, the Brain Imaging Data Structure, whose part for behaviour alone is
what a timing study needs.

`participants.tsv`, and for each task of each participant `sub-P01/beh/sub-P01_task-small_acq-meta_events.tsv`
and `_beh.tsv`, with JSON that says what the columns are; `phenotype/` with the questionnaires,
`derivatives/metagraph/` with what was computed. Times in seconds from the task's begin, by the clock of the
program, pauses included.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from metagraph import __version__
from metagraph.errors import FileError
from metagraph.formats.atomic import write_together
from metagraph.research.study.analysis.reading import Data
from metagraph.research.study.analysis.results import Results
from metagraph.research.study.interchange.bids_phenotype import make_phenotype_tables
from metagraph.research.study.logs.log import Event, read_log
from metagraph.research.study.reports.tables import (
    format_rows,
    tabulate_clips,
    tabulate_estimates,
    tabulate_mistakes,
    tabulate_people,
)
from metagraph.research.study.reports.tables import tabulate_tasks as task_table
from metagraph.research.study.scores.tasks import read_moment
from metagraph.research.study.study_plan import Study

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
            "marker": "a signal for other recordings",
            "frozen": "what is worked with was noted",
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
    "site": {"Description": "Where they took part"},
    "standing": {"Description": "How far they came: done, or broken off"},
    "first": {"Description": "The condition they were to begin with"},
    **{
        f"{c}_seconds{end}": {
            "Description": f"Active seconds a {unit} {how}, geometric mean",
            "Units": "s",
        }
        for c, how in (
            ("meta", "with the meta-graph"),
            ("manual", "with the state machine drawn by hand"),
        )
        for unit, end in (("task", ""), ("clip", "_a_clip"))
    },
    "ratio": {"Description": "The seconds by hand over those with the meta-graph"},
    "sus_meta": {"Description": "System Usability Scale, 0 to 100, more is better; meta-graph"},
    "sus_manual": {"Description": "System Usability Scale, 0 to 100, more is better; by hand"},
    "tlx_meta": {"Description": "Raw NASA-TLX, 0 to 100, less is better; meta-graph"},
    "tlx_manual": {"Description": "Raw NASA-TLX, 0 to 100, less is better; by hand"},
}


TASK_COLUMNS: Mapping[str, str] = {
    "sitting": "1 for the condition that was done first, 2 for the next",
    "index": "The phase's place in the sitting",
    "begun": "When it began, UTC",
    "finished": "Whether the participant ended it",
    "timed_out": "Whether the time limit did",
    "names": "How the clips were called: shown (their names) or hidden (numbers)",
    "seconds": "Active time",
    "wall": "From begin to end",
    "paused": "In pauses",
    "away": "In gaps of more than 60 s",
    "predicted_seconds": "What the keystroke-level model predicts for the same operators",
    "f1": "Harmonic mean of precision and recall of connections, 0 to 1",
}


def write_bids(study: Study, results: Results, out: Path) -> list[Path]:
    """Write a study into a folder as a BIDS dataset, with what was computed from it as a derivative; return
    what was written.

    Raises FileError, also where two pseudonyms or tasks would be called alike: BIDS allows letters and digits
    only.
    """
    data = results.data
    gone = {who for who, t in data.people.items() if t.standing in ("withdrawn", "deleted", "declined")}
    names = _labels(study, [*study.plan.ids], "participants")
    tasks = _labels(study, [t.id for t in study.plan.tasks], "tasks")
    there = {who: label for who, label in names.items() if study.log(who).is_file() and who not in gone}
    columns, people = tabulate_people(results)
    rows = [(f"sub-{names[row[0]]}", *row[1:]) for row in people if row[0] in there]
    content: dict[str, str] = {
        "dataset_description.json": _json(_description(study.plan.title, "raw")),
        "README": _readme(study, results),
        "participants.tsv": format_rows(("participant_id", *columns[1:]), rows, "\t"),
        "participants.json": _json({c: PEOPLE[c] for c in ("participant_id", *columns[1:]) if c in PEOPLE}),
    }
    content |= {f"task-{label}_events.json": _json(DESCRIBED) for label in tasks.values()}
    for who, label in there.items():
        for (task, condition), found in _tasks(read_log(study.log(who)).events).items():
            if task in tasks:
                stem = f"sub-{label}/beh/sub-{label}_task-{tasks[task]}_acq-{condition}"
                content[f"{stem}_events.tsv"] = format_rows(
                    COLUMNS, sorted(found, key=lambda row: row[0]), "\t"
                )
                content |= _summary(study, data, who, task, condition, stem)
    for name, ((heads, answered), told) in make_phenotype_tables(study, data, there).items():
        content[f"phenotype/{name}.tsv"] = format_rows(heads, answered, "\t")
        content[f"phenotype/{name}.json"] = _json(told)
    content |= _derived(study, results)
    return write_together(out, {name: text.encode() for name, text in content.items()})


def _description(title: str, kind: str) -> dict[str, Any]:
    made = [{"Name": "metagraph", "Version": __version__}]
    return {"Name": title, "BIDSVersion": BIDS, "DatasetType": kind, "GeneratedBy": made}


def _readme(study: Study, results: Results) -> str:
    data = results.data
    words = [
        study.plan.title,
        f"Times of authoring, recorded and written by metagraph {__version__}: people wire motion clips to a "
        f"talking character, with {' and '.join(data.conditions)}. Each task of each participant has its "
        "events "
        "(_events.tsv) and what they amount to (_beh.tsv), questionnaires are in phenotype/, what was "
        "reckoned "
        "from all of it in derivatives/metagraph/.",
        f"{len(data.participants)} participants were planned; "
        f"{len({r.run.participant for r in data.rows})} began. "
        "What is not known is n/a. Times are seconds; active ones are without pauses and gaps of more "
        "than 60 s.",
    ]
    if data.simulated:
        words.insert(1, "Nobody took part: these participants were simulated.")
    return "\n\n".join(words) + "\n"


def _summary(study: Study, data: Data, who: str, task: str, condition: str, stem: str) -> dict[str, str]:
    """Return the row of tasks.csv of one task, and what was asked in it."""
    columns, found = task_table(data)
    mine = [row for row in found if (row[0], row[1], row[2]) == (who, condition, task)]
    about = study.plan.task(task)
    told: dict[str, Any] = {"TaskName": about.name}
    if about.instructions:
        told["Instructions"] = about.instructions
    described = {c: {"Description": words} for c, words in TASK_COLUMNS.items()}
    for c in columns[3:]:
        told[c] = described.get(c, {"Description": c.replace("_", " ")})
        if c.endswith("seconds") or c in ("wall", "paused", "away"):
            told[c]["Units"] = "s"
    return {
        f"{stem}_beh.tsv": format_rows(columns[3:], [row[3:] for row in mine], "\t"),
        f"{stem}_beh.json": _json(told),
    }


def _derived(study: Study, results: Results) -> dict[str, str]:
    """Return what was computed, as a dataset of its own."""
    data = results.data
    where = "derivatives/metagraph"
    about = _description(f"{study.plan.title}: results", "derivative")
    out = {f"{where}/dataset_description.json": _json(about)}
    described = {
        "clips": (
            tabulate_clips(data),
            "The clips of a task in the order in which they were first dealt with",
        ),
        "mistakes": (tabulate_mistakes(data), "What was wrong beside the reference"),
        "estimates": (tabulate_estimates(results), "The ratio of times, as reported and reckoned otherwise"),
    }
    for name, ((columns, rows), words) in described.items():
        out[f"{where}/{name}.tsv"] = format_rows(columns, rows, "\t")
        told: dict[str, Any] = {c: {"Description": c.replace("_", " ")} for c in columns}
        out[f"{where}/{name}.json"] = _json({"Description": words, **told})
    return out


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
                0.0,
                e["mono"] - before["mono"]
                if same
                else (read_moment(e) - read_moment(before)).total_seconds(),
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
