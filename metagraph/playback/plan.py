"""Requests, meta actions and plans: what the planner takes and returns. All are values; times are seconds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import isfinite
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.model import LAYERS, Action, Kind, Layer, Limb
from metagraph.playback.life.schedule import Schedule
from metagraph.playback.life.track import Track

Array = NDArray[Any]

ASKED = 1  # default priority of a request
WRITTEN = 0  # priority of what the Markov model writes


@dataclass(frozen=True, slots=True)
class MetaRequest:
    """A request of an agent or animator, at any level of abstraction.

    id: unique; it keys the random draws. start: seconds. duration: how long the activity should last, None
    for one action. action: id of a specific action. tags: all of them must be on the action. limb: which arm.
    stance: id of the stance to go to (kind "transition"). priority: higher wins. resume: whether the
    remainder plays afterwards if a more important request cuts it. stroke: when a gesture's stroke should
    come; `start` is then the earliest it may begin. hold: seconds that its hold should last, None for its
    length in the clip. prepare: whether its preparation plays. among: ids of the only actions it may be;
    empty for any. late: by how many seconds its stroke may come late, or its start if it has no stroke; 0 for
    on time or not at all, None for as late as the settings allow. valence, arousal, intensity: the mood it is
    played in, as in `mood.Mood`; None for the mood at that time.
    """

    id: str
    layer: Layer
    kind: Kind
    start: float
    duration: float | None = None
    action: str | None = None
    tags: tuple[str, ...] = ()
    limb: Limb | None = None
    stance: str | None = None
    priority: int = ASKED
    resume: bool = False
    stroke: float | None = None
    hold: float | None = None
    prepare: bool = True
    among: tuple[str, ...] = ()
    late: float | None = None
    valence: float | None = None
    arousal: float | None = None
    intensity: float | None = None

    def __post_init__(self) -> None:
        if not (
            isfinite(self.start)
            and isfinite(self.duration or 0.0)
            and isfinite(self.stroke or 0.0)
            and isfinite(self.hold or 0.0)
            and isfinite(self.late or 0.0)
        ):
            raise ValueError(f"request '{self.id}': its times must be finite numbers of seconds")


@dataclass(frozen=True, slots=True)
class Cursor:
    """Where writing continues: before meta action `number`, after state number `state` (-1: none yet), which
    ended at `time` seconds.
    """

    number: int = 0
    state: int = -1
    time: float = 0.0


@dataclass(frozen=True, slots=True)
class MetaAction:
    """A request placed in time: `start`..`end` is the window it may use. written: whether the Markov model
    wrote it, instead of a request. part: 0 for the request itself, n for its n-th remainder after a cut.
    """

    request: MetaRequest
    start: float
    end: float
    part: int = 0
    written: bool = False

    @property
    def rank(self) -> float:
        """Its importance: its request's priority. What a model wrote gives way to all requests."""
        return float("-inf") if self.written else self.request.priority

    @property
    def key(self) -> str:
        """The key of this meta action's random draws."""
        return self.request.id if self.part == 0 else f"{self.request.id}+{self.part}"


@dataclass(frozen=True, slots=True)
class Cue:
    """One action in the plan. It plays its clip from `entry` on during `start`..`end`, at `tempo` times its
    own speed but for its hold.

    hold_from, hold_to: clip seconds of the hold, which takes `hold` seconds; 0, 0, 0 if it is not stretched.
    blend_in, blend_out: seconds, fitting inside the cue. stance: before it; then: the stance it leaves the
    layer in. meta: key of the meta action it realises. extent: how large it is played, a factor of its turns
    away from the stance. cycle_from, cycle_to: clip seconds between which it repeats; 0, 0 if it plays once.
    """

    action: Action
    start: float
    end: float
    entry: float
    blend_in: float
    blend_out: float
    stance: str
    then: str
    meta: str
    hold_from: float = 0.0
    hold_to: float = 0.0
    hold: float = 0.0
    extent: float = 1.0
    tempo: float = 1.0
    cycle_from: float = 0.0
    cycle_to: float = 0.0

    @property
    def repeats(self) -> bool:
        """Whether it repeats a cycle."""
        return self.cycle_to > self.cycle_from

    def clip_seconds(self, times: Any) -> Any:
        """Return the clip seconds shown at `times`, a number or an array `[...]` within the cue."""
        elapsed = times - self.start
        if self.repeats:
            cycle = self.cycle_to - self.cycle_from
            into = self.entry - self.cycle_from + elapsed * self.tempo
            return self.cycle_from + into - cycle * np.floor(into / cycle)
        if self.hold <= 0:
            return self.entry + elapsed * self.tempo
        before, natural = (self.hold_from - self.entry) / self.tempo, self.hold_to - self.hold_from
        held = np.clip(elapsed - before, 0.0, self.hold)
        more = (elapsed - held) * (self.tempo - 1)  # none at its own speed, to the last digit
        return self.entry + elapsed - held + more + held * (natural / self.hold)

    @property
    def once(self) -> Cue:
        """The cue until it begins its cycle again; itself if it plays once."""
        if not self.repeats:
            return self
        end = min(self.end, self.start + (self.cycle_to - self.entry) / self.tempo)
        return replace(self, end=end, cycle_from=0.0, cycle_to=0.0)

    @property
    def last(self) -> float:
        """Clip seconds shown at its end."""
        return float(self.clip_seconds(self.end))


@dataclass(frozen=True, slots=True)
class Rest:
    """The stance loop that lies under the cues from `start` on: loop seconds are `time - start`, wrapped.

    fade_start, fade: when and for how many seconds it takes over from the loop before.
    """

    stance: str
    action: Action
    start: float
    fade_start: float
    fade: float


Outcome = Literal[
    "late",
    "cut",
    "resumed",
    "covered",
    "no-room",
    "no-candidate",
    "other-limb",
    "no-way",
    "no-stance",
    "unknown-action",
    "past",
    "already-there",
    "cooling",
    "queued",
    "not-understood",
    "withdrawn",
    "too-late",
    "shared",
]
TEMPORAL: frozenset[Outcome] = frozenset(
    ("late", "cut", "resumed", "past")
)  # told by temporal replanning, once


@dataclass(frozen=True, slots=True)
class Report:
    """The result of a meta action that does not play exactly as requested. played: whether a part of it still
    plays. late: by how many seconds it comes late, or would have come, if it said how late it may. by: key of
    the meta action whose action serves it, too.
    """

    request: str
    outcome: Outcome
    message: str
    layer: Layer
    at: float
    played: bool = False
    written: bool = False
    late: float = 0.0
    by: str = ""


@dataclass(frozen=True, slots=True)
class Past:
    """What further planning needs from forgotten cues. free: when the last one ended; stance: in which
    stance. uses: how often each action was used. recent: the actions used last, by `remembering.node`, the
    latest at the end. ended: when each ended last.
    """

    free: float = 0.0
    stance: str = ""
    uses: Mapping[str, int] = field(default_factory=dict)
    recent: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    ended: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class LayerPlan:
    """cues never overlap and ascend; rests ascend by fade_start, the first covering everything before.

    past: what came before the first cue, if that was forgotten. cursor: where the Markov model continues to
    write. written: what it wrote for later, unchanged: each extension fits it in again, so that it does not
    matter when it was written.
    """

    layer: Layer
    metas: tuple[MetaAction, ...] = ()
    cues: tuple[Cue, ...] = ()
    rests: tuple[Rest, ...] = ()
    past: Past = Past()
    cursor: Cursor = Cursor()
    written: tuple[MetaAction, ...] = ()

    @cached_property
    def starts(self) -> Array:
        """When each cue starts, `[C]`."""
        return np.array([cue.start for cue in self.cues])

    @cached_property
    def ends(self) -> Array:
        """When each cue ends, `[C]`."""
        return np.array([cue.end for cue in self.cues])

    @cached_property
    def full_from(self) -> Array:
        """When each cue has blended in, `[C]`."""
        return np.array([cue.start + cue.blend_in for cue in self.cues])

    @cached_property
    def full_to(self) -> Array:
        """When each cue begins to blend out, `[C]`."""
        return np.array([cue.end - cue.blend_out for cue in self.cues])

    @cached_property
    def fade_starts(self) -> Array:
        """When each rest begins to take over, `[R]`."""
        return np.array([rest.fade_start for rest in self.rests])

    @cached_property
    def fade_ends(self) -> Array:
        """When each rest has taken over, `[R]`."""
        return np.array([rest.fade_start + rest.fade for rest in self.rests])

    def cue_at(self, seconds: float) -> Cue | None:
        """Return the cue playing at a time, or None while the stance rests."""
        place = int(self.starts.searchsorted(seconds, "right")) - 1
        return self.cues[place] if place >= 0 and seconds < self.cues[place].end else None

    def stance_at(self, seconds: float) -> str | None:
        """Return the stance the layer rests in or, during a transition, leaves."""
        place = int(self.starts.searchsorted(seconds, "right")) - 1
        if place >= 0:
            cue = self.cues[place]
            return cue.stance if seconds < cue.end else cue.then
        return self.rests[0].stance if self.rests else None


def _empty() -> dict[Layer, LayerPlan]:
    return {layer: LayerPlan(layer) for layer in LAYERS}


@dataclass(frozen=True)
class Plan:
    """The specific actions of every layer from 0 to `end` seconds, and reports of requests that could not be
    met.

    track: the requests of the life layers; life: what they do. Both begin where the plan was last cut
    (`drop_ended`).
    """

    seed: int
    end: float
    layers: Mapping[Layer, LayerPlan] = field(default_factory=_empty)
    reports: tuple[Report, ...] = ()
    requests: tuple[MetaRequest, ...] = ()
    track: Track = field(default_factory=Track)
    life: Schedule = field(default_factory=Schedule)
