"""Which rows the table shows: a rule that is a value, so that it can be named and kept."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Literal, get_args

from PySide6.QtCore import QSettings

from app.features.table.cell_words import translate_cell
from metagraph.graph.editing.half_labels import has_half_label
from metagraph.graph.model import Project
from metagraph.graph.name_search import matches_search
from metagraph.playback.action_table import COLUMNS, ActionRow, read_cell

Which = Literal["all", "actions", "waiting", "unplaced"]
WHICH: tuple[Which, ...] = get_args(Which)
SEARCHED = COLUMNS[:8]  # names and labels; numbers would be found by chance
_KEY = "table/filters"


@dataclass(frozen=True)
class TableFilter:
    """text: as in `matches_search`, in names and labels. which: all rows, actions, clips that are half
    labelled, or all clips without an action.
    """

    text: str = ""
    which: Which = "all"

    def takes(self, project: Project, row: ActionRow) -> bool:
        """Return whether a row is shown."""
        if self.which == "actions" and row.action is None:
            return False
        if self.which == "waiting" and (row.action is not None or not has_half_label(project, row.clip)):
            return False
        if self.which == "unplaced" and row.action is not None:
            return False
        if not self.text.strip(" -|"):
            return True
        return matches_search(self.text, " ".join(_words(project, row)))


def _words(project: Project, row: ActionRow) -> list[str]:
    return [translate_cell(column, read_cell(project, row, column)) for column in SEARCHED]


def read_filters() -> dict[str, TableFilter]:
    """Return the filters that a person has named; what is broken is left out."""
    try:
        data = json.loads(str(QSettings().value(_KEY, "{}")))
    except ValueError:
        return {}
    out: dict[str, TableFilter] = {}
    for name, rule in data.items() if isinstance(data, dict) else ():
        if isinstance(rule, dict) and isinstance(rule.get("text"), str) and rule.get("which") in WHICH:
            out[str(name)] = TableFilter(rule["text"], rule["which"])
    return out


def keep_filters(filters: Mapping[str, TableFilter]) -> None:
    """Keep filters for the next time."""
    QSettings().setValue(_KEY, json.dumps({name: asdict(rule) for name, rule in filters.items()}))
