"""One layer while it is planned: what it may draw on, and what it has played so far."""

from __future__ import annotations

from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field

from metagraph.graph.model import Action, Markov, MetaGraph, Project
from metagraph.playback.life.track import Track
from metagraph.playback.plan import Cue, MetaAction, Outcome, Report, Rest
from metagraph.playback.planning.director import LEAST_BEATS
from metagraph.playback.planning.hashing import Bits
from metagraph.playback.planning.mood import Moods
from metagraph.playback.planning.remembering import remember


@dataclass(slots=True)
class LayerState:
    """One layer being planned, cue after cue. It changes while planning, and never leaves the planner.

    moods: the mood over time. track: what lasts, such as the mode. free: when the next action may begin.
    acted: when the last action ended. uses: how often each action was used. recent: the last draws of each
    `node`. ended: when each action ended. begun: keys of meta actions whose chain of transitions already
    plays. served: keys of those that the action of another one serves, too. candidates: the actions of each
    `node` that may be drawn, for the nodes needed so far. prominences: of actions, as far as needed. model:
    the one that wrote what was not requested, None if there is none. beats: seconds after which a gesture
    that hardly shows may be done again.
    """

    project: Project
    graph: MetaGraph
    seed: Bits
    stance: str
    moods: Moods
    track: Track
    free: float = 0.0
    acted: float = 0.0
    uses: dict[str, int] = field(default_factory=dict)
    recent: dict[str, tuple[str, ...]] = field(default_factory=dict)
    ended: dict[str, float] = field(default_factory=dict)
    cues: list[Cue] = field(default_factory=list)
    rests: list[Rest] = field(default_factory=list)
    reports: list[Report] = field(default_factory=list)
    begun: AbstractSet[str] = frozenset()
    served: set[str] = field(default_factory=set)
    candidates: dict[str, list[Action]] = field(default_factory=dict)
    prominences: dict[str, float] = field(default_factory=dict)
    model: Markov | None = None
    beats: float = LEAST_BEATS

    def note(self, cue: Cue, then: str) -> None:
        """Note that a cue is played."""
        self.cues.append(cue)
        self.free, self.acted, self.stance = cue.end, cue.end, then
        remember(cue, self.uses, self.recent, self.ended)

    @property
    def ready(self) -> float:
        """The earliest time at which the next action may begin."""
        return self.free + (self.project.settings.rest if self.ended else 0.0)

    def moved(self) -> float:
        """Return when the stance was last changed; minus infinity for never."""
        latest = float("-inf")
        for ident, end in self.ended.items():
            action = self.graph.actions.get(ident)
            if action is not None and action.kind == "transition":
                latest = max(latest, end)
        return latest

    def tell(
        self,
        meta: MetaAction,
        outcome: Outcome,
        message: str,
        played: bool = False,
        late: float = 0.0,
        by: str = "",
    ) -> None:
        layer = self.graph.layer
        self.reports.append(
            Report(meta.request.id, outcome, message, layer, meta.start, played, meta.written, late, by)
        )
