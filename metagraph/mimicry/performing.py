"""A recorded person, mimicked: the requests a recording becomes, mixed with what else is asked for and what
the models play.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass
from itertools import count

import msgspec

from metagraph.graph.model import LAYERS, Layer, Project
from metagraph.graph.requests import AnyRequest, Performance
from metagraph.mimicry.keypoint_layouts import KeypointTrack
from metagraph.mimicry.mimic import Mimic, Sighting
from metagraph.playback.plan import Plan
from metagraph.playback.planning.extend_performance import hear_asks

AHEAD = 10.0  # seconds that are planned ahead while a recording is gone through
REST = 2.0  # seconds a performance goes on after the recording has ended


@dataclass(frozen=True)
class Mimicry:
    """What became of a recording. performance: to keep, or to perform. sightings: what was seen, in its
    order.
    """

    performance: Performance
    sightings: tuple[Sighting, ...]


def mimic_performance(
    project: Project,
    keypoints: KeypointTrack,
    mirror: bool = True,
    layers: Collection[Layer] = LAYERS,
    gaze: bool = False,
    into: Performance | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Mimicry:
    """Return a performance that mimics a recording as it would have been mimicked live; the models do the
    rest, but change no stances.

    into: the performance that what is seen is mixed into: its requests, seed, stances and length; a new one
    where it is None. progress: told how many frames are done, of how many; what it raises ends it. Other
    arguments as for `Mimic`. Raises ValueError if there is no character, or nobody in the file.
    """
    if not len(keypoints):
        raise ValueError("there is nobody in the keypoints to mimic")
    keypoints = keypoints.judged
    into = into or Performance(name="Mimicry", length=round(keypoints.seconds + REST, 3))
    mimic = Mimic(project, mirror, layers, gaze, prefix=_prefix(into.asks))
    asks = [ask for some in _steps(project, keypoints, mimic, into, progress) for ask in some]
    length = max(into.length, round(keypoints.seconds, 3))
    return Mimicry(
        msgspec.structs.replace(into, asks=(*into.asks, *asks), length=length), tuple(mimic.sightings)
    )


def _prefix(asks: Collection[AnyRequest]) -> str:
    """Return what ids begin with that none of these do."""
    some = ("mimic" + "b" * n for n in count())
    return next(
        p
        for p in some
        if not any(ask.id.removeprefix(p)[:1].isdigit() for ask in asks if ask.id.startswith(p))
    )


def _steps(
    project: Project,
    keypoints: KeypointTrack,
    mimic: Mimic,
    into: Performance,
    progress: Callable[[int, int], object] | None,
) -> Iterator[list[AnyRequest]]:
    """Yield what is requested at each frame at which something is, planning along."""
    named = [
        ask if ask.id else msgspec.structs.replace(ask, id=f"asked{n}") for n, ask in enumerate(into.asks)
    ]
    waiting = sorted(named, key=lambda ask: ask.told or 0.0)
    plan = Plan(project.settings.seed if into.seed is None else into.seed, 0.0)

    def heard(now: float, asks: list[AnyRequest]) -> Plan:
        return hear_asks(project, plan, now, asks, max(plan.end, now + AHEAD), dict(into.stances), into.idle)

    points, confidence = keypoints.canonical
    for n, (at, where, sure) in enumerate(zip(keypoints.times, points, confidence, strict=True)):
        now = round(float(at), 3)
        while waiting and (waiting[0].told or 0.0) <= now:
            told = waiting[0].told or 0.0
            plan = heard(told, [ask for ask in waiting if (ask.told or 0.0) == told])
            waiting = [ask for ask in waiting if (ask.told or 0.0) > told]
        if now > plan.end - AHEAD / 2:
            plan = heard(now, [])
        some = mimic.feed(now, where[:, : keypoints.dims], sure, find_goal_stances(plan, now, mimic.prefix))
        if some:
            plan = heard(now, some)
            yield some
        if progress is not None and n % 50 == 0:
            progress(n, len(keypoints))


def find_goal_stances(plan: Plan, now: float, mine: str) -> dict[Layer, str]:
    """Return which stance each layer is in or on its way to, and will be in when requests of ids that begin
    with `mine` have played.
    """
    out: dict[Layer, str] = {}
    for layer in LAYERS:
        of = plan.layers[layer]
        first = int(of.ends.searchsorted(now, "right"))
        ahead = [
            cue.then
            for n, cue in enumerate(of.cues[first:])
            if (n == 0 and cue.start <= now) or cue.meta.startswith(mine)
        ]
        stance = ahead[-1] if ahead else of.stance_at(now)
        if stance is not None:
            out[layer] = stance
    return out


def place_requests(project: Project, performance: Performance) -> Performance:
    """Return a performance whose requests say when they begin, so that they can be seen and moved in time."""
    ahead = project.settings.lookahead
    asks = tuple(
        msgspec.structs.replace(ask, at=round((ask.told or 0.0) + ahead, 3))
        if ask.at is None and ask.told
        else ask
        for ask in performance.asks
    )
    return msgspec.structs.replace(performance, asks=asks)
