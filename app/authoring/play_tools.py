"""Tools that play: which actions a performance has, and how often things happen in it, beside people."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta, Struct

from app.authoring.finding import name_stance
from app.authoring.tool import AuthorError, AuthorTool, ToolOutcome, ToolWork
from metagraph.graph.model import LAYERS, Kind, Layer
from metagraph.graph.words import Mode
from metagraph.playback.behaviour import describe_lack, measure_behaviour
from metagraph.playback.planning.running_plan import improvise, list_kept_asks, plan_performance

LEAST, LONGEST = 60.0, 36000.0  # seconds that are counted


class PlanPerformance(Struct, forbid_unknown_fields=True, omit_defaults=True):
    """performance: the name of one that is kept; without it the character improvises in a mode."""

    seconds: Annotated[float, Meta(gt=0, le=3600)] = 20.0
    mode: Mode = "talking"
    performance: str | None = None
    seed: int | None = None


class CueRow(Struct, omit_defaults=True):
    """What plays. start, end: seconds. then: the stance that follows."""

    start: float
    end: float
    layer: Layer
    kind: Kind
    action: str
    name: str
    stance: str


class CueList(Struct):
    """In order. seed: the same one gives the same performance again."""

    seed: int
    cues: list[CueRow]


def _plan_cues(work: ToolWork, given: PlanPerformance) -> ToolOutcome:
    """Return what plays in a performance."""
    project = work.project
    if given.performance is None:
        plan = improvise(project, given.seconds, given.seed, given.mode)
    else:
        kept = next((p for i, p in project.performances.items() if given.performance in (i, p.name)), None)
        if kept is None:
            names = ", ".join(f"'{p.name}'" for p in project.performances.values()) or "none"
            raise AuthorError(f"there is no performance '{given.performance}'; the project has {names}")
        seed = kept.seed if given.seed is None else given.seed
        asks, stances = list_kept_asks(kept), dict(kept.stances)
        plan = plan_performance(project, asks, given.seconds, seed, stances, kept.idle)
    rows = [
        CueRow(
            round(cue.start, 3),
            round(cue.end, 3),
            layer,
            cue.action.kind,
            cue.action.id,
            cue.action.name,
            name_stance(project, cue.stance),
        )
        for layer in LAYERS
        for cue in plan.layers[layer].cues
    ]
    if not rows:
        raise AuthorError("nothing plays, because no layer has a stance with a loop and actions; label clips")
    return ToolOutcome(CueList(plan.seed, sorted(rows, key=lambda row: (row.start, row.layer))))


class CountRates(Struct, forbid_unknown_fields=True, omit_defaults=True):
    """seconds: how much of it is counted, at least a minute."""

    seconds: Annotated[float, Meta(ge=LEAST, le=LONGEST)] = 3600.0
    mode: Mode = "talking"
    seed: int | None = None


class RateRow(Struct, omit_defaults=True):
    """Something that was counted. people: the least and the most that people do, null if that is unknown;
    usual: whether it is within that. source: who says so.
    """

    name: str
    value: float
    unit: str
    people: tuple[float | None, float | None] = (None, None)
    usual: bool | None = None
    source: str = ""


class RateList(Struct, omit_defaults=True):
    """What happens how often. lacks: stances with too few actions for not repeating themselves."""

    mode: Mode
    seconds: float
    rates: list[RateRow]
    lacks: list[str] = []


def _count_rates(work: ToolWork, given: CountRates) -> ToolOutcome:
    """Return how often things happen, next to how often people do them."""
    found = measure_behaviour(work.project, given.mode, given.seconds, given.seed)
    rows = [
        RateRow(
            str(row.name),
            round(row.value, 3),
            str(row.unit),
            (row.least, row.most),
            row.usual,
            str(row.source or ""),
        )
        for row in found.rows
    ]
    lacks = [str(describe_lack(work.project, lack)) for lack in found.lacks]
    return ToolOutcome(RateList(given.mode, given.seconds, rows, lacks))


TOOLS = (
    AuthorTool(
        "plan_performance",
        "Plan a performance, and list which actions play when.",
        PlanPerformance,
        CueList,
        _plan_cues,
    ),
    AuthorTool(
        "count_rates",
        "Count how often the character gestures, changes its stance, repeats itself, blinks and so on by "
        "itself, next to how often people do.",
        CountRates,
        RateList,
        _count_rates,
        long=True,
    ),
)
