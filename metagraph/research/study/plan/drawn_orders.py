"""Which of the counterbalanced orders were drawn for whom, as it is noted beside a study."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Any

import msgspec

from metagraph.common.budgets import LOG_FILE
from metagraph.common.files import read_file

LOG = "allocation.jsonl"


def read_drawn_orders(folder: Path) -> dict[str, int]:
    """Return participant -> the number of the order that was drawn; damaged lines are left out."""
    path = folder / LOG
    if not path.is_file():
        return {}
    out: dict[str, int] = {}
    for line in read_file(path, LOG_FILE).splitlines():
        with suppress(msgspec.DecodeError, KeyError, TypeError, ValueError):
            found: dict[str, Any] = msgspec.json.decode(line)
            out.setdefault(str(found["participant"]), int(found["number"]))
    return out
