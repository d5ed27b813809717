"""What asks do to a running plan: what they take back, what lasts from then on, and which layers have to be
planned again.
"""

from __future__ import annotations

from collections.abc import Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass

from metagraph.graph.words import LAYERS, Layer
from metagraph.playback.life.items import Speech, behind, going_on
from metagraph.playback.life.spots import is_same_spot, named
from metagraph.playback.life.track import Track
from metagraph.playback.plan import MetaRequest
from metagraph.playback.planning.mood import MoodFrom


@dataclass(frozen=True, slots=True)
class Heard:
    """track: what lasts. withdrawn: ids of what was asked for before and is not any more; stopped: those of
    them that were taken back and not asked for anew. touched: layers that asks have to do with.
    """

    track: Track
    withdrawn: AbstractSet[str]
    stopped: AbstractSet[str]
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


def makers(ident: str) -> list[str]:
    """Return what a request goes with when it is taken back: its `owners`, and what is said that a gesture
    was made for: "answer" for "answer/2".
    """
    out = owners(ident)
    said, slash, number = out[-1].rpartition("/")
    if slash != "" and number.isdigit():
        out.append(said)
    return out


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
    said: list[Speech] = []
    begun: set[str] = set()  # of which more is said
    anew: set[str] = set()  # of which something else was said before
    later: dict[str, float] = {}  # by how much those begin that are said behind others of their id
    for asked in more.speeches:
        before_it = None if asked.id in withdrawn else track.last_speech(asked.id)
        last = next((s for s in reversed(said) if s.id == asked.id), before_it)
        one = going_on(last, asked, now)
        if one is not asked and last is not None and one.start == last.start:
            begun.add(one.id)
            said = [s for s in said if s.id != one.id]
        elif one is asked and asked.id not in withdrawn:
            one = behind([*track.speeches, *said], asked, now)
            if one is not asked:
                later[one.id] = one.start - asked.start
        if one is asked and track.last_speech(one.id) is not None:
            anew.add(one.id)
        said.append(one)
    before = [r.id for r in requests]
    before += track.idents()
    # Who takes everything back still looks at whom it talks with.
    user = {x.id for x in track.looks if x.start < now and is_same_spot(x.to, named("user"))}
    taken: set[str] = set()
    stopped: set[str] = set()
    for ident in before:
        every = "" in withdrawn and ident not in user
        if every or (len(withdrawn) > 0 and any(o in withdrawn for o in makers(ident))):
            stopped.add(ident)
        elif len(anew) > 0 and ident not in anew and any(o in anew for o in makers(ident)):
            stopped.add(ident)  # what was made for the words before
        if ident in stopped or ident in gone or ("." in ident and any(o in gone for o in owners(ident))):
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
    over: set[str] = set()
    for ident in taken:
        if ident not in begun and ident not in later:
            over.add(ident)
    moods = [
        MoodFrom(
            m.id, m.start + later[m.id], m.valence, m.arousal, m.intensity, m.end + later[m.id]
        ) if m.id in later else m
        for m in more.moods
    ]  # fmt: skip
    left = track.without(over, now).without(begun)
    lasting = Track(more.looks, tuple(said), more.modes, more.places, more.blinks, tuple(stays), tuple(moods))
    return Heard(left.joined(lasting), taken, stopped, touched)
