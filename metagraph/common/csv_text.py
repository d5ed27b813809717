"""Tables as text, with commas or tabs: what a spreadsheet would take for a formula stays a text.

A text that begins as a formula does (`=`, `+`, `-`, `@`, a tab, a line end) gets an apostrophe in front, and
so does one that has apostrophes before such a beginning; numbers stay numbers. `restore_cell` takes it off
again.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import Any

_FORMULA = re.compile("'*[=+\\-@\t\r\n\uff1d\uff0b\uff0d\uff20]")  # as full-width signs, too
_KEPT = re.compile("'+[=+\\-@\t\r\n\uff1d\uff0b\uff0d\uff20]")
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")


def format_csv(rows: Iterable[Sequence[Any]], separator: str = ",") -> str:
    """Return rows of texts and numbers as a table."""
    special = re.compile(f'[{re.escape(separator)}"\r\n]')  # `csv` leaves a lone "\r" without quotes

    def cell(value: Any) -> str:
        text = "" if value is None else str(escape_cell(value))
        return '"' + text.replace('"', '""') + '"' if special.search(text) else text

    return "".join(separator.join(map(cell, row)) + "\n" for row in rows)


def escape_cell(value: Any) -> Any:
    """Return a cell that no spreadsheet computes with."""
    if isinstance(value, str) and _FORMULA.match(value) and not _NUMBER.fullmatch(value):
        return f"'{value}"
    return value


def restore_cell(cell: str) -> str:
    """Return the text of a cell that `plain` may have changed."""
    return cell[1:] if _KEPT.match(cell) else cell
