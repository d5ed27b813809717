"""The meaning of asks: requests of the layers, and lasting items (Borer et al., section 6 and figure 5)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

from metagraph.graph.model import Kind, Layer, Limb, MetaGraph, Mode, Project
from metagraph.graph.repeating import cycle_of
from metagraph.playback.life.alphabet import Alphabet
from metagraph.playback.life.graphemes import read_aloud
from metagraph.playback.life.items import BlinkAt, LookAt, ModeFrom, PlaceFrom, Speech, StayFrom
from metagraph.playback.life.line_timing import LineTiming, pace_text, timed_seconds, told_text
from metagraph.playback.life.spots import Spot, named
from metagraph.playback.life.track import Track
from metagraph.playback.plan import ASKED, MetaRequest, Report
from metagraph.playback.planning.finding import action_called, stance_called
from metagraph.playback.planning.mood import MoodFrom
from metagraph.playback.timing.phases import find_longest_lead, lead

FOREVER = 1e9  # seconds; a look that lasts until the next


@dataclass(frozen=True, slots=True)
class PlainAsk:
    """An ask with the fields of all kinds of asks; `do` says which of them count. line: id; said: that line,
    None if there is none. text: the words, or a block of BML. timing: the times of its words and shapes.
    """

    do: str
    id: str = ""
    at: float | None = None
    priority: int = ASKED
    layer: Layer | None = None
    tags: tuple[str, ...] = ()
    limb: Limb | None = None
    duration: float | None = None
    stroke: float | None = None
    hold: float | None = None
    late: float | None = None
    valence: float | None = None
    arousal: float | None = None
    intensity: float | None = None
    prepare: bool = True
    resume: bool = False
    stay: bool = False
    action: str = ""
    stance: str = ""
    to: Spot | None = None
    amount: float = 1.0
    strict: bool = False
    line: str | None = None
    said: SaidLine | None = None
    text: str = ""
    gestures: bool = True
    timing: LineTiming | None = None
    mode: Mode | None = None
    name: str = ""
    point: tuple[float, ...] = ()
    what: str = ""
    more: bool = False


@dataclass(frozen=True, slots=True)
class SaidLine:
    """A line of dialogue. seconds: its length, None if unknown. asks: its own requests, in seconds from its
    start. valence, arousal, intensity: of the mood it is said in.
    """

    text: str = ""
    seconds: float | None = None
    asks: Sequence[PlainAsk] = ()
    valence: float | None = None
    arousal: float | None = None
    intensity: float | None = None


@dataclass(frozen=True, slots=True)
class AskedBlock:
    """A requested block of BML: its behaviours become asks `<id>.1`, `<id>.2`, ..."""

    id: str
    at: float
    priority: int
    text: str


@dataclass(frozen=True, slots=True)
class SteeringAsk:
    """An ask that steers speech. do: "interrupt", "pause", "resume" or "finish". what: the id of the speech,
    "" for all speech.
    """

    do: str
    id: str
    what: str
    priority: int


@dataclass
class Meaning:
    """The meaning of asks, so far. graphs: of the layers, in their order. withdrawn: ids taken back; ""
    stands for all. steered: the asks that steer speech, in order. unknown: the kind of thing that an ask
    names and that does not exist: "action", "stance" or "line". Speeches may overlap. fixed: the earliest
    second at which a gesture of a line can begin; the line itself may begin earlier.
    """

    project: Project
    graphs: Sequence[MetaGraph]
    alphabet: Alphabet
    requests: list[MetaRequest] = field(default_factory=list)
    looks: list[LookAt] = field(default_factory=list)
    speeches: list[Speech] = field(default_factory=list)
    modes: list[ModeFrom] = field(default_factory=list)
    places: list[PlaceFrom] = field(default_factory=list)
    blinks: list[BlinkAt] = field(default_factory=list)
    stays: list[StayFrom] = field(default_factory=list)
    moods: list[MoodFrom] = field(default_factory=list)
    blocks: list[AskedBlock] = field(default_factory=list)
    withdrawn: set[str] = field(default_factory=set)
    steered: list[SteeringAsk] = field(default_factory=list)
    refused: list[Report] = field(default_factory=list)
    unknown: str = ""
    fixed: float = 0.0

    def track(self) -> Track:
        """Return the track of lasting items."""
        return Track(
            tuple(self.looks), tuple(self.speeches), tuple(self.modes), tuple(self.places),
            tuple(self.blinks), tuple(self.stays), tuple(self.moods),
        )  # fmt: skip

    def take(self, other: Meaning) -> None:
        """Add the meaning of other asks."""
        self.requests += other.requests
        self.looks += other.looks
        self.speeches += other.speeches
        self.modes += other.modes
        self.places += other.places
        self.blinks += other.blinks
        self.stays += other.stays
        self.moods += other.moods
        self.blocks += other.blocks
        self.steered += other.steered
        for ident in other.withdrawn:
            self.withdrawn.add(ident)

    def refuse(self, ident: str, why: str, layer: Layer | None, at: float) -> None:
        """Report that an ask was not understood."""
        self.refused.append(Report(ident, "not-understood", why, "arms" if layer is None else layer, at))

    def graph_of(self, layer: Layer) -> MetaGraph:
        """Return a layer's graph."""
        return next(graph for graph in self.graphs if graph.layer == layer)

    def add(self, ask: PlainAsk, ident: str, at: float, priority: int, shift: float) -> str:
        """Add the meaning of an ask; return why it has none, "" if it has one. ident, at, priority: its own,
        or as the line changed them that it belongs to. shift: the second at which that line begins, else 0.
        """
        where = "" if ask.layer is None else f" in the {ask.layer} layer"
        stroke = None if ask.stroke is None else ask.stroke + shift
        start = at
        if ask.do == "gesture" or ask.do == "fidget":
            kind: Kind = "gesture" if ask.do == "gesture" else "fidget"
            layer: Layer = "arms" if ask.layer is None else ask.layer
            if stroke is not None:
                start = max(0.0, stroke - find_longest_lead(self.project, self.graph_of(layer), ask.tags))
            request = MetaRequest(
                ident, layer, kind, start, ask.duration, None, ask.tags, ask.limb, None, priority, ask.resume,
                stroke, ask.hold, ask.prepare, (), ask.late, ask.valence, ask.arousal, ask.intensity,
            )  # fmt: skip
            self.requests.append(request)
        elif ask.do == "action":
            action = action_called(self.graphs, ask.action, ask.layer)
            if action is None:
                self.unknown = "action"
                return f"there is no action '{ask.action}'{where}"
            if stroke is not None:
                start = max(0.0, stroke - lead(self.project, action))
            begins, ends = self.project.span(action)
            repeats = cycle_of(action.kind, action.timing, begins, ends) > 0
            duration = ask.duration if repeats else None
            request = MetaRequest(
                ident, action.layer, action.kind, start, duration, action.id, (), None, None, priority, False,
                stroke, ask.hold, ask.prepare, (), ask.late, ask.valence, ask.arousal, ask.intensity,
            )  # fmt: skip
            self.requests.append(request)
        elif ask.do == "stance":
            stance = stance_called(self.graphs, ask.stance, ask.layer)
            if stance is None:
                self.unknown = "stance"
                return f"there is no stance '{ask.stance}'{where}"
            self.requests.append(
                MetaRequest(
                    ident, stance.layer, "transition", at, stance=stance.id, priority=priority, late=ask.late
                )
            )
            self.stays.append(StayFrom(ident, at, stance.layer, ask.stay))
        elif ask.do == "change":
            # Whichever arm was seen to move: stances are joined by few transitions, and mostly of both.
            layer = "arms" if ask.layer is None else ask.layer
            self.requests.append(
                MetaRequest(ident, layer, "transition", at, priority=priority, late=ask.late)
            )
        elif ask.do == "nod" or ask.do == "shake":
            return self.head(ask, ident, at, priority)
        elif ask.do == "look":
            end = FOREVER if ask.duration is None else at + ask.duration
            to = named("user") if ask.to is None else ask.to
            self.looks.append(LookAt(ident, at, end, to, ask.amount, ask.strict, priority))
        elif ask.do == "blink":
            self.blinks.append(BlinkAt(ident, at))
        elif ask.do == "mood":
            until = math.inf if ask.duration is None else at + ask.duration
            self.moods.append(MoodFrom(ident, at, ask.valence, ask.arousal, ask.intensity, until))
        elif ask.do == "mode":
            self.modes.append(ModeFrom(ident, at, ask.mode))
        elif ask.do == "place":
            self.places.append(PlaceFrom(ident, at, ask.name, ask.point))
        elif ask.do == "withdraw":
            self.withdrawn.add(ask.what)
        elif ask.do == "interrupt" or ask.do == "pause" or ask.do == "resume" or ask.do == "finish":
            self.steered.append(SteeringAsk(ask.do, ident, ask.what, priority))
        elif ask.do == "say":
            return self.say(ask, ident, at, priority)
        elif ask.do == "bml":
            self.blocks.append(AskedBlock(ident, at, priority, ask.text))
        else:
            return f"nothing is known of '{ask.do}'"
        return ""

    def head(self, ask: PlainAsk, ident: str, at: float, priority: int) -> str:
        """Nods are gestures with that tag; if there is none, the likeliest one with that name, whatever
        stance it needs.
        """
        gestures = [
            x
            for x in self.graph_of("head").actions.values()
            if x.kind == "gesture" and all(tag in x.tags for tag in ask.tags)
        ]
        tags: tuple[str, ...] = ()
        called: list[str] = []
        if any(ask.do in x.tags for x in gestures):
            tags = (ask.do, *ask.tags)
        else:
            called = [x.id for x in gestures if ask.do in x.name.lower()]
            if len(called) == 0:
                told = f" with the tags {', '.join(ask.tags)}" if len(ask.tags) > 0 else ""
                return f"the head layer has no gesture tagged or called '{ask.do}'{told}"
        self.requests.append(
            MetaRequest(
                ident,
                "head",
                "gesture",
                at,
                tags=tags,
                priority=priority,
                among=tuple(called),
                late=ask.late,
                valence=ask.valence,
                arousal=ask.arousal,
                intensity=ask.intensity,
            )
        )
        return ""

    def say(self, ask: PlainAsk, ident: str, at: float, priority: int) -> str:
        """Say a line, with its own requests, or other words."""
        line = ask.said
        if ask.line is not None and line is None:
            self.unknown = "line"
            return f"there is no line '{ask.line}'"
        text = ask.text
        if text == "" and line is not None:
            text = line.text
        if text == "" and line is None and ask.timing is not None:
            text = told_text(ask.timing)
        if line is None and text == "" and ask.timing is None:
            return "say what: a line's id, text, or words with their times"
        timing = ask.timing
        if timing is None and line is None and ask.more and ask.duration is not None:
            timing = pace_text(self.alphabet, text, ask.duration)
        if timing is not None:
            length = timed_seconds(timing, ask.duration)
        elif ask.duration is not None:
            length = max(ask.duration, 0.0)
        elif line is not None and line.seconds is not None:
            length = line.seconds
        else:
            length = read_aloud(self.alphabet, text)
        self.speeches.append(
            Speech(ident, at, at + length, ask.line, text, priority, None, timing, 0.0, ask.more)
        )
        told = ask.valence is not None or line is None
        valence = ask.valence if told or line is None else line.valence
        arousal = ask.arousal if told or line is None else line.arousal
        intensity = line.intensity if ask.intensity is None and line is not None else ask.intensity
        if valence is not None or intensity is not None:
            self.moods.append(MoodFrom(ident, at, valence, arousal, intensity, at + length))
        if line is None or not ask.gestures:
            return ""
        for n, inner in enumerate(line.asks):
            if inner.do == "say":
                return "a line would say another line; its asks may not"
            begins = at if inner.at is None else at + inner.at
            if ask.at is None:
                begins = max(begins, self.fixed)
            why = self.add(inner, f"{ident}.{n + 1}", begins, max(inner.priority, priority), at)
            if why != "":
                return why
        return ""


def understood(whole: Meaning, ask: PlainAsk, now: float, soon: float) -> None:
    """Add the meaning of an ask, or refuse all of it. now: when it begins if it does not say; soon: the same
    for speech.
    """
    one = Meaning(whole.project, whole.graphs, whole.alphabet, fixed=now)
    at = (soon if ask.do == "say" else now) if ask.at is None else ask.at
    why = one.add(ask, ask.id, at, ask.priority, 0.0)
    if why == "":
        whole.take(one)
    else:
        whole.refuse(ask.id, why, ask.layer, at)
