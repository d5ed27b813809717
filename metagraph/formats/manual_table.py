"""Links of a manual machine as a table: what a spreadsheet writes, read row by row.

The first row names the columns: `from` and `to`, and as wanted `when` (finished or request), `trigger`,
`weight`, `exit` (end, at once, 80 %, or seconds) and `blend`; cells that are left empty are as a drawn link
has them. `from` and `to` are names of states or aliases, `any` for any state, a pattern such as `sitting*`,
or several of these with | between them. Several states in `from` become an alias.
"""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from io import StringIO
from pathlib import Path
from typing import Any

from metagraph.common.csv_text import format_csv, restore_cell
from metagraph.common.files import guard_reader, read_file
from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.graph.edit_error import EditError
from metagraph.graph.manual import groups as manual_groups
from metagraph.graph.manual.edits import (
    add_link,
    explain_link_refusal,
    get_machine,
    get_manual_name,
    update_links,
)
from metagraph.graph.manual.machine import ANY, WHENS, Alias, Link, Manual, State
from metagraph.graph.model import Layer, Project

COLUMNS = ("from", "to", "when", "trigger", "weight", "exit", "blend")
ALSO = {"source": "from", "target": "to", "condition": "when", "exit time": "exit", "duration": "blend"}
MOST_BYTES = 8_000_000
MOST_ROWS = 100_000
MOST_LINKS = 200_000
REMEDY = "The first row names the columns: from, to, and as wanted when, trigger, weight, exit, blend."


@dataclass(frozen=True)
class TableRow:
    """One row. number: of its line in the file, from 1. cells: by column, those that are not empty."""

    number: int
    cells: dict[str, str]


@dataclass(frozen=True)
class Filled:
    """What came of a table. links: how many were drawn; changed: how many were there, and are set again.
    problems: rows that were left out, in words.
    """

    project: Project
    links: int
    changed: int
    problems: tuple[str, ...]


@guard_reader
def read_manual_table(path: str | Path) -> list[TableRow]:
    """Read a table from a file: UTF-8, UTF-16 with its mark, or western letters. Raises FileError."""
    data = read_file(path, MOST_BYTES)
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        text = data.decode("utf-16", "replace")
    else:
        try:
            text = data.decode("utf-8-sig")
        except UnicodeDecodeError:
            text = data.decode("cp1252", "replace")
    try:
        return parse_manual_table(text)
    except ValueError as error:
        raise FileError(path, str(error), remedy=REMEDY) from None


def parse_manual_table(text: str) -> list[TableRow]:
    """Return the rows of a table with commas, semicolons or tabs between its cells. Raises ValueError with
    words where it is none.
    """
    first = next((line for line in text.splitlines() if line.strip()), "")
    separator = max(",;\t", key=first.count)
    lines = csv.reader(StringIO(text, newline=""), delimiter=separator, skipinitialspace=True)
    names: list[str] | None = None
    out: list[TableRow] = []
    try:
        for cells in lines:
            if not any(c.strip() for c in cells):
                continue
            if names is None:
                plain = [" ".join(c.lower().split()) for c in cells]
                names = [ALSO.get(n, n) for n in plain]
                check_names(names)
                continue
            if len(out) >= MOST_ROWS:
                raise ValueError(phrase("it has more than {most:,} rows", most=MOST_ROWS))
            told_of = (
                (n, restore_cell(c).strip()) for n, c in zip(names, cells, strict=False) if n in COLUMNS
            )
            known = {n: c for n, c in told_of if c}
            out.append(TableRow(lines.line_num, known))
    except csv.Error as error:
        raise ValueError(
            phrase("line {line_num} is not a table row: {error}", line_num=lines.line_num, error=error)
        ) from None
    if names is None:
        raise ValueError(phrase("it is empty"))
    return out


def check_names(names: Sequence[str]) -> None:
    """Raise ValueError where the first row names not both ends of a link, or a column twice."""
    for name in ("from", "to"):
        if name not in names:
            raise ValueError(phrase("the first row has no column '{name}'", name=name))
    twice = next((n for n in COLUMNS if list(names).count(n) > 1), None)
    if twice is not None:
        raise ValueError(phrase("the first row has the column '{twice}' twice", twice=twice))


def fill_machine(project: Project, layer: Layer, rows: Sequence[TableRow]) -> Filled:
    """Return the project with the links of a table drawn in a layer's machine. A link that is there between
    the same two is set as the row says; a row that cannot be read is left out and told.
    """
    drawn_count = changed = 0
    problems: list[str] = []
    for row in rows:
        try:
            settings = _settings(row)
            after, sources = _nodes(project, layer, row, "from")
            after, targets = _nodes(after, layer, row, "to")
            found = get_machine(after, layer)
            if len(found.links) + len(sources) * len(targets) > MOST_LINKS:
                raise ValueError(phrase("the machine would have more than {most:,} links", most=MOST_LINKS))
            # Links that patterns name lead from no state to itself, as drawn ones do.
            one = len(sources) == len(targets) == 1
            pairs = [(a, b) for a in sources for b in targets if a != b or one]
            project, new, old = _linked(after, layer, pairs, settings)
            drawn_count, changed = drawn_count + new, changed + old
        except (ValueError, EditError) as error:
            problems.append(f"line {row.number}: {error}")
    return Filled(project, drawn_count, changed, tuple(problems))


def _linked(
    project: Project, layer: Layer, pairs: Sequence[tuple[str, str]], settings: dict[str, Any]
) -> tuple[Project, int, int]:
    """Return the project with links drawn and set, how many are new, and how many were changed."""
    for a, b in pairs:
        if (why := explain_link_refusal(project, layer, a, b)) is not None:
            raise EditError(why)
    there = {(x.source, x.target): x.id for x in get_machine(project, layer).links.values()}
    new = 0
    idents: list[str] = []
    for pair in pairs:
        if pair not in there:
            project = add_link(project, layer, *pair)
            there[pair] = [*get_machine(project, layer).links][-1]
            new += 1
        idents.append(there[pair])
    project = update_links(project, idents, **settings)
    return project, new, len(pairs) - new


def _nodes(project: Project, layer: Layer, row: TableRow, column: str) -> tuple[Project, list[str]]:
    """Return what a cell names, and the project, with an alias more where several states are to be left."""
    if column not in row.cells:
        raise ValueError(phrase("'{column}' is empty", column=column))
    found = get_machine(project, layer)
    out: dict[str, None] = {}
    words = [w.strip() for w in row.cells[column].split("|")]
    for word in words:
        named = [*found.states] if (word, column) == ("*", "to") else _named(found, word)
        if not named:
            raise ValueError(
                phrase(
                    "'{column}' names '{word}', which is not a state or alias of the {layer} layer",
                    column=column,
                    word=word,
                    layer=layer,
                )
            )
        out.update(dict.fromkeys(named))
    states = tuple(i for i in found.states if i in out)
    if column == "to" or len(states) < 2:
        return project, list(out)
    same = next((a.id for a in found.aliases.values() if a.states == states), None)
    if same is None:
        project = manual_groups.add_alias(project, layer, states)
        same = [*get_machine(project, layer).aliases][-1]
        if len(words) == 1 and words[0].strip("*?_- "):
            project = manual_groups.update_aliases(project, [same], name=words[0].strip("*?_- "))
    return project, [same, *(i for i in out if i not in states)]


def _named(found: Manual, word: str) -> list[str]:
    """Return the nodes a word names: exactly, then without capitals, then as a pattern."""
    nodes: list[State | Alias] = [*found.states.values(), *found.aliases.values()]
    for fold in (str, str.casefold):
        some = [n.id for n in nodes if fold(n.name) == fold(word)]
        if some:
            return some
    if word.casefold() in ("any", "any state", "*"):
        return [ANY]
    if not any(c in word for c in "*?["):
        return []
    return [s.id for s in found.states.values() if fnmatchcase(s.name.casefold(), word.casefold())]


def _settings(row: TableRow) -> dict[str, Any]:
    """Return the fields of a link that a row sets. Raises ValueError."""
    cells, out = row.cells, dict[str, Any]()
    condition: dict[str, Any] = {}
    if "when" in cells:
        condition["when"] = cells["when"].lower()
        if condition["when"] not in WHENS:
            raise ValueError(
                phrase(
                    "'when' is '{cells}', which is none of {names}",
                    cells=cells["when"],
                    names=" or ".join(WHENS),
                )
            )
    if "trigger" in cells:
        condition |= {"trigger": cells["trigger"]} | ({"when": "request"} if "when" not in cells else {})
    if "weight" in cells:
        condition["weight"] = _number(cells["weight"], "weight", 1e-6)
    if condition:
        out["condition"] = condition
    if "blend" in cells:
        out["blend"] = _number(cells["blend"], "blend")
    if "exit" in cells:
        word = cells["exit"].lower()
        at_end, once = word == "end", word in ("at once", "none")
        part = 1.0 if at_end else _number(word[:-1], "exit") / 100 if word.endswith("%") else None
        if part is not None and part > 1:
            raise ValueError(phrase("'exit' is '{cells}', which is after the end", cells=cells["exit"]))
        out["exit_part"] = part
        out["exit_time"] = None if part is not None or once else _number(word, "exit")
    return out


def _number(word: str, column: str, least: float = 0.0) -> float:
    try:
        value = float(word.strip().removesuffix("s").strip().replace(",", "."))
    except ValueError:
        raise ValueError(
            phrase("'{column}' is '{word}', which is not a number", column=column, word=word)
        ) from None
    if not least <= value <= 1e6:
        raise ValueError(phrase("'{column}' is {word}, which is out of range", column=column, word=word))
    return value


def encode_machine_as_table(manual: Manual) -> str:
    """Return a machine's links as a table with commas, which `parse_manual_table` reads."""
    rows: list[Sequence[str]] = [COLUMNS]
    for x in manual.links.values():
        ends = (
            "any" if x.source == ANY else get_manual_name(manual, x.source),
            get_manual_name(manual, x.target),
        )
        c = x.condition
        numbers = (f"{c.weight:g}", _exit_word(x), f"{x.blend:g}")
        rows.append((*ends, c.when, c.trigger if c.when == "request" else "", *numbers))
    return format_csv(rows)


def _exit_word(link: Link) -> str:
    if link.exit_time is not None:
        return f"{link.exit_time:g}"
    if link.exit_part is None:
        return "at once" if link.condition.when == "request" else ""
    return "end" if link.exit_part >= 1 else f"{link.exit_part * 100:g} %"
