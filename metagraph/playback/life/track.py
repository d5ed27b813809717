"""What was asked for and lasts: where to look, what to say, which mode to be in, which stance to stay in.
Values; times are seconds.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass, replace
from math import inf

from metagraph.graph.requests import Point
from metagraph.graph.words import Layer, Mode
from metagraph.playback.life.line_timing import LineTiming, extended, timed_seconds, told_text


@dataclass(frozen=True, slots=True)
class LookAt:
    """Look at a point or a named point from `start` until `end`, or until the next look. strict: without
    averting.
    """

    id: str
    start: float
    end: float
    to: str | Point
    amount: float = 1.0
    strict: bool = False
    priority: int = 1


@dataclass(frozen=True, slots=True)
class Speech:
    """Something said. line: id of the project's line, None for `text` alone. priority: the higher interrupts
    the lower. length: seconds it would have taken, where something cut it short. timing: when its words and
    mouth shapes come, where that was told.
    """

    id: str
    start: float
    end: float
    line: str | None = None
    text: str = ""
    priority: int = 1
    length: float | None = None
    timing: LineTiming | None = None


@dataclass(frozen=True, slots=True)
class ModeFrom:
    """The mode from `start` on; None for talking while something is said and idling otherwise."""

    id: str
    start: float
    mode: Mode | None


@dataclass(frozen=True, slots=True)
class PlaceFrom:
    """Where a named point is from `start` on."""

    id: str
    start: float
    name: str
    point: Point


@dataclass(frozen=True, slots=True)
class BlinkAt:
    """A blink asked for."""

    id: str
    start: float


@dataclass(frozen=True, slots=True)
class StayFrom:
    """From `start` on the models change no stance of a layer (or, with `on` false, may again), until `end` or
    the next of these.
    """

    id: str
    start: float
    layer: Layer
    on: bool = True
    end: float = inf


Item = LookAt | Speech | ModeFrom | PlaceFrom | BlinkAt | StayFrom


@dataclass(frozen=True)
class Track:
    """All of it, each by start. Speeches do not overlap."""

    looks: tuple[LookAt, ...] = ()
    speeches: tuple[Speech, ...] = ()
    modes: tuple[ModeFrom, ...] = ()
    places: tuple[PlaceFrom, ...] = ()
    blinks: tuple[BlinkAt, ...] = ()
    stays: tuple[StayFrom, ...] = ()

    @property
    def items(self) -> tuple[Item, ...]:
        return (*self.looks, *self.speeches, *self.modes, *self.places, *self.blinks, *self.stays)

    def stays_at(self, layer: Layer, seconds: float) -> bool:
        """Return whether the models may not change a layer's stance at a time."""
        last = next((s for s in reversed(self.stays) if s.layer == layer and s.start <= seconds), None)
        return last is not None and last.on and seconds < last.end

    def told_mode(self, seconds: float) -> Mode | None:
        """Return the mode that was asked for at a time, or talking while something is said; None where
        neither tells.
        """
        asked = bisect_right(self.modes, seconds, key=lambda m: m.start) - 1
        if asked >= 0 and self.modes[asked].mode is not None:
            return self.modes[asked].mode
        said = bisect_right(self.speeches, seconds, key=lambda s: s.start) - 1
        return "talking" if said >= 0 and seconds < self.speeches[said].end else None

    def without(self, idents: Collection[str], now: float = -inf) -> Track:
        """Return the track without items of these ids that begin at `now` or later; what has begun ends now,
        if it can.
        """

        def kept(item: Item) -> Item | None:
            if item.id not in idents:
                return item
            if item.start >= now:
                return None
            if isinstance(item, Speech):
                return cut(item, now)
            return replace(item, end=min(item.end, now)) if isinstance(item, LookAt | StayFrom) else item

        if not idents or not any(item.id in idents for item in self.items):
            return self
        return Track(*(tuple(k for i in of if (k := kept(i)) is not None) for of in self._kinds()))  # type: ignore[arg-type]

    def plus(self, items: Collection[Item]) -> Track:
        """Return the track with more items; of speeches that overlap the later or more important cuts the
        other short.
        """
        if not items:
            return self
        more = track_of(items)
        looks, _, modes, places, blinks, stays = (
            _merged(old, new) for old, new in zip(self._kinds(), more._kinds(), strict=True)
        )
        speeches = (
            self.speeches
            if not more.speeches
            else _apart(sorted((*self.speeches, *_speeches(items)), key=_order))
        )
        return Track(looks, speeches, modes, places, blinks, stays)  # type: ignore[arg-type]

    def going_on(self, items: Collection[Item], now: float) -> tuple[Item, ...]:
        """Return items of which those go on that a line of the same id has begun of by `now`, or begins with:
        they keep its start and what has been said of it. Only lines whose words or shapes were told with
        their times do.
        """
        return tuple(self._on(item, now) if isinstance(item, Speech) else item for item in items)

    def _on(self, new: Speech, now: float) -> Speech:
        old = next((s for s in reversed(self.speeches) if s.id == new.id), None)
        if old is None or old.timing is None or new.timing is None or old.length is not None:
            return new
        if max(old.start, new.start) > now and old.start != new.start:
            return new
        timing = extended(old.timing, new.timing, max(now - old.start, 0.0))
        length = max(timed_seconds(timing, None), new.end - new.start)
        text = told_text(timing) if new.text in ("", told_text(new.timing)) else new.text
        return replace(new, start=old.start, end=old.start + length, text=text, timing=timing)

    def _kinds(self) -> tuple[tuple[Item, ...], ...]:
        return self.looks, self.speeches, self.modes, self.places, self.blinks, self.stays

    def since(self, seconds: float) -> Track:
        """Return the track without what no time from `seconds` on needs."""
        places = {p.name: p for p in self.places if p.start <= seconds}
        modes = [x for x in self.modes if x.start <= seconds][-1:]
        stays = {s.layer: s for s in self.stays if s.start <= seconds}
        looks: list[
            LookAt
            # those that no later one has replaced; also what is over: it tells since when what shows has
            # shown
        ] = []
        for look in self.looks:
            if look.start <= seconds:
                looks = [*(x for x in looks if x.priority > look.priority), look]
        old = {id(x) for x in (*places.values(), *looks, *modes, *stays.values())}
        return track_of(
            i
            for i in self.items
            if i.start > seconds or id(i) in old or (isinstance(i, Speech) and i.end > seconds)
        )


def track_of(items: object) -> Track:
    """Return a track of items in any order."""
    every = sorted(items, key=_order)  # type: ignore[call-overload]
    return Track(
        tuple(i for i in every if isinstance(i, LookAt)),
        _apart([i for i in every if isinstance(i, Speech)]),
        tuple(i for i in every if isinstance(i, ModeFrom)),
        tuple(i for i in every if isinstance(i, PlaceFrom)),
        tuple(i for i in every if isinstance(i, BlinkAt)),
        tuple(i for i in every if isinstance(i, StayFrom)),
    )


def _order(item: Item) -> tuple[float, str]:
    return item.start, item.id


def _speeches(items: Iterable[Item]) -> Iterator[Speech]:
    return (item for item in items if isinstance(item, Speech))


def _merged(old: tuple[Item, ...], new: tuple[Item, ...]) -> tuple[Item, ...]:
    """Put new items among those that are in order already; most are the latest, so that little is
    compared.
    """
    for item in new:
        place = bisect_right(old, _order(item), key=_order)
        old = (*old[:place], item, *old[place:])
    return old


def cut(speech: Speech, at: float) -> Speech:
    """Return the speech, ending no later than `at`; how long it would have been is remembered."""
    if speech.end <= at:
        return speech
    return replace(
        speech, end=at, length=speech.end - speech.start if speech.length is None else speech.length
    )


def _apart(speeches: list[Speech]) -> tuple[Speech, ...]:
    """Return speeches without overlaps: one that is at least as important cuts the running one, a lesser one
    is not said.
    """
    out: list[Speech] = []
    for speech in speeches:
        if out and out[-1].end > speech.start:
            if speech.priority < out[-1].priority:
                continue
            if out[-1].start >= speech.start:
                out.pop()
            else:
                out[-1] = cut(out[-1], speech.start)
        out.append(speech)
    return tuple(out)
