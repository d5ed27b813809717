"""What a plan does about many asks at once: `extend_performance.answer` for a whole tick, in one pass over
what is near.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from math import inf

from metagraph.playback.life.track import Item, LookAt, MoodFrom, Speech
from metagraph.playback.life.utterances import is_paused
from metagraph.playback.plan import MetaAction, Plan, Report
from metagraph.playback.planning.extend_performance import find_item_end, find_served, name_item

ENDLESS = 1e8  # seconds; what ends later than this ends when something else begins


@dataclass(slots=True)
class FoundAnswer:
    """All that a plan holds of one ask. starts, ends: seconds. what: actions, or words for what the life
    layers do. waits: when it begins that is not chosen yet, or is paused, seconds.
    """

    starts: list[float] = field(default_factory=list)
    ends: list[float] = field(default_factory=list)
    what: list[str] = field(default_factory=list)
    reports: list[Report] = field(default_factory=list)
    waits: float | None = None
    layer: str | None = None

    @property
    def state(self) -> str:
        if self.paused:
            return "planned"
        if self.starts:
            return (
                "late" if any(r.outcome in ("late", "queued", "resumed") for r in self.reports) else "planned"
            )
        if any(r.outcome == "already-there" for r in self.reports):
            return "done"
        if self.waits is not None and all(r.played for r in self.reports):
            return "late" if self.reports else "planned"
        return "refused"

    def said(self, missed: float = 0.0) -> str:
        """Return the state told to who asked. missed: seconds by which it was asked for too late."""
        return "late" if missed > 0 and self.state == "planned" else self.state

    @property
    def paused(self) -> bool:
        """Whether it waits until what it belongs to goes on."""
        return self.waits is not None and is_paused(self.waits)

    @property
    def begins(self) -> float | None:
        """When it begins, seconds; what is paused in a time that never comes."""
        if self.paused:
            return self.waits
        return min(self.starts) if self.starts else self.waits if self.state != "refused" else None

    def take_item(self, item: Item) -> None:
        """Add something of the life layers that was asked for."""
        if is_paused(item.start):
            self.waits = item.start
            return
        self.starts.append(item.start)
        self.ends.append(find_item_end(item))
        self.what.append(name_item(item))

    @property
    def at(self) -> float | None:
        return None if self.paused else self.begins

    @property
    def until(self) -> float | None:
        if self.paused:
            return None
        end = max(self.ends, default=inf)
        return end if end < ENDLESS else None

    @property
    def why(self) -> str:
        if self.paused:
            return "it is paused"
        words = "; ".join(dict.fromkeys(r.message for r in self.reports))
        if words or self.starts:
            return words
        return "nothing came of it" if self.state == "refused" else "chosen when its time is nearer"


def find(
    plan: Plan, wanted: Collection[str], since: float = -inf, told: Mapping[str, float] | None = None
) -> dict[str, FoundAnswer]:
    """Return what a plan holds of asks, for those of which it holds anything. since: seconds before which
    nothing matters. told: when each was asked for; what began before that belongs to another ask of its id,
    except for what is said.
    """
    out: dict[str, FoundAnswer] = {}
    known = told or {}

    def of(ident: str, start: float = inf) -> FoundAnswer | None:
        owner = find_owning_ask(ident, wanted)
        if owner is None or start < known.get(owner, -inf):
            return None
        return out.setdefault(owner, FoundAnswer())

    served = find_served(plan)
    for layer, lane in plan.layers.items():
        for cue in reversed(lane.cues):
            if cue.end < since:
                break
            for made in (cue.meta.partition("+")[0], *served.get(cue.meta, ())):
                found = of(made, cue.start)
                if found is not None:
                    found.starts.append(cue.start)
                    found.ends.append(cue.end)
                    found.what.append(cue.action.name)
                    found.layer = layer
        for meta in _far(lane.metas, plan.end):
            found = of(meta.request.id)
            if found is not None:
                found.waits, found.layer = meta.start, found.layer or layer
    for item in _near(plan, since):
        found = of(item.id, inf if isinstance(item, Speech) else item.start)
        if found is not None:
            found.take_item(item)
    for report in plan.reports:
        found = of(report.request)
        if found is not None:
            found.reports.append(report)
            found.layer = found.layer or report.layer
    for found in out.values():
        found.what.reverse()
    return out


def find_owning_ask(ident: str, wanted: Collection[str]) -> str | None:
    """Return which of the wanted asks a request belongs to: its own, or that of which it is a part (`ask.1`,
    `ask.1.2`).
    """
    while ident not in wanted:
        ident, dot, number = ident.rpartition(".")
        if not dot or not number.isdigit():
            return None
    return ident


def _far(metas: Iterable[MetaAction], end: float) -> Iterator[MetaAction]:
    """Yield, the earliest last, what is placed but begins too late to have been chosen."""
    for meta in reversed(tuple(metas)):
        if meta.start < end:
            return
        yield meta


def _near(plan: Plan, since: float) -> Iterator[Item]:
    """Yield what was asked of the life layers and matters from `since` on."""
    track = plan.track
    several: tuple[Sequence[Item], ...] = (track.modes, track.places, track.blinks)
    for items in several:
        for item in reversed(items):
            if item.start < since:
                break
            yield item
    latest = {speech.id: speech for speech in track.speeches}  # an earlier one of the id was cut short
    yield from (s for s in latest.values() if s.end >= since or s.more)
    lasting: tuple[LookAt | MoodFrom, ...] = (*track.looks, *track.moods)
    yield from (x for x in lasting if x.end >= since)
