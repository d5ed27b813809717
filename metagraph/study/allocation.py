"""Concealed allocation: which of the counterbalanced orders a participant gets is drawn when they begin, in
permuted blocks, from a secret. A digest of the secret is made known before; the secret after, so that anybody
can see that nobody chose.
"""

from __future__ import annotations

import hashlib
import hmac
import json
import os
import secrets
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from metagraph.budgets import LOG_FILE
from metagraph.errors import FileError
from metagraph.files import read_file
from metagraph.formats.atomic import append_line, write_atomically
from metagraph.study.order import williams

if TYPE_CHECKING:
    from metagraph.study.study_plan import Study

SECRET, LOG = "allocation.secret", "allocation.jsonl"
PATIENCE = 5.0  # seconds to wait for another window that draws just now


def prepare(study: Study) -> str:
    """Make the secret, unless there is one; return its digest, to be made known before anybody begins."""
    path = study.folder / SECRET
    if not path.is_file():
        write_atomically(path, (secrets.token_hex(32) + "\n").encode())
        with suppress(OSError):
            path.chmod(0o600)
    return commitment(_secret(study))


def commitment(secret: str) -> str:
    """Return the digest of a secret, SHA-256."""
    return hashlib.sha256(secret.encode()).hexdigest()


def _secret(study: Study) -> str:
    return read_file(study.folder / SECRET, LOG_FILE).decode("ascii", "replace").strip()


def numbers(secret: str, orders: int) -> Iterator[int]:
    """Yield the numbers of orders as they are drawn: 0, 1, 2 ... shuffled within blocks of one or two
    rounds of all orders, how many that is drawn, too, so that the last of a block cannot be foreseen.
    """
    key = secret.encode()

    def draw(block: int, place: int) -> int:
        return int.from_bytes(hmac.new(key, f"{block} {place}".encode(), "sha256").digest(), "big")

    start = block = 0
    while True:
        size = orders * (1 + draw(block, 0) % 2)
        yield from sorted(range(start, start + size), key=lambda n: draw(block, n + 1))
        start, block = start + size, block + 1


def orders(study: Study) -> int:
    """Return how many counterbalanced orders of conditions there are."""
    return len(williams(len(study.plan.conditions)))


def drawn(study: Study) -> dict[str, int]:
    """Return participant -> the number of the order that was drawn; damaged lines are left out."""
    path = study.folder / LOG
    if not path.is_file():
        return {}
    out: dict[str, int] = {}
    for line in read_file(path, LOG_FILE).splitlines():
        with suppress(msgspec.DecodeError, KeyError, TypeError, ValueError):
            found: dict[str, Any] = msgspec.json.decode(line)
            out.setdefault(str(found["participant"]), int(found["number"]))
    return out


def allocate(study: Study, participant: str) -> int:
    """Draw the next order for a participant, unless they have one, and note it; return its number. Raises
    FileError without a secret, ValueError for a stranger.
    """
    study.plan.known(participant)
    if not (study.folder / SECRET).is_file():
        raise FileError(
            study.folder / SECRET,
            "the order is concealed, and there is no secret to draw from",
            "order",
            "Run 'metagraph study plan' with --allocate, and keep the digest it tells.",
        )
    with _alone(study.folder / f".{LOG}.lock"):
        known = drawn(study)
        if participant in known:
            return known[participant]
        source = numbers(_secret(study), orders(study))
        number = next(n for place, n in enumerate(source) if place == len(known))
        note = {
            "place": len(known),
            "participant": participant,
            "number": number,
            "order": [c for c, _ in study.plan.blocks(participant, number)],
            "at": datetime.now(UTC).isoformat(timespec="seconds"),
        }
        try:
            append_line(study.folder / LOG, json.dumps(note))
        except OSError as error:
            raise FileError(
                study.folder / LOG,
                f"cannot be written ({error.strerror or error})",
                participant,
                "Make room on the disk, and check your rights.",
            ) from None
        return number


def problems(study: Study) -> list[str]:
    """Return in words where the log of the allocation is not what the secret gives."""
    try:
        source = numbers(_secret(study), orders(study))
    except FileError:
        return ["the secret of the allocation is not there: nobody can see whether it was followed"]
    out = []
    for (who, number), expected in zip(drawn(study).items(), source, strict=False):
        if number != expected:
            out.append(f"{who} has order {number}, but the secret gives {expected}")
    return out


@contextmanager
def _alone(path: Path) -> Iterator[None]:
    """Wait until no other window draws."""
    until = time.monotonic() + PATIENCE
    while True:
        try:
            os.close(os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY))
            break
        except FileExistsError:
            if time.monotonic() > until:  # whoever made it is gone
                path.unlink(missing_ok=True)
            time.sleep(0.05)
    try:
        yield
    finally:
        path.unlink(missing_ok=True)
