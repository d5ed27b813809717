"""Working into a running plan what has just been asked, and telling what becomes of it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Literal

from metagraph.graph.model import LAYERS, Layer, Project
from metagraph.graph.requests import AnyRequest
from metagraph.playback.life.items import BlinkAt, ModeFrom, PlaceFrom, Speech, StayFrom
from metagraph.playback.life.utterances import find_soon, is_paused
from metagraph.playback.plan import Cue, LayerPlan, Past, Plan, Report
from metagraph.playback.planner import Revision, extend_plan
from metagraph.playback.planning.hearing import heard, owners
from metagraph.playback.planning.markov import model
from metagraph.playback.planning.meaning import FOREVER
from metagraph.playback.planning.remembering import remember
from metagraph.playback.planning.understand import understand

State = Literal["planned", "late", "refused", "done"]


def hear_asks(
    project: Project,
    plan: Plan,
    now: float,
    asks: Sequence[AnyRequest],
    end: float,
    stances: Mapping[Layer, str] | None = None,
    idle: bool = True,
) -> Plan:
    """Return the plan with asks worked in that became known at `now`, and the horizon moved to `end`.

    What begins before now + the settings' lookahead stays as it was, but at the very beginning, when nothing
    has been shown; voices begin and stop sooner (`utterances.VOICE`). Asks need ids; of two with one id the
    later counts.
    """
    fixed = now + project.settings.lookahead if now > 0 else 0.0
    soon = find_soon(now, project.settings.lookahead)
    meant = understand(project, asks, fixed, soon)
    turning = [layer for layer in LAYERS if model(project, layer).modes]
    found = heard(plan.requests, plan.track, meant, now, fixed, soon, turning)
    # Without any asks everything is planned again, so that an edited project shows; with some, what they have
    # to do with.
    leave = (
        [layer for layer in LAYERS if layer not in found.touched]
        if asks and now > 0 and end == plan.end
        else []
    )
    plan = replace(plan, track=found.track)
    revision = Revision(frozenset(found.withdrawn), frozenset(found.stopped), leave)
    after = extend_plan(project, plan, fixed, found.fresh, end, stances, idle, revision)
    return replace(after, reports=(*after.reports, *meant.refused)) if meant.refused else after


@dataclass(frozen=True, slots=True)
class AskAnswer:
    """What became of an ask. at, until: seconds, when it plays; None when it will not. what: the actions or
    words.
    """

    id: str
    state: State
    at: float | None
    until: float | None
    what: tuple[str, ...]
    why: str


def answer_ask(plan: Plan, ident: str) -> AskAnswer:
    """Say what a plan does about an ask: when it will play, or why it will not."""
    return answer_asks(plan, (ident,))[ident]


def answer_asks(plan: Plan, idents: Iterable[str]) -> dict[str, AskAnswer]:
    """Say what a plan does about each of many asks, in time that grows with the plan alone."""
    found: dict[str, _Found] = {ident: _Found() for ident in idents}

    def of(made: str) -> Iterator[_Found]:
        return (found[owner] for owner in owners(made) if owner in found)

    served = find_served(plan)
    for layer in plan.layers.values():
        for cue in layer.cues:
            for made in (cue.meta.partition("+")[0], *served.get(cue.meta, ())):
                for x in of(made):
                    x.cues.append(cue)
        for meta in layer.metas:
            if meta.start >= plan.end:
                for x in of(meta.request.id):
                    x.waiting.append(meta.start)
    latest = {speech.id: speech for speech in plan.track.speeches}  # an earlier one of the id is over
    for item in plan.track.items:
        if not isinstance(item, StayFrom) and (not isinstance(item, Speech) or latest[item.id] is item):
            for x in of(item.id):
                if is_paused(item.start):
                    x.waiting.append(item.start)
                else:
                    x.items.append(item)
    for report in plan.reports:
        for x in of(report.request):
            x.told.append(report)
    return {ident: _answer(ident, x) for ident, x in found.items()}


def find_served(plan: Plan) -> dict[str, list[str]]:
    """Return the requests that the action of another serves, by that one's key."""
    served: dict[str, list[str]] = {}
    for report in plan.reports:
        if report.by:
            served.setdefault(report.by, []).append(report.request)
    return served


@dataclass(slots=True)
class _Found:
    """What in a plan belongs to one ask. waiting: seconds at which what is not chosen yet begins."""

    cues: list[Cue] = field(default_factory=list)
    items: list[Any] = field(default_factory=list)
    told: list[Report] = field(default_factory=list)
    waiting: list[float] = field(default_factory=list)


def _answer(ident: str, found: _Found) -> AskAnswer:
    cues, items, told = found.cues, found.items, found.told
    why = "; ".join(dict.fromkeys(r.message for r in told))
    if cues or items:
        starts = [c.start for c in cues] + [i.start for i in items]
        ends = [c.end for c in cues] + [find_item_end(i) for i in items]
        late = any(r.outcome in ("late", "queued", "resumed") for r in told)
        what = (*(c.action.name for c in cues), *(name_item(i) for i in items))
        return AskAnswer(ident, "late" if late else "planned", min(starts), max(ends), what, why)
    if any(r.outcome == "already-there" for r in told):
        return AskAnswer(ident, "done", None, None, (), why)
    if found.waiting and is_paused(found.waiting[0]):
        return AskAnswer(ident, "planned", None, None, (), "it is paused")
    if found.waiting and all(r.played for r in told):
        return AskAnswer(
            ident,
            "late" if told else "planned",
            found.waiting[0],
            None,
            (),
            why or "chosen when its time is nearer",
        )
    return AskAnswer(ident, "refused", None, None, (), why or "nothing came of it")


def find_item_end(item: Any) -> float:
    """Return when something that lasts ends: a mode or a place when another one comes, a blink at once."""
    if isinstance(item, ModeFrom | PlaceFrom):
        return FOREVER
    return float(item.start if isinstance(item, BlinkAt) else item.end)


def name_item(item: object) -> str:
    """Return what answers call something that lasts: "look", "speech", "mode" and so on."""
    name = type(item).__name__
    return {
        "LookAt": "look",
        "Speech": "speech",
        "ModeFrom": "mode",
        "PlaceFrom": "place",
        "BlinkAt": "blink",
        "MoodFrom": "mood",
    }[name]


def drop_ended(plan: Plan, seconds: float) -> Plan:
    """Return a running plan without what ended before `seconds`; what is planned on from it stays as it would
    have been.

    Poses before `seconds` are lost, and those soon after it (`weight.LOOKS_BACK`) may have lost what the body
    answers. What must not be forgotten are the settings' memory (600 s at most) and
    the last draws.
    """
    layers = {layer: _since(of, seconds) for layer, of in plan.layers.items()}
    known = {m.request.id for of in layers.values() for m in of.metas}
    return replace(
        plan,
        layers=layers,
        reports=tuple(r for r in plan.reports if r.at >= seconds),
        requests=tuple(r for r in plan.requests if r.start >= seconds or r.id in known),
        track=plan.track.since(seconds),
        life=plan.life.since(seconds),
    )


def _since(plan: LayerPlan, seconds: float) -> LayerPlan:
    gone = next((n for n, cue in enumerate(plan.cues) if cue.end >= seconds), len(plan.cues))
    rests = [n for n, rest in enumerate(plan.rests) if rest.fade_start + rest.fade <= seconds]
    cues = plan.cues[gone:]
    played = {cue.meta for cue in cues}
    metas = tuple(m for m in plan.metas if m.end >= seconds or m.key in played)
    kept = plan.rests[rests[-1] if rests else 0 :]
    return LayerPlan(plan.layer, metas, cues, kept, _past(plan, plan.cues[:gone]), plan.cursor, plan.written)


def _past(plan: LayerPlan, gone: tuple[Cue, ...]) -> Past:
    if not gone:
        return plan.past
    uses, recent, ended = dict(plan.past.uses), dict(plan.past.recent), dict(plan.past.ended)
    for cue in gone:
        remember(cue, uses, recent, ended)
    return Past(gone[-1].end, gone[-1].then, uses, recent, ended)
