"""What labelling with the meta-graph takes a person without proposals who sets kind, stance, end and layer
each for many clips at once in the table. The steps are found here; the window carries the same ones out.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from itertools import product

from metagraph.graph import edits
from metagraph.graph.edit_error import EditError
from metagraph.graph.model import LAYERS, Action, Project
from metagraph.graph.name_search import matches_search
from metagraph.playback.action_table import (
    CHOICES,
    COLUMNS,
    ActionRow,
    Column,
    list_rows,
    read_cell,
    write_cells,
)
from metagraph.playback.name_fields import fill_from_names, parse_name_pattern
from metagraph.research.study.machines.counted_hand import OperatorCounts, strip_project
from metagraph.research.study.machines.covering import as_set
from metagraph.research.study.machines.finding import Finder
from metagraph.research.study.machines.klm import predict_seconds
from metagraph.research.study.machines.normal_machine import normalize_machines
from metagraph.research.study.scores.machines import Score, score

SEARCHED = COLUMNS[:8]  # as the table of the window searches: names and labels
SHOWN = tuple(column for column in COLUMNS if column != "clip")  # which Left and Right go through
ENDS: tuple[Column, ...] = ("stance", "end_stance")
BETWEEN = re.compile(r"[\s_.\-]+(?:to[\s_.\-]+)?", re.IGNORECASE)  # what may stand between parts of names


@dataclass(frozen=True)
class FromNames:
    """Fill the fields of all rows whose names fit a pattern."""

    pattern: str


@dataclass(frozen=True)
class SetFound:
    """Search for rows, select all that were found, and type a value into a column."""

    words: str
    column: Column
    typed: str
    value: str


Step = FromNames | SetFound


@dataclass(frozen=True)
class FilledTable:
    """operators: of the hands. seconds: predicted. score: beside the reference."""

    steps: tuple[Step, ...]
    operators: dict[str, int]
    seconds: float
    score: Score


def label_by_fields(reference: Project, from_names: bool = True) -> FilledTable:
    """Label a reference's clips field by field in the quickest order that is tried; `from_names`: also with
    patterns of names. Raises ValueError if none labels them all.
    """
    found = []
    for by_names, first in product((True, False) if from_names else (False,), ("fidget", "gesture")):
        steps = _find_steps(reference, by_names, first)
        if steps is not None:
            found.append(_count(reference, steps))
    if not found:
        raise ValueError("names do not tell the clips apart")
    return min(found, key=lambda filled: filled.seconds)


def strip_labels(reference: Project) -> Project:
    """Return a reference's clips with no action and no stance."""
    project = strip_project(reference)
    for layer in LAYERS:
        for stance in list(project.graphs[layer].stances):
            project = edits.remove_stance(project, stance)
    return project


def apply_step(project: Project, step: Step) -> Project:
    """Return a project after a step."""
    rows = list_rows(project)
    if isinstance(step, FromNames):
        return write_cells(project, fill_from_names(project, rows, parse_name_pattern(step.pattern))).project
    found = [row for row in rows if not step.words or matches_search(step.words, describe_row(project, row))]
    return write_cells(project, {(row.ident, step.column): step.value for row in found}).project


def describe_row(project: Project, row: ActionRow) -> str:
    """Return the text in which the table searches."""
    return " ".join(read_cell(project, row, column) for column in SEARCHED)


def _count(reference: Project, steps: Sequence[Step]) -> FilledTable:
    made, project = OperatorCounts(), strip_labels(reference)
    made.think()
    made.keys(2)  # the table
    column: Column = "kind"
    naming = False
    for step in steps:
        made.think()
        if isinstance(step, FromNames):
            made.keys(2) if naming else made.click()
            made.think(step.pattern.count("{"))
            made.keys(len(step.pattern) + 1)
            naming = True
        else:
            made.think(1 + step.words.count(" ") + step.words.count("|"))
            made.keys(2 + max(1, len(step.words)) + 1)
            made.keys(abs(SHOWN.index(step.column) - SHOWN.index(column)) + len(step.typed) + 1)
            column = step.column
        project = apply_step(project, step)
    found = score(normalize_machines(project, False), normalize_machines(reference, False))
    return FilledTable(tuple(steps), dict(made.counts), predict_seconds(made.counts), found)


def _find_steps(reference: Project, by_names: bool, first: str) -> list[Step] | None:
    """Return the steps of one order; None if they do not label all clips as the reference has them."""
    sought = _Search(reference)
    if by_names and not sought.fill_from_names():
        return None
    done = [
        *(sought.set_stances(column) for column in ("stance", "end_stance")),
        *(
            sought.set("layer", layer, [c for c, a in sought.truth.items() if a.layer == layer])
            for layer in LAYERS
        ),
        *(
            sought.set("kind", kind, [c for c, a in sought.truth.items() if a.kind == kind])
            for kind in ("transition", first, "gesture" if first == "fidget" else "fidget", "stance")
        ),
    ]
    made = {a.clip for a in sought.project.actions()}
    return sought.steps if all(done) and made == set(sought.truth) else None


class _Search:
    """Takes steps towards a reference, one after the other."""

    def __init__(self, reference: Project) -> None:
        self.truth: dict[str, Action] = {action.clip: action for action in reference.actions()}
        self.project, self.steps = strip_labels(reference), list[Step]()
        stances = [s for layer in LAYERS for s in reference.graphs[layer].stances.values()]
        self.names = {stance.id: stance.name for stance in stances}  # what each is called here

    def fill_from_names(self) -> bool:
        """Fill stances and ends by the patterns that fill most; return whether any fill two clips."""
        rows = list_rows(self.project)
        texts = sorted(
            {t for row in rows for t in BETWEEN.findall(self.project.clips[row.clip].name)}, key=len
        )
        ways: list[str | None] = [*reversed(texts), None]
        best: tuple[int, Sequence[str], Mapping[str, str]] = 1, (), {}
        for way, rest in product(ways, texts):
            patterns = ([f"{{stance}}{way}{{end}}"] if way else []) + [f"{{stance}}{rest}*"]
            names = self._names_after(patterns)
            if names is not None and names[0] > best[0]:
                best = names[0], patterns, names[1]
        for pattern in best[1]:
            self._take(FromNames(pattern))
        self.names |= best[2]
        return bool(best[1])

    def _names_after(self, patterns: Sequence[str]) -> tuple[int, dict[str, str]] | None:
        """Return how many fields patterns fill, and what each stance is called then; None if any is wrong."""
        project = self.project
        for pattern in patterns:
            try:
                project = apply_step(project, FromNames(pattern))
            except EditError:
                return None
        names: dict[str, str] = {}
        filled = 0
        for row in list_rows(project):
            for column in ENDS:
                text, ident = read_cell(project, row, column), getattr(self.truth[row.clip], column)
                if text and (ident is None or names.setdefault(ident, text) != text):
                    return None
                filled += bool(text)
        return (filled, names) if len(set(names.values())) == len(names) else None

    def set_stances(self, column: Column) -> bool:
        """Set where clips begin, or where they end, stance by stance; return whether that was possible."""
        done = True
        for ident, name in self.names.items():
            clips = [c for c, a in self.truth.items() if getattr(a, column) == ident]
            done = self.set(column, name, clips) and done
        return done

    def set(self, column: Column, value: str, clips: Sequence[str]) -> bool:
        """Set a column of clips that do not say so yet, found by the shortest words, all at once if there are
        such, else one by one; return whether all were found.
        """
        rows = list_rows(self.project)
        known = {row.clip for row in rows if read_cell(self.project, row, column) == value}
        left = [clip for clip in clips if clip not in known]
        # Rows that say so already may be found, too, if that takes fewer letters.
        for some in (clips, left, *([clip] for clip in left)):
            if all(clip in known for clip in left):
                return True
            step = self._find(column, value, some)
            if step is not None:
                self._take(step)
                known |= set(some)
        return all(clip in known for clip in left)

    def _find(self, column: Column, value: str, clips: Collection[str]) -> SetFound | None:
        rows = list_rows(self.project)
        wanted = as_set(n for n, row in enumerate(rows) if row.clip in clips)
        typed = value[0] if column in CHOICES else value
        if wanted == (1 << len(rows)) - 1:
            return SetFound("", column, typed, value)
        words = Finder([describe_row(self.project, row) for row in rows]).best(wanted)
        return SetFound(words.text, column, typed, value) if words is not None else None

    def _take(self, step: Step) -> None:
        self.steps.append(step)
        self.project = apply_step(self.project, step)
