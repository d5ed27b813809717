"""Concealed allocation: which of the counterbalanced orders a participant gets is drawn when they begin, in
permuted blocks, from a secret. A digest of the secret is made known before; the secret after, so that anybody
can see that nobody chose.
"""

from __future__ import annotations

import hashlib
import hmac
import json
import secrets
from collections.abc import Callable, Iterator
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from metagraph.common.budgets import LOG_FILE
from metagraph.common.files import read_file
from metagraph.errors import FileError
from metagraph.formats.atomic import append_line, write_atomically
from metagraph.formats.project.kernel_lock import wait_for_turn
from metagraph.research.study.plan.drawn_orders import LOG, read_drawn_orders
from metagraph.research.study.plan.order import make_williams_design
from metagraph.research.study.study_plan import Study

SECRET = "allocation.secret"


def prepare_allocation(study: Study) -> str:
    """Make the secret, unless there is one; return its digest, to be made known before anybody begins."""
    return compute_commitment(make_secret(study.folder))


def make_secret(folder: Path) -> str:
    """Return a folder's secret, made unless there is one. Raises FileError."""
    path = folder / SECRET
    if not path.is_file():
        folder.mkdir(parents=True, exist_ok=True)
        with wait_for_turn(folder / f".{SECRET}.lock"):
            if not path.is_file():
                write_atomically(path, (secrets.token_hex(32) + "\n").encode())
                with suppress(OSError):
                    path.chmod(0o600)
    return read_secret(folder)


def read_secret(folder: Path) -> str:
    """Return a folder's secret. Raises FileError."""
    return read_file(folder / SECRET, LOG_FILE).decode("ascii", "replace").strip()


def compute_commitment(secret: str) -> str:
    """Return the digest of a secret, SHA-256."""
    return hashlib.sha256(secret.encode()).hexdigest()


def make_drawer(secret: str) -> Callable[..., int]:
    """Return what draws a number, 0..2^256 - 1, from the secret and any words: the same ones for ever."""
    key = secret.encode()

    def draw(*words: object) -> int:
        return int.from_bytes(hmac.new(key, " ".join(map(str, words)).encode(), "sha256").digest(), "big")

    return draw


def draw_order_numbers(secret: str, orders: int, most: int = 2) -> Iterator[int]:
    """Yield the numbers of orders as they are drawn: 0, 1, 2 ... shuffled within blocks of one or two rounds
    of all orders, how many that is drawn, too, so that the last of a block cannot be foreseen. most: rounds
    of a block; 1 if nobody sees who comes next anyway.
    """
    draw = make_drawer(secret)
    start = block = 0
    while True:
        size = orders * (1 + draw(block, 0) % most)
        yield from sorted(range(start, start + size), key=lambda n: draw(block, n + 1))
        start, block = start + size, block + 1


def count_orders(study: Study) -> int:
    """Return how many counterbalanced orders of conditions there are."""
    return len(make_williams_design(len(study.plan.conditions)))


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
    with wait_for_turn(study.folder / f".{LOG}.lock"):
        known = read_drawn_orders(study.folder)
        if participant in known:
            return known[participant]
        source = draw_order_numbers(read_secret(study.folder), count_orders(study))
        number = next(n for place, n in enumerate(source) if place == len(known))
        note = {
            "place": len(known),
            "participant": participant,
            "number": number,
            "order": [c for c, _ in study.plan.blocks(participant, number)],
            "at": datetime.now(UTC).isoformat(timespec="seconds"),
        }
        append_durably(study.folder / LOG, note, participant)
        return number


def append_durably(path: Path, note: dict[str, Any], where: str = "") -> None:
    """Add a line to a log of notes; it is on the disk afterwards. where: what an error names. Raises
    FileError.
    """
    try:
        append_line(path, json.dumps(note))
    except OSError as error:
        raise FileError(
            path,
            f"cannot be written ({error.strerror or error})",
            where,
            "Make room on the disk, and check your rights.",
        ) from None


def find_allocation_problems(study: Study) -> list[str]:
    """Return in words where the log of the allocation is not what the secret gives."""
    try:
        source = draw_order_numbers(read_secret(study.folder), count_orders(study))
    except FileError:
        return ["the secret of the allocation is not there: nobody can see whether it was followed"]
    out = []
    for (who, number), expected in zip(read_drawn_orders(study.folder).items(), source, strict=False):
        if number != expected:
            out.append(f"{who} has order {number}, but the secret gives {expected}")
    return out
