"""Stools under those who sit."""

from __future__ import annotations

from dataclasses import replace

from app.stage.playback_source import ShownPlayback
from metagraph.graph.seats import seat_of
from preview.scene import Actor
from preview.stool import stool


def stools(shown: ShownPlayback) -> tuple[Actor, ...]:
    """Return the stool of a character whose graph has a stance that sits; it stays there while one stands.
    None for a clip that plays alone.
    """
    seat = seat_of(shown.project) if shown.clip is None else None
    if seat is None:
        return ()
    actor = stool(seat.at, seat.radius)
    if shown.stand is None:
        return (actor,)
    rotations, positions = shown.stand.placed(actor.rotations, actor.positions)
    return (replace(actor, rotations=rotations, positions=positions),)
