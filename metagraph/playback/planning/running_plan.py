"""A plan that goes on: what is asked is worked in when it becomes known, the horizon moves along, and what is
over is put aside.

Live sessions, characters in programs and kept sessions that are performed again all plan through this.
Planning costs what lies ahead and what was lately, so that an hour of requests takes an hour's time and not
its square.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import msgspec

from metagraph.graph import requests as a
from metagraph.graph.model import LAYERS, Layer, Mode, Project
from metagraph.playback.life.lane import Lane
from metagraph.playback.life.near_life import LANES
from metagraph.playback.life.track import Item, track_of
from metagraph.playback.plan import Cue, LayerPlan, MetaAction, MetaRequest, Plan, Report, Rest
from metagraph.playback.planning.extend_performance import drop_ended, hear_asks
from metagraph.playback.planning.hearing import owners
from metagraph.playback.planning.plan_head import RECENT

AHEAD = 20.0  # seconds of plan
SLACK = 2.0  # seconds by which a plan may fall behind its horizon before it is extended
REPLAYED = 10.0  # seconds planned at a time if nobody waits for an answer, beyond what a live session plans
CUT = 15.0  # seconds between two cuts


class RunningPlan:
    """plan: as it is now. Arguments as for `perform`; ahead: seconds that are planned."""

    def __init__(
        self,
        project: Project,
        seed: int | None = None,
        stances: Mapping[Layer, str] | None = None,
        idle: bool = True,
        ahead: float = AHEAD,
    ) -> None:
        self.project, self.stances, self.idle, self.ahead = project, dict(stances or {}), idle, ahead
        empty = Plan(project.settings.seed if seed is None else seed, 0.0)
        self.plan = hear_asks(project, empty, 0.0, [], ahead, self.stances, idle)

    def reach(self, now: float, anew: bool = False) -> None:
        """Plan on where less than `ahead`, except for a little, is left at `now`; again: also what has not
        begun, for an edited project.
        """
        end = (
            self.plan.end
            if self.plan.end >= now + self.ahead - min(SLACK, self.ahead / 2)
            else now + self.ahead
        )
        if anew or end > self.plan.end:
            self.extend(now, end)

    def extend(self, now: float, end: float) -> None:
        """Plan to `end`."""
        self.plan = hear_asks(self.project, self.plan, now, [], end, self.stances, self.idle)

    def hear(self, now: float, asks: Sequence[a.AnyRequest]) -> None:
        """Work in what became known at `now`."""
        if asks:
            self.plan = hear_asks(self.project, self.plan, now, asks, self.plan.end, self.stances, self.idle)

    def forget(self, over: float) -> Plan:
        """Put aside what ended before `over`, and plan on without it; return the plan as it was."""
        before, self.plan = self.plan, drop_ended(self.plan, over)
        return before


def plan_performance(
    project: Project,
    asks: Iterable[a.AnyRequest],
    end: float,
    seed: int | None = None,
    stances: Mapping[Layer, str] | None = None,
    idle: bool = True,
) -> Plan:
    """Plan a performance from 0 to `end` seconds. Arguments as for `make_plan`.

    Asks that say when they became known (`told`) are worked in then, as in the session they are of.
    """
    groups: dict[float, list[a.AnyRequest]] = {0.0: []}
    for number, ask in enumerate(asks):
        groups.setdefault(ask.told or 0.0, []).append(
            ask if ask.id else msgspec.structs.replace(ask, id=f"ask{number}")
        )
    first = groups.pop(0.0)
    if not groups:
        empty = Plan(project.settings.seed if seed is None else seed, 0.0)
        return hear_asks(project, empty, 0.0, first, end, stances, idle)
    running = RunningPlan(project, seed, stances, idle, min(AHEAD + REPLAYED, end))
    running.hear(0.0, first)
    pieces: list[CutPiece] = []
    named: list[str] = []  # what asks were about, in order
    recent, cut, last = max(RECENT, project.settings.memory), 0.0, 0.0
    for now in sorted(groups):
        _on(running, last, now, end)
        running.hear(now, groups[now])
        named += (ask.what if isinstance(ask, a.Withdraw) else ask.id for ask in groups[now])
        if now > cut + recent + CUT:
            cut = now - recent
            before = running.forget(cut)
            pieces.append(CutPiece(before, running.plan, len(named)))
        last = now
    if end > running.plan.end:
        running.extend(last, end)
    return join_plan(running.plan, pieces, named)


def improvise(
    project: Project,
    end: float,
    seed: int | None = None,
    mode: Mode = "talking",
    asks: Sequence[a.AnyRequest] = (),
) -> Plan:
    """Plan what the models do by themselves from 0 to `end` seconds, while the character talks, listens or
    idles; nothing is said. The window, `render` and `check` show it talking, since gestures play only then.
    `asks` are requested of it meanwhile.
    """
    return plan_performance(project, [a.Behave(id="improvised-mode", at=0.0, mode=mode), *asks], end, seed)


def _on(running: RunningPlan, last: float, now: float, end: float) -> None:
    """Move the horizon along, to no later than the end: as time went by from what was heard `last` to `now`,
    since a plan must reach beyond what it is planned on from, and must not go back to before what it heard.
    """
    slack = min(REPLAYED, running.ahead / 2)
    while running.plan.end < min(end, now + running.ahead - slack):
        then = max(last, running.plan.end - running.ahead + slack)
        running.extend(then, min(end, then + running.ahead))


def list_kept_asks(kept: a.Performance) -> tuple[a.AnyRequest, ...]:
    """Return what a kept performance asks for: first its mood, which lasts under all others, and its mode,
    where the models fill the gaps and no request sets one from the beginning.
    """
    own: list[a.AnyRequest] = []
    if kept.mood is not None or kept.intensity is not None:
        own.append(a.Feel(id="performance-mood", at=0.0, mood=kept.mood, intensity=kept.intensity))
    if kept.idle and not any(isinstance(ask, a.Behave) and (ask.at or 0.0) <= 0.0 for ask in kept.asks):
        own.append(a.Behave(id="performance-mode", at=0.0, mode=kept.mode))
    return (*own, *kept.asks)


@dataclass(frozen=True, slots=True)
class CutPiece:
    """A cut of a running plan: before it, after it, and how many asks there had been."""

    before: Plan
    after: Plan
    asked: int


def join_plan(plan: Plan, pieces: Sequence[CutPiece], named: Sequence[str]) -> Plan:
    """Return a plan with what was put aside. named: the ids that all asks were about, in order; of one asked
    for or taken back again after a cut, what was put aside is not told any more.
    """
    if not pieces:
        return plan
    later = [frozenset(named[piece.asked :]) for piece in pieces]
    layers: dict[Layer, LayerPlan] = {}
    for layer in LAYERS:
        cues: list[Cue] = []
        rests: list[Rest] = []
        metas: list[MetaAction] = []
        for piece, again in zip(pieces, later, strict=True):
            was, on = piece.before.layers[layer], piece.after.layers[layer]
            cues += was.cues[: len(was.cues) - len(on.cues)]
            rests += was.rests[: len(was.rests) - len(on.rests)]
            kept = {id(m) for m in on.metas}
            metas += [m for m in was.metas if id(m) not in kept and not _again(m.request.id, again)]
        last, first = plan.layers[layer], pieces[0].before.layers[layer]
        layers[layer] = replace(
            last,
            metas=(*metas, *last.metas),
            cues=(*cues, *last.cues),
            rests=(*rests, *last.rests),
            past=first.past,
        )
    reports: list[Report] = []
    requests: list[MetaRequest] = []
    items: list[Item] = []
    for piece, again in zip(pieces, later, strict=True):
        before, after = piece.before, piece.after
        told, asked, there = (
            {id(x) for x in xs} for xs in (after.reports, after.requests, after.track.items)
        )
        reports += [r for r in before.reports if id(r) not in told and not _again(r.request, again)]
        requests += [r for r in before.requests if id(r) not in asked and not _again(r.id, again)]
        items += [i for i in before.track.items if id(i) not in there]
    life, cuts = plan.life, [(piece.before, piece.after) for piece in pieces]
    lanes: dict[str, Any] = {
        name: _joined(
            [
                *(_gone(getattr(before.life, name), getattr(after.life, name)) for before, after in cuts),
                getattr(life, name),
            ]
        )
        for name in LANES
    }
    targets = [
        t
        for before, after in cuts
        for t in before.life.targets[: len(before.life.targets) - len(after.life.targets)]
    ]
    return replace(
        plan,
        layers=layers,
        reports=tuple(sorted([*reports, *plan.reports], key=lambda r: r.at)),
        requests=(*requests, *plan.requests),
        track=track_of([*items, *plan.track.items]),
        life=replace(life, targets=(*targets, *life.targets), **lanes),
    )


def _again(ident: str, again: Collection[str]) -> bool:
    """Whether something is of what was asked for, or taken back, again: of it only the later counts."""
    return bool(again) and ("" in again or any(owner in again for owner in owners(ident)))


def _gone(before: Lane, after: Lane) -> Lane:
    count = after.first - before.first
    return Lane(before.times[:count], before.rows[:count], before.first, before.width)


def _joined(lanes: Sequence[Lane]) -> Lane:
    times = [time for x in lanes for time in x.times]
    return Lane(times, [row for x in lanes for row in x.rows], lanes[0].first, lanes[0].width)
