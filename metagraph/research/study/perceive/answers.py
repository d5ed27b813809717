"""Answers as the page gives them, in a file or over the loopback, and where they are kept: a log a person,
the same kind that sittings have, appended and synced before anything is acknowledged.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta, Struct

from metagraph.common.files import guard_reader, read_file
from metagraph.errors import FileError
from metagraph.formats.project.kernel_lock import wait_for_turn
from metagraph.research.study.logs.log import Event, Writer, read_log
from metagraph.research.study.perceive.folder import Perceived
from metagraph.research.study.questionnaires import Name

MOST_BYTES = 8 << 20  # of one file of answers
MOST_EVENTS = 5000  # of one person
Number = Annotated[float, Meta(ge=0, le=1e7)]
Count = Annotated[int, Meta(ge=0, le=1_000_000)]
Short = Annotated[str, Meta(max_length=300)]
_AGAIN = "Save the answers from the page again, and change nothing in the file."


class PageEvent(Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """Something that happened on the page. n: 0, 1, 2 ... of the person's run. at: time of day there; mono:
    seconds since the page was opened. Of an answer: its trial; value: left or right, or question -> number;
    seconds since the last video's last end, and since its first; replays; seconds of each video that were
    seen; how often the page was hidden.
    """

    n: Annotated[int, Meta(ge=0, lt=MOST_EVENTS)]
    type: Literal["begin", "resumed", "declined", "answer", "note", "withdrawn", "end"]
    at: Annotated[str, Meta(max_length=40)] = ""
    mono: Number = 0.0
    agent: Short = ""
    trial: Annotated[str, Meta(max_length=64)] = ""
    value: (
        Annotated[str, Meta(max_length=64)]
        | Annotated[dict[Name, Annotated[int, Meta(ge=-1000, le=1000)]], Meta(max_length=50)]
        | None
    ) = None
    seconds: Number = 0.0
    first: Number = 0.0
    replays: Count = 0
    watched: Annotated[tuple[Number, ...], Meta(max_length=2)] = ()
    hidden: Count = 0


class Sheet(Struct, frozen=True, forbid_unknown_fields=True):
    """What a page sends, or saves. design: the digest of what it showed. run: of this person in this
    browser.
    """

    perceive: Literal[1]
    design: Annotated[str, Meta(pattern="^[0-9a-f]{64}$")]
    code: Name
    run: Annotated[str, Meta(pattern="^[0-9a-f]{8,32}$")]
    events: Annotated[tuple[PageEvent, ...], Meta(max_length=MOST_EVENTS)]


class SheetError(ValueError):
    """Answers that are none, or belong elsewhere. taken: somebody else has begun with the code."""

    def __init__(self, words: str, taken: bool = False) -> None:
        self.taken = taken
        super().__init__(words)


def decode_sheet(content: bytes) -> Sheet:
    """Return what a page has sent. Raises SheetError."""
    try:
        return msgspec.json.decode(content, type=Sheet)
    except (msgspec.DecodeError, RecursionError, UnicodeDecodeError) as error:
        raise SheetError(f"it holds no answers ({error})") from None


@guard_reader
def read_answers(path: str | Path) -> Sheet:
    """Return the answers a page saved as JSON. Raises FileError."""
    path = Path(path)
    try:
        return decode_sheet(read_file(path, MOST_BYTES))
    except SheetError as error:
        raise FileError(path, str(error), "its content", _AGAIN) from None


@dataclass(frozen=True)
class KeptEvents:
    """How many of a run's events are kept by now, and how many of them are new."""

    kept: int
    new: int


def keep_sheet(study: Perceived, sheet: Sheet) -> KeptEvents:
    """Add what is new of a sheet to its person's log; it is on the disk afterwards. Raises SheetError if it
    is another study's, a stranger's, or of somebody whose code was begun elsewhere; FileError.
    """
    if sheet.design != study.key.design:
        raise SheetError("these answers are of another study, or of one that was made anew since")
    try:
        study.known(sheet.code)
    except ValueError as error:
        raise SheetError(str(error)) from None
    _check(study, sheet)
    path = study.log(sheet.code)
    path.parent.mkdir(parents=True, exist_ok=True)
    with wait_for_turn(path.with_name(".answers.lock")):
        before = list(read_log(path).events) if path.is_file() else []
        runs = [e["page"] for e in before if isinstance(e.get("page"), str)]
        if runs and sheet.run not in runs:
            raise SheetError(f"'{sheet.code}' was begun in another browser, and those answers count", True)
        have = sum(e.get("page") == sheet.run for e in before)
        new = [e for e in sheet.events if e.n >= have]
        if new and [e.n for e in new] != list(range(have, have + len(new))):
            raise SheetError(f"events are missing between {have} and {new[0].n}")
        if new:
            writer = Writer(path)
            try:
                writer.extend((event.type, _fields(sheet, event)) for event in new)
            finally:
                writer.close()
    return KeptEvents(have + len(new), len(new))


def _fields(sheet: Sheet, event: PageEvent) -> dict[str, Any]:
    out: dict[str, Any] = msgspec.to_builtins(event)
    out.pop("type", None)
    out.pop("n", None)
    extra = {"participant": sheet.code, "design": sheet.design} if event.type == "begin" else {}
    # The log has a clock and numbers of its own; the page's are kept beside them.
    return {"page": sheet.run, "page_n": event.n, "page_mono": out.pop("mono", 0.0), **out, **extra}


def _check(study: Perceived, sheet: Sheet) -> None:
    """Raise SheetError for answers that the page cannot have given."""
    trials = {t.id: t for t in study.key.sessions[sheet.code].trials}
    for event in sheet.events:
        if event.type != "answer":
            continue
        trial = trials.get(event.trial)
        if trial is None:
            raise SheetError(f"event {event.n} answers a trial that '{sheet.code}' does not have")
        if not is_answer(study, bool(trial.right), event.value):
            raise SheetError(f"event {event.n} is no answer to its trial")


def is_answer(study: Perceived, pair: bool, value: object) -> bool:
    """Return whether a value answers a trial: a side of a pair, or all questions on their scales."""
    if pair:
        return value in ("left", "right")
    if not isinstance(value, Mapping) or study.plan.rating is None:
        return False
    asked = {q.id: q for q in study.plan.rating.questions}
    if not set(value) <= set(asked) or any(q.id not in value for q in asked.values() if q.needed):
        return False
    return all(
        isinstance(v, int | float)
        and isfinite(v)
        and (scale := asked[k].scale) is not None
        and v in scale.points
        for k, v in value.items()
    )


def list_answers(events: list[Event]) -> dict[str, Event]:
    """Return trial -> its answer, the first one where there are several."""
    out: dict[str, Event] = {}
    for event in events:
        if event["type"] == "answer" and isinstance(event.get("trial"), str):
            out.setdefault(event["trial"], event)
    return out
