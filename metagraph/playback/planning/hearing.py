"""What asks do to a running plan: what they take back, what lasts from then on, and which layers have to be
planned again.
"""

from __future__ import annotations

from collections.abc import Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass

from metagraph.graph.words import LAYERS, Layer
from metagraph.playback.life.items import going_on
from metagraph.playback.life.track import Track
from metagraph.playback.plan import MetaRequest


@dataclass(frozen=True, slots=True)
class Heard:
    """track: what lasts. withdrawn: ids of what was asked for before and is not any more. touched: layers
    that asks have to do with.
    """

    track: Track
    withdrawn: AbstractSet[str]
    touched: AbstractSet[Layer]


def owners(ident: str) -> list[str]:
    """Return the asks a request may have been made by: that of its own id, and those of which it would be a
    part.
    """
    out = [ident]
    left = ident
    while True:
        left, dot, number = left.rpartition(".")
        if dot == "" or not number.isdigit():
            return out
        out.append(left)


def heard(
    requests: Sequence[MetaRequest],
    track: Track,
    fresh: Sequence[MetaRequest],
    more: Track,
    withdrawn: AbstractSet[str],
    refused: Sequence[str],
    now: float,
    turning: Sequence[Layer],
) -> Heard:
    """Return what asks do. requests, track: of the plan. fresh, more: what is asked for, where speeches may
    overlap. withdrawn: ids taken back; every one where it holds "". refused: ids of what could not be
    understood. now: what begins before stays. turning: layers whose models perform one thing in one mode
    and another in another.
    """
    gone = set(withdrawn)
    for ident in refused:
        gone.add(ident)
    for request in fresh:
        gone.add(request.id)
    for ident in more.idents():
        gone.add(ident)
    before = [r.id for r in requests]
    before += track.idents()
    taken: set[str] = set()
    for ident in before:
        if "" in withdrawn or ident in gone or ("." in ident and any(o in gone for o in owners(ident))):
            taken.add(ident)
    # Where the models may change stances again means nothing where they always might.
    staying = {s.layer for s in track.stays if s.on}
    for stay in more.stays:
        if stay.on:
            staying.add(stay.layer)
    stays = [s for s in more.stays if s.layer in staying]
    touched = {r.layer for r in fresh}
    for request in requests:
        if request.id in taken:
            touched.add(request.layer)
    for stay in [*track.stays, *stays]:
        if stay.id in gone or stay.id in taken:
            touched.add(stay.layer)
    turns = (
        len(more.modes) > 0
        or len(more.speeches) > 0
        or any(m.id in taken for m in track.modes)
        or any(s.id in taken for s in track.speeches)
    )
    if turns:  # who talks moves otherwise than who listens
        for layer in turning:
            touched.add(layer)
    if len(more.moods) > 0 or any(m.id in taken for m in track.moods):
        for layer in LAYERS:
            touched.add(layer)
    said = [going_on(track.last_speech(s.id), s, now) for s in more.speeches]
    begun: set[str] = set()  # of which more is said
    for new, asked in zip(said, more.speeches, strict=True):
        if new is not asked:
            begun.add(new.id)
    over: set[str] = set()
    for ident in taken:
        if ident not in begun:
            over.add(ident)
    left = track.without(over, now).without(begun)
    lasting = Track(more.looks, tuple(said), more.modes, more.places, more.blinks, tuple(stays), more.moods)
    return Heard(left.joined(lasting), taken, touched)
