"""Put what they sit on under sitting characters: a stool or a chair, or a rug on the floor."""

from __future__ import annotations

from dataclasses import replace

from app.stage.playback_source import ShownPlayback
from metagraph.graph.seats import find_seat
from preview.furniture import make_chair, make_rug
from preview.looks import SEATS
from preview.scene import Actor
from preview.stool import make_stool


def make_stools(shown: ShownPlayback, furniture: str = SEATS[0]) -> tuple[Actor, ...]:
    """Return the seat of a character whose graph has a sitting stance; it stays there while the character
    stands. Empty for a clip that plays alone. furniture: one of SEATS; who sits on the floor has a rug,
    unless it is "none".
    """
    seat = find_seat(shown.project) if shown.clip is None else None
    if seat is None or furniture == "none":
        return ()
    if seat.floor:
        actor = make_rug(seat.at, seat.radius)
    elif furniture == "chair":
        actor = make_chair(seat.at, seat.radius, seat.turn)
    else:
        actor = make_stool(seat.at, seat.radius)
    if shown.stand is None:
        return (actor,)
    rotations, positions = shown.stand.placed(actor.rotations, actor.positions)
    return (replace(actor, rotations=rotations, positions=positions),)
