"""Count what a character does by itself over an hour, next to what people do.

Everything is counted from the plan and the life layers' schedule; no pose is made.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import ceil
from statistics import fmean, median, pstdev

from metagraph.common.wording import Phrase, phrase, plural_phrase
from metagraph.graph.model import LAYERS, Kind, Layer, Mode, Project
from metagraph.playback.plan import Cue, Plan
from metagraph.playback.planning.director import LEAST_LULL, MOST_LULL
from metagraph.playback.planning.running_plan import improvise

HOUR = 3600.0
SOON, LATER = 30.0, 300.0  # seconds within which a repetition is counted
UNDONE = 6.0  # seconds after which a change of stance is no longer undone
MOST_SOON, MOST_LATER = 0.05, 0.30  # shares of acts that may recur within those
BENTIVOGLIO = phrase("Bentivoglio and others 1997; range: Doughty 2001")
ARGYLE = phrase("Argyle and Ingham 1972")


@dataclass(frozen=True)
class BehaviourRow:
    """One thing that was counted. least, most: what people do, None if nobody has published it; source: who
    has. share: whether the value is a share of the whole, 0..1.
    """

    name: Phrase
    value: float
    unit: Phrase
    least: float | None = None
    most: float | None = None
    source: Phrase | None = None
    share: bool = False

    @property
    def usual(self) -> bool | None:
        """Whether people do it about as often, None if nobody knows."""
        if self.least is None and self.most is None:
            return None
        low = 0.0 if self.least is None else self.least
        value = round(self.value, 2 if self.share else 1)  # as it is shown
        return low <= value and (self.most is None or value <= self.most)

    @property
    def amount(self) -> Phrase:
        """The value with its unit."""
        return phrase("{value} {unit}", value=self._number(self.value), unit=self.unit)

    @property
    def compared(self) -> Phrase:
        """What people do, or what is aimed at; empty if nobody knows."""
        if self.most is None:
            return phrase("")
        most = self._number(self.most)
        if self.least is None:
            return phrase("aim: at most {most}", most=most)
        least = self._number(self.least)
        if self.source is None:
            return phrase("aim: {least} to {most}", least=least, most=most)
        return phrase("people: {least} to {most}", least=least, most=most)

    def _number(self, value: float) -> Phrase:
        if self.share:
            return phrase("{value:.0f} %", value=100 * value)
        return phrase("{value:.1f}", value=value)


@dataclass(frozen=True)
class Lack:
    """A stance that has too few actions of a kind for not repeating itself. have: how many; more: how many
    more would do.
    """

    layer: Layer
    stance: str
    kind: Kind
    have: int
    more: int


@dataclass(frozen=True)
class BehaviourCount:
    """What was counted in a mode, and which stances lack actions."""

    mode: Mode
    seconds: float
    rows: tuple[BehaviourRow, ...]
    lacks: tuple[Lack, ...]


def describe_lack(project: Project, lack: Lack) -> Phrase:
    """Say what a stance lacks."""
    stance = project.graphs[lack.layer].stances[lack.stance].name
    if lack.kind == "gesture":
        return plural_phrase(
            "{count} more gesture in '{stance}' would end the repetition; it has {have}",
            "{count} more gestures in '{stance}' would end the repetition; it has {have}",
            lack.more,
            stance=stance,
            have=lack.have,
        )
    return plural_phrase(
        "{count} more fidget in '{stance}' would end the repetition; it has {have}",
        "{count} more fidgets in '{stance}' would end the repetition; it has {have}",
        lack.more,
        stance=stance,
        have=lack.have,
    )


def measure_behaviour(
    project: Project, mode: Mode = "talking", seconds: float = HOUR, seed: int | None = None
) -> BehaviourCount:
    """Return what a character does by itself in `seconds` of a mode, in which nothing is said."""
    plan = improvise(project, seconds, seed, mode)
    rows = (*_acts(project, plan, seconds), *_rests(plan, seconds), *_face(plan, mode, seconds))
    return BehaviourCount(mode, seconds, rows, _lacks(project, plan))


def _acts(project: Project, plan: Plan, seconds: float) -> list[BehaviourRow]:
    minute = phrase("a minute")
    count = Counter((layer, cue.action.kind) for layer in LAYERS for cue in plan.layers[layer].cues)
    acts = [cue for cue in plan.layers["arms"].cues if cue.action.kind != "transition"]
    moves = sum(count[layer, "transition"] for layer in LAYERS)
    undone = sum(
        b.then == a.stance and b.start - a.end < UNDONE
        for layer in LAYERS
        for a, b in pairwise([c for c in plan.layers[layer].cues if c.action.kind == "transition"])
    )
    out = [
        BehaviourRow(phrase("Gestures of the arms"), 60 * count["arms", "gesture"] / seconds, minute),
        BehaviourRow(
            phrase("Fidgets"), 60 * sum(count[layer, "fidget"] for layer in LAYERS) / seconds, minute
        ),
        BehaviourRow(phrase("Changes of stance"), 60 * moves / seconds, minute),
        BehaviourRow(
            phrase("Changes of stance undone within {seconds:.0f} s", seconds=UNDONE),
            60 * undone / seconds,
            minute,
        ),
    ]
    soon = phrase("The same act of the arms again within {seconds:.0f} s", seconds=SOON)
    later = phrase("The same act of the arms again within {minutes:.0f} minutes", minutes=LATER / 60)
    for name, span, most in ((soon, SOON, MOST_SOON), (later, LATER, MOST_LATER)):
        out.append(
            BehaviourRow(
                name,
                measure_repeated_share(acts, span),
                phrase("of them"),
                None,
                most,
                share=True,
            )
        )
    if project.graphs["head"].actions:
        nods = 60 * count["head", "gesture"] / seconds
        out.insert(1, BehaviourRow(phrase("Nods and head shakes"), nods, minute))
        tilted = _tilted(project, plan, seconds) / seconds
        out.append(BehaviourRow(phrase("Head tilted"), tilted, phrase("of the time"), share=True))
    return out


def _tilted(project: Project, plan: Plan, seconds: float) -> float:
    """Return the seconds that the head spends outside of the stance it begins in."""
    start, rests = project.graphs["head"].start, plan.layers["head"].rests
    ends = [*(rest.start for rest in rests[1:]), seconds]
    return sum(
        max(0.0, min(until, seconds) - rest.start)
        for rest, until in zip(rests, ends, strict=bool(rests))
        if rest.stance != start
    )


def measure_repeated_share(cues: Sequence[Cue], seconds: float) -> float:
    """Return the share of cues whose action began already within `seconds` before, 0..1."""
    last: dict[str, float] = {}
    again = 0
    for cue in sorted(cues, key=lambda c: c.start):
        before = last.get(cue.action.id)
        again += before is not None and cue.start - before <= seconds
        last[cue.action.id] = cue.start
    return again / len(cues) if cues else 0.0


def _rests(plan: Plan, seconds: float) -> list[BehaviourRow]:
    cues = plan.layers["arms"].cues
    rests = [b.start - a.end for a, b in pairwise(cues)] or [seconds]
    gaps = [b.start - a.start for a, b in pairwise(cues)] or [seconds]
    longer = [rest for rest in rests if rest >= LEAST_LULL] or [seconds]
    moves = [cue.start for cue in cues if cue.action.kind == "transition"]
    kept = [b - a for a, b in pairwise((0.0, *moves, seconds))]
    second = phrase("s")
    return [
        BehaviourRow(phrase("Half of the rests of the arms are shorter than"), median(rests), second),
        BehaviourRow(
            phrase("Nine in ten rests of the arms are shorter than"),
            sorted(rests)[int(0.9 * (len(rests) - 1))],
            second,
        ),
        BehaviourRow(
            phrase("Half of those of {seconds:.0f} s and more are shorter than", seconds=LEAST_LULL),
            median(longer),
            second,
            LEAST_LULL,
            MOST_LULL,
        ),
        BehaviourRow(phrase("Half of the stances of the arms are kept for less than"), median(kept), second),
        BehaviourRow(
            phrase("Spread of the time between acts of the arms"),
            pstdev(gaps) / fmean(gaps),
            phrase("of its mean"),
        ),
    ]


def _face(plan: Plan, mode: Mode, seconds: float) -> list[BehaviourRow]:
    blinks = [t for t in plan.life.blinks.times if t < seconds]
    gaps = [b - a for a, b in pairwise(blinks)]
    away = sum(
        min(row[0], seconds) - t
        for t, row in zip(plan.life.aversions.times, plan.life.aversions.rows, strict=True)
        if t < seconds
    )
    low, high = (8.0, 21.0) if mode == "idle" else (10.5, 32.5)
    looking: dict[Mode, tuple[float, float]] = {"talking": (0.41, 0.65), "listening": (0.70, 0.85)}
    least, most = looking.get(mode, (None, None))
    return [
        BehaviourRow(
            phrase("Blinks"), 60 * len(blinks) / seconds, phrase("a minute"), low, high, BENTIVOGLIO
        ),
        BehaviourRow(
            phrase("Spread of the time between blinks"),
            pstdev(gaps) / fmean(gaps) if len(gaps) > 1 else 0.0,
            phrase("of its mean"),
            0.5,
            1.0,
        ),
        BehaviourRow(
            phrase("Looks at the other person"),
            1.0 - away / seconds,
            phrase("of the time"),
            least,
            most,
            ARGYLE if least is not None else None,
            True,
        ),
    ]


def _lacks(project: Project, plan: Plan) -> tuple[Lack, ...]:
    """Return the stances whose actions come so often that they have to repeat, those that lack most first."""
    out: list[Lack] = []
    for layer in LAYERS:
        times: dict[tuple[str, Kind], list[float]] = defaultdict(list)
        for cue in plan.layers[layer].cues:
            if cue.action.kind in ("gesture", "fidget"):
                times[cue.stance, cue.action.kind].append(cue.start)
        for (stance, kind), starts in times.items():
            have = len(project.graphs[layer].of(stance, kind))
            within = [sum(1 for other in starts if t - LATER < other <= t) for t in starts]
            more = ceil((1 - MOST_LATER) * fmean(within)) - have
            if more > 0:
                out.append(Lack(layer, stance, kind, have, more))
    return tuple(sorted(out, key=lambda lack: -lack.more))
