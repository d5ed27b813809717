"""All requests that last, in order; see `items`. Times are seconds."""

from __future__ import annotations

import math
from bisect import bisect_right, insort
from collections.abc import Collection, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace

from metagraph.graph.words import Layer, Mode
from metagraph.playback.life.items import (
    BlinkAt,
    Item,
    LookAt,
    ModeFrom,
    PlaceFrom,
    Speech,
    StayFrom,
    alike_blinks,
    alike_felt,
    alike_looks,
    alike_modes,
    alike_places,
    alike_speeches,
    alike_stays,
    apart,
    cut,
)
from metagraph.playback.planning.mood import MoodFrom, lasting

__all__ = [
    "BlinkAt",
    "Item",
    "LookAt",
    "ModeFrom",
    "MoodFrom",
    "PlaceFrom",
    "Speech",
    "StayFrom",
    "Track",
    "by_kind",
    "track_of",
]

HUSHED = 1.5  # seconds after what was said is broken off in which the models begin nothing


@dataclass(frozen=True)
class Track:
    """All lasting requests, each kind sorted by start. Speeches do not overlap."""

    looks: Sequence[LookAt] = ()
    speeches: Sequence[Speech] = ()
    modes: Sequence[ModeFrom] = ()
    places: Sequence[PlaceFrom] = ()
    blinks: Sequence[BlinkAt] = ()
    stays: Sequence[StayFrom] = ()
    moods: Sequence[MoodFrom] = ()

    @property
    def items(self) -> tuple[Item, ...]:
        return (
            *self.looks, *self.speeches, *self.modes, *self.places, *self.blinks, *self.stays, *self.moods,
        )  # fmt: skip

    def idents(self) -> list[str]:
        """Return the ids of all items."""
        out = [x.id for x in self.looks]
        out += [x.id for x in self.speeches]
        out += [x.id for x in self.modes]
        out += [x.id for x in self.places]
        out += [x.id for x in self.blinks]
        out += [x.id for x in self.stays]
        out += [x.id for x in self.moods]
        return out

    def stays_at(self, layer: Layer, seconds: float) -> bool:
        """Return whether the models may not change a layer's stance at a time."""
        last = next((s for s in reversed(self.stays) if s.layer == layer and s.start <= seconds), None)
        return last is not None and last.on and seconds < last.end

    def hushed_at(self, seconds: float) -> bool:
        """Return whether what was said was broken off shortly before a time, and nothing is said since: then
        the models begin nothing.
        """
        place = bisect_right(self.speeches, seconds, key=lambda s: s.start) - 1
        if place < 0 or self.speeches[place].length is None:
            return False
        last = self.speeches[place]
        silent = last.end if last.over is None else max(last.end, last.over)
        return last.end <= seconds and seconds < silent + HUSHED

    def told_mode(self, seconds: float) -> Mode | None:
        """Return the mode requested at a time, or talking while something is said; None if
        neither applies.
        """
        asked = bisect_right(self.modes, seconds, key=lambda m: m.start) - 1
        if asked >= 0 and self.modes[asked].mode is not None:
            return self.modes[asked].mode
        said = bisect_right(self.speeches, seconds, key=lambda s: s.start) - 1
        return "talking" if said >= 0 and seconds < self.speeches[said].end else None

    def without(self, idents: AbstractSet[str], now: float = -math.inf) -> Track:
        """Return the track without items of these ids that begin at `now` or later; those that have begun end
        now, if they can.
        """
        if len(idents) == 0 or not any(ident in idents for ident in self.idents()):
            return self
        return Track(
            tuple([
                replace(x, end=min(x.end, now)) if x.id in idents else x
                for x in self.looks if x.id not in idents or x.start < now
            ]),
            tuple([
                cut(x, now) if x.id in idents else x
                for x in self.speeches if x.id not in idents or x.start < now
            ]),
            tuple([x for x in self.modes if x.id not in idents or x.start < now]),
            tuple([x for x in self.places if x.id not in idents or x.start < now]),
            tuple([x for x in self.blinks if x.id not in idents or x.start < now]),
            tuple([
                replace(x, end=min(x.end, now)) if x.id in idents else x
                for x in self.stays if x.id not in idents or x.start < now
            ]),
            tuple([
                replace(x, end=min(x.end, now)) if x.id in idents else x
                for x in self.moods if x.id not in idents or x.start < now
            ]),
        )  # fmt: skip

    def plus(self, items: Collection[Item]) -> Track:
        """Return the track with more items; if speeches overlap, the later or more important one cuts the
        other short.
        """
        return self.joined(by_kind(items)) if items else self

    def joined(self, more: Track) -> Track:
        """Return the track with the items of another one, whose speeches may overlap."""
        if len(more.idents()) == 0:
            return self
        looks = list(self.looks)
        for look in more.looks:
            insort(looks, look, lo=0, key=lambda x: (x.start, x.id))
        speeches = list(self.speeches)
        for speech in more.speeches:
            insort(speeches, speech, lo=0, key=lambda x: (x.start, x.id))
        modes = list(self.modes)
        for mode in more.modes:
            insort(modes, mode, lo=0, key=lambda x: (x.start, x.id))
        places = list(self.places)
        for place in more.places:
            insort(places, place, lo=0, key=lambda x: (x.start, x.id))
        blinks = list(self.blinks)
        for blink in more.blinks:
            insort(blinks, blink, lo=0, key=lambda x: (x.start, x.id))
        stays = list(self.stays)
        for stay in more.stays:
            insort(stays, stay, lo=0, key=lambda x: (x.start, x.id))
        moods = list(self.moods)
        for mood in more.moods:
            insort(moods, mood, lo=0, key=lambda x: (x.start, x.id))
        said = apart(speeches) if len(more.speeches) > 0 else speeches
        return Track(
            tuple(looks), tuple(said), tuple(modes), tuple(places), tuple(blinks), tuple(stays), tuple(moods)
        )

    def since(self, seconds: float) -> Track:
        """Return the track without items that are not needed from `seconds` on."""
        # Those that no later one has replaced; also what is over: it tells since when what shows has shown.
        looks: list[LookAt] = []
        for look in self.looks:
            if look.start <= seconds:
                looks = [x for x in looks if x.priority > look.priority]
            looks.append(look)
        latest = {x.id: x for x in self.speeches}
        lasts = {ident for ident, x in latest.items() if x.more or x.end > seconds}
        mode = max(0, bisect_right(self.modes, seconds, key=lambda m: m.start) - 1)
        places = {x.name: n for n, x in enumerate(self.places) if x.start <= seconds}
        stays = {x.layer: n for n, x in enumerate(self.stays) if x.start <= seconds}
        return Track(
            tuple(looks),
            tuple([  # of an utterance that is not over all pieces
                x for x in self.speeches
                if x.start > seconds or x.end > seconds or (x.more and x.id in lasts)
                or (x.over is not None and x.over > seconds - HUSHED)
                or (x.length is not None and x.end > seconds - HUSHED)
            ]),
            tuple(self.modes[mode:]),
            tuple([x for n, x in enumerate(self.places) if x.start > seconds or places[x.name] == n]),
            tuple([x for x in self.blinks if x.start > seconds]),
            tuple([x for n, x in enumerate(self.stays) if x.start > seconds or stays[x.layer] == n]),
            tuple(lasting(self.moods, seconds)),
        )  # fmt: skip

    def last_speech(self, ident: str) -> Speech | None:
        """Return the last speech with an id."""
        return next((s for s in reversed(self.speeches) if s.id == ident), None)

    def draws_like(self, other: Track) -> bool:
        """Return whether everything is the same that random draws depend on. Places and stays are not part of
        it.
        """
        if not alike_looks(self.looks, other.looks) or not alike_speeches(self.speeches, other.speeches):
            return False
        if not alike_felt(self.moods, other.moods):
            return False
        return alike_modes(self.modes, other.modes) and alike_blinks(self.blinks, other.blinks)

    def like(self, other: Track) -> bool:
        """Return whether everything is the same."""
        if not alike_places(self.places, other.places) or not alike_stays(self.stays, other.stays):
            return False
        return self.draws_like(other)


def by_kind(items: Collection[Item]) -> Track:
    """Return items by their kinds, in the order they come in; speeches may overlap."""
    return Track(
        tuple(i for i in items if isinstance(i, LookAt)),
        tuple(i for i in items if isinstance(i, Speech)),
        tuple(i for i in items if isinstance(i, ModeFrom)),
        tuple(i for i in items if isinstance(i, PlaceFrom)),
        tuple(i for i in items if isinstance(i, BlinkAt)),
        tuple(i for i in items if isinstance(i, StayFrom)),
        tuple(i for i in items if isinstance(i, MoodFrom)),
    )


def track_of(items: Collection[Item]) -> Track:
    """Return a track of items in any order."""
    return Track().joined(by_kind(items))
