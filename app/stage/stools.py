"""Put what they sit on under sitting characters: a stool or a chair, or a rug on the floor."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from app.stage.playback_source import ShownPlayback
from app.stage.props import PropMeshes
from app.stage.seat_fit import ABOVE, LEAST, find_carrying_prop, measure_seat_height
from metagraph.graph.prop import Prop
from metagraph.graph.seats import find_seat
from preview.figure import MeshFigure
from preview.furniture import make_chair, make_rug
from preview.looks import SEATS
from preview.scene import Actor
from preview.stool import make_stool


def make_stools(
    shown: ShownPlayback,
    furniture: str = SEATS[0],
    figure: MeshFigure | None = None,
    meshes: PropMeshes | None = None,
    props: Mapping[str, Prop] | None = None,
) -> tuple[Actor, ...]:
    """Return the seat of a character whose graph has a sitting stance; it stays there while the character
    stands. Empty for a clip that plays alone, and where a prop carries the character. furniture: one of
    SEATS; who sits on the floor has a rug, unless it is "none". figure: whose body tells how high the seat
    is. meshes, props: of the project's props, if not those it was planned with.
    """
    project = shown.project if props is None else replace(shown.project, props=props)
    seat = find_seat(shown.project) if shown.clip is None else None
    if seat is None or furniture == "none":
        return ()
    if (
        meshes is not None
        and project.props
        and not shown.side
        and find_carrying_prop(project, meshes, seat)[0]
    ):
        return ()
    if any(
        LEAST * seat.at[1] < top.meet(seat.at[0], seat.at[2])[0] < seat.at[1] + ABOVE
        for top in shown.tops
        if top.meet(seat.at[0], seat.at[2])[1] == 1
    ):
        return ()  # what the first speaker has carries the others, too
    if figure is not None:
        high = measure_seat_height(project, seat, figure)
        seat = replace(seat, at=(seat.at[0], high, seat.at[2]))
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
