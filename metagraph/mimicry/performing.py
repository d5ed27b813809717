"""A recorded person, mimicked: the requests a recording becomes, mixed with what else is asked for and what the models play."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass

import msgspec

from metagraph.graph.asks import AnyAsk, Performance
from metagraph.graph.model import LAYERS, Layer, Project
from metagraph.mimicry.mimic import Mimic, Sighting
from metagraph.mimicry.points import Keypoints
from metagraph.playback.hear import hear
from metagraph.playback.plan import Plan

AHEAD = 10.0  # seconds that are planned ahead while a recording is gone through
REST = 2.0  # seconds a performance goes on after the recording has ended


@dataclass(frozen=True)
class Mimicry:
    """What became of a recording. performance: to keep, or to perform. sightings: what was seen, in its order."""

    performance: Performance
    sightings: tuple[Sighting, ...]


def mimic_performance(
    project: Project,
    keypoints: Keypoints,
    mirror: bool = True,
    layers: Collection[Layer] = LAYERS,
    gaze: bool = False,
    asks: Collection[AnyAsk] = (),
    seed: int | None = None,
    idle: bool = True,
    name: str = "Mimicry",
) -> Mimicry:
    """Return a performance that mimics a recording as it would have been mimicked live; the models do the rest, but change no stances.

    asks: mixed in. Other arguments as for `Mimic` and `perform`. Raises ValueError where there is no character or nobody in the file.
    """
    if not len(keypoints):
        raise ValueError("there is nobody in the keypoints to mimic")
    found: list[AnyAsk] = []
    mimic = Mimic(project, mirror, layers, gaze)
    for some in _steps(project, keypoints, mimic, asks, seed, idle):
        found += some
    length = round(keypoints.seconds + REST, 3)
    kept = Performance(name=name, asks=(*asks, *found), seed=seed, length=length, idle=idle)
    return Mimicry(kept, tuple(mimic.sightings))


def _steps(
    project: Project, keypoints: Keypoints, mimic: Mimic, asks: Collection[AnyAsk], seed: int | None, idle: bool
) -> Iterator[list[AnyAsk]]:
    """Yield what is asked for at each frame at which something is, planning along."""
    named = [ask if ask.id else msgspec.structs.replace(ask, id=f"asked{n}") for n, ask in enumerate(asks)]
    plan = hear(project, Plan(project.settings.seed if seed is None else seed, 0.0), 0.0, named, AHEAD, idle=idle)
    points, confidence = keypoints.canonical
    dims = keypoints.dims
    for at, where, sure in zip(keypoints.times, points, confidence, strict=True):
        now = round(float(at), 3)
        if now > plan.end - AHEAD / 2:
            plan = hear(project, plan, now, [], now + AHEAD, idle=idle)
        some = mimic.feed(now, where[:, :dims], sure, goals(plan, now, mimic.prefix))
        if some:
            plan = hear(project, plan, now, some, max(plan.end, now + AHEAD), idle=idle)
            yield some


def goals(plan: Plan, now: float, mine: str) -> dict[Layer, str]:
    """Return which stance each layer is in or on its way to, and will be in when requests of ids that begin with `mine` have played."""
    out: dict[Layer, str] = {}
    for layer in LAYERS:
        of = plan.layers[layer]
        first = int(of.ends.searchsorted(now, "right"))
        ahead = [cue.then for n, cue in enumerate(of.cues[first:]) if (n == 0 and cue.start <= now) or cue.meta.startswith(mine)]
        stance = ahead[-1] if ahead else of.stance_at(now)
        if stance is not None:
            out[layer] = stance
    return out


def placed(project: Project, performance: Performance) -> Performance:
    """Return a performance whose requests say when they begin, so that they can be seen and moved in time."""
    ahead = project.settings.lookahead
    asks = tuple(
        msgspec.structs.replace(ask, at=round((ask.told or 0.0) + ahead, 3)) if ask.at is None and ask.told else ask
        for ask in performance.asks
    )
    return msgspec.structs.replace(performance, asks=asks)
