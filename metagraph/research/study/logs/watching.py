"""Where everybody is who takes part, by the logs as they grow: for whoever leads several sittings on this
machine. Nothing is asked of the windows, and nothing leaves the computer.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from metagraph.errors import FileError
from metagraph.research.study.logs.log import read_log
from metagraph.research.study.scores.tasks import read_moment
from metagraph.research.study.sitting import describe_standing, find_place_in_sitting, list_phases
from metagraph.research.study.study_plan import Study

LOCK = "sitting.lock"


@dataclass(frozen=True)
class ParticipantView:
    """Where a participant is. words: how far, or the phase. live: a window has the sitting open. elapsed:
    seconds of the phase, without pauses, up to the last event; minutes: its limit. quiet: seconds since the
    last event. paused: the clock stands. events: of the log; troubles: of them that failed or were refused.
    """

    participant: str
    words: str
    live: bool = False
    place: tuple[int, int] | None = None
    elapsed: float = 0.0
    minutes: float | None = None
    quiet: float | None = None
    paused: bool = False
    events: int = 0
    troubles: int = 0


def watch_participants(study: Study, now: datetime | None = None) -> list[ParticipantView]:
    """Return where everybody is, in the order of the plan."""
    at = now or datetime.now(UTC)
    return [_seen(study, who, at) for who in study.plan.ids]


def _seen(study: Study, who: str, now: datetime) -> ParticipantView:
    path = study.log(who)
    live = is_open(study.data(who) / LOCK)
    if not path.is_file():
        return ParticipantView(who, "not begun", live)
    try:
        log = read_log(path)
        course = list_phases(study, who)
        stands = find_place_in_sitting(course, log.events)
    except (FileError, ValueError) as error:
        return ParticipantView(who, str(error), live)
    quiet = max(0.0, (now - read_moment(log.events[-1])).total_seconds()) if log.events else None
    pauses = [e.get("state") for e in log.events if e["type"] in ("pause", "resumed", "phase")]
    told: dict[str, Any] = {
        "quiet": quiet,
        "events": len(log.events),
        "troubles": sum(e["type"] == "error" and e.get("what") != "warning" for e in log.events),
    }
    if stands.phase is None or log.standing in ("declined", "withdrawn"):
        return ParticipantView(who, describe_standing(study, who), live, **told)
    last = next((e for e in reversed(log.events) if e["type"] in ("pause", "resumed", "phase")), {})
    return ParticipantView(
        who,
        stands.phase.title if stands.begun else f"before: {stands.phase.title}",
        live,
        (stands.phase.index + 1, len(course)),
        stands.elapsed,
        stands.phase.minutes,
        paused=bool(pauses) and last.get("type") == "pause" and last.get("state") == "begin",
        **told,
    )


def is_open(lock: Path) -> bool:
    """Return whether the lock of a sitting is held by a process of this machine that runs."""
    try:
        pid = int(lock.read_text(encoding="utf-8", errors="replace").split("\n", 1)[0])
    except (OSError, ValueError):
        return False
    if os.name == "nt":  # there a signal would end it; a lock that is left is taken over at the next start
        return True
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True


def tabulate_participants(found: Sequence[ParticipantView]) -> list[str]:
    """Return lines for a terminal."""
    rows = [("", "who", "where", "step", "time", "quiet", "events", "troubles")]
    for s in found:
        limit = f" of {s.minutes:g} min" if s.minutes else ""
        rows.append(
            (
                "●" if s.live else "",
                s.participant,
                f"{s.words}{' (paused)' if s.paused else ''}",
                f"{s.place[0]}/{s.place[1]}" if s.place else "",
                f"{_clock(s.elapsed)}{limit}" if s.place else "",
                _clock(s.quiet) if s.quiet is not None and s.place else "",
                str(s.events) if s.events else "",
                str(s.troubles) if s.troubles else "",
            )
        )
    wide = [max(len(r[k]) for r in rows) for k in range(len(rows[0]))]
    return ["  ".join(cell.ljust(w) for cell, w in zip(r, wide, strict=True)).rstrip() for r in rows]


def _clock(seconds: float) -> str:
    whole = round(seconds)
    hours, rest = divmod(whole, 3600)
    return f"{hours}:{rest // 60:02}:{rest % 60:02}" if hours else f"{rest // 60}:{rest % 60:02}"
