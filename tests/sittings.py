"""Sittings that ended in a crash, without the crash."""

from __future__ import annotations

import json
import subprocess
import sys
from functools import cache
from pathlib import Path

from metagraph.formats.project.journal_records import encode_record, parse_record


@cache
def ended() -> int:
    """The number of a process that is over."""
    child = subprocess.Popen([sys.executable, "-c", ""])
    child.wait()
    return child.pid


def kill_sittings(folder: Path) -> None:
    """Let every journal and lock in a folder be of a process that was killed."""
    for path in [*folder.glob(".*.journal"), *folder.glob(".*.lock")]:
        first, _, rest = path.read_bytes().partition(b"\n")
        record = parse_record(first)
        head = record.data if record is not None else json.loads(first)
        head.get("owner", head)["pid"] = ended()
        line = encode_record(head, 0)[:-2] if record is not None else json.dumps(head).encode()
        path.write_bytes(line + b"\n" + rest)
