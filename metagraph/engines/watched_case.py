"""Look on while a case of conformance is played: what was spoken, began and ended, and became of requests."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from metagraph.playback.life.alphabet import ALPHABET
from metagraph.playback.life.speech_watch import SpeechWatch
from metagraph.playback.life.utterances import find_forgotten
from metagraph.playback.plan import Plan
from metagraph.playback.planning.extend_performance import answer_asks
from metagraph.speech.spoken_so_far import spoken_until

BEFORE = -1.0  # seconds: nothing was seen before
LASTING = 1e8  # seconds: what ends later has no end


class CaseWatch:
    """Keeps a row for each moment: `now`; `events` (kind, at, id, what, reason); `spoken` (id, text, last
    word) of all that was said; `silent`, ids of which more was promised that does not come; `answers` (id,
    state, at, until, what) of what was asked now.
    """

    def __init__(self) -> None:
        self.rows: list[dict[str, Any]] = []
        self._speech = SpeechWatch()
        self._seen = BEFORE
        self._said: list[str] = []

    def look(self, plan: Plan, now: float, asks: Sequence[Mapping[str, Any]]) -> None:
        """Add the row of a moment."""
        speeches = plan.track.speeches
        self._said += [
            x for x in dict.fromkeys(a["id"] for a in asks if a["do"] == "say") if x not in self._said
        ]
        spoken = [(ident, *spoken_until(ALPHABET, speeches, ident, now)) for ident in self._said]
        events = self._speech.watch(speeches, self._seen, now)
        answers = answer_asks(plan, [ask["id"] for ask in asks]).values()
        self._seen = now
        self.rows.append(
            {
                "now": now,
                "events": [[e.kind, _time(e.at), e.id, e.said, e.reason] for e in events],
                "spoken": [list(row) for row in spoken if row[1] != ""],
                "silent": find_forgotten(plan.track, now),
                "answers": [[a.id, a.state, _maybe(a.at), _maybe(a.until), list(a.what)] for a in answers],
            }
        )


def _time(seconds: float) -> float:
    return round(float(seconds), 7)


def _maybe(seconds: float | None) -> float | None:
    return None if seconds is None or seconds > LASTING else _time(seconds)
