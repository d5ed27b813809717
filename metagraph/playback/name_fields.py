"""Read the fields of labels out of clips' names, by a pattern that a person writes: `{stance}__to__{end}`."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass

from metagraph.common.wording import phrase
from metagraph.graph.edit_error import EditError
from metagraph.graph.model import Project
from metagraph.playback.action_table import ActionRow, Cell, Column, list_rows, read_cell

# What a pattern calls a column, in English, as names of files mostly are.
NAME_FIELDS: Mapping[str, Column] = {
    "stance": "stance", "end": "end_stance", "kind": "kind", "layer": "layer", "limb": "limb", "tags": "tags",
}  # fmt: skip
_PARTS = re.compile(r"(\{[^{}]*\}|\*)")
_BETWEEN = re.compile(r"[\s_.\-]+")  # what stands for a blank in names of files


@dataclass(frozen=True)
class NamePattern:
    """A pattern for whole names, with the columns that it fills."""

    columns: tuple[Column, ...]
    expression: re.Pattern[str]

    def read(self, name: str) -> dict[Column, str] | None:
        """Return the fields of a name, with blanks between words; None if the name does not fit."""
        found = self.expression.fullmatch(name)
        if found is None:
            return None
        out = {column: _BETWEEN.sub(" ", found[column]).strip() for column in self.columns}
        return out if all(out.values()) else None


def parse_name_pattern(text: str) -> NamePattern:
    """Return the pattern that a text describes: names in braces are fields of `NAME_FIELDS`, `*` is anything,
    all else is as it stands in the name, in capitals or not. A field takes as little as it can. Raises
    EditError.
    """
    columns: list[Column] = []
    expression, open_field = "", ""
    for part in _PARTS.split(text.strip()):
        word = part[1:-1].strip().lower() if part.startswith("{") and part.endswith("}") else ""
        if part.startswith("{") and part.endswith("}"):
            column = NAME_FIELDS.get(word)
            if column is None:
                choices = ", ".join(f"{{{name}}}" for name in NAME_FIELDS)
                raise EditError(phrase("{part} is no field: use {choices}", part=part, choices=choices))
            if column in columns:
                raise EditError(phrase("{part} is there twice: use it once", part=part))
            if open_field:
                why = phrase(
                    "nothing tells where {first} ends and {second} begins: write what is between them",
                    first=open_field,
                    second=part,
                )
                raise EditError(why)
            columns.append(column)
            expression += f"(?P<{column}>.+?)"
        else:
            expression += ".*?" if part == "*" else re.escape(part)
        open_field = part if word else open_field if not part else ""
    if not columns:
        raise EditError(phrase("write at least one field, such as {stance}__to__{end}"))
    return NamePattern(tuple(columns), re.compile(expression, re.IGNORECASE))


def fill_from_names(project: Project, rows: Iterable[ActionRow], pattern: NamePattern) -> dict[Cell, str]:
    """Return the cells of rows that a pattern fills from the names of their clips.

    The end of a transition may leave out the beginning of a stance's name: `body_left__to__right` ends in
    *body right* if just one stance ends in *right*.
    """
    found = {row.ident: pattern.read(project.clips[row.clip].name) for row in rows}
    read = {ident: fields for ident, fields in found.items() if fields is not None}
    stances = {read_cell(project, row, "stance") for row in list_rows(project)}
    stances |= {s.name for g in project.graphs.values() for s in g.stances.values()}
    stances |= {fields.get("stance", "") for fields in read.values()}
    return {
        (ident, column): _find_whole_name(text, stances) if column == "end_stance" else text
        for ident, fields in read.items()
        for column, text in fields.items()
    }


def _find_whole_name(text: str, stances: Collection[str]) -> str:
    """Return the stance that a text names, whole or by how its name ends; the text itself if none does, or
    more than one.
    """
    wanted = text.casefold()
    exact = [name for name in stances if name.casefold() == wanted]
    ending = [name for name in stances if name.casefold().endswith(f" {wanted}")]
    return exact[0] if exact else ending[0] if len(ending) == 1 else text
