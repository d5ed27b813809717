"""Put stools under sitting characters."""

from __future__ import annotations

from dataclasses import replace

from app.stage.playback_source import ShownPlayback
from metagraph.graph.seats import find_seat
from preview.scene import Actor
from preview.stool import make_stool


def make_stools(shown: ShownPlayback) -> tuple[Actor, ...]:
    """Return the stool of a character whose graph has a sitting stance; it stays there while the character
    stands. Empty for a clip that plays alone.
    """
    seat = find_seat(shown.project) if shown.clip is None else None
    if seat is None:
        return ()
    actor = make_stool(seat.at, seat.radius)
    if shown.stand is None:
        return (actor,)
    rotations, positions = shown.stand.placed(actor.rotations, actor.positions)
    return (replace(actor, rotations=rotations, positions=positions),)
