"""Find how high a character sits, from the underside of its body, and which prop it sits on."""

from __future__ import annotations

from collections.abc import Mapping
from math import cos, pi, sin
from weakref import WeakKeyDictionary

import msgspec
import numpy as np

from app.stage.props import PropMeshes
from metagraph.graph.checks.end_gaps import get_action_motion
from metagraph.graph.model import Project
from metagraph.graph.prop import LARGEST, Prop, make_turn
from metagraph.graph.seats import Seat
from metagraph.motion import rotation
from metagraph.motion.mesh_rays import find_hits
from preview.figure import MeshFigure
from preview.posed_points import find_posed_points

ROUND = (0.0, 0.05, 0.1, 0.14)  # metres from the middle of a seat at which the body is measured
LOWEST = 5  # per cent of those places are lower than what carries the body
PRESSED = 0.01  # metres that flesh gives way
ABOVE = 0.25  # metres above the seat of a stool at which what carries is still looked for
LEAST = 0.5  # of that seat's height: what is lower carries nobody
LEVEL = 0.05  # metres that a seat may rise and fall
SAME = 0.01  # metres that nobody sees

_known: WeakKeyDictionary[MeshFigure, dict[Seat, float]] = WeakKeyDictionary()


def measure_seat_height(project: Project, seat: Seat, figure: MeshFigure) -> float:
    """Return how high what carries a sitting figure is, metres: as high as the underside of its body there,
    by rays from below, and a little higher, since flesh gives way. As `seat` has it for a figure without one.
    """
    known = _known.setdefault(figure, {})
    if seat not in known:
        known[seat] = _measured(project, seat, figure)
    return known[seat]


def _measured(project: Project, seat: Seat, figure: MeshFigure) -> float:
    action = project.action(seat.stance)
    motion = get_action_motion(project, action) if action is not None else None
    if seat.floor or action is None or motion is None or project.skeleton != figure.skeleton:
        return seat.at[1]
    pose = motion.pose_at(project.span(action)[0])
    points = find_posed_points(figure, *figure.skeleton.globals(pose))
    triangles = np.asarray(figure.mesh.triangles).reshape(-1, 3)
    near = np.hypot(points[:, 0] - seat.at[0], points[:, 2] - seat.at[2]) < 2 * ROUND[-1]
    triangles = triangles[near[triangles].any(1)]
    heights = []
    places = _list_places(seat, ROUND[-1])
    for x, z in places:
        heights += find_hits(points, triangles, (x, 0.0, z), (0.0, 1.0, 0.0))[:1].tolist()
    if len(heights) < len(places) / 2:  # a stick figure has nothing there
        return seat.at[1]
    return float(np.percentile(heights, LOWEST)) + PRESSED


def _list_places(seat: Seat, most: float) -> list[tuple[float, float]]:
    """Return the places at which a seat is measured, x and z in metres, up to so far from its middle."""
    rings = [
        (seat.at[0] + away * sin(angle), seat.at[2] + away * cos(angle))
        for away in ROUND[1:]
        if away <= most
        for angle in np.arange(8) * pi / 4
    ]
    return [(seat.at[0], seat.at[2]), *rings]


def find_carrying_prop(project: Project, meshes: PropMeshes, seat: Seat) -> tuple[str, float]:
    """Return the id of the prop that stands below who sits, and how high it is there, metres, by rays from
    above; "" and 0 if there is only the floor.
    """
    placed = {
        ident: prop
        for ident, prop in project.props.items()
        if not prop.joint and meshes.locate(prop.path) in meshes.meshes
    }
    key = (seat, tuple(placed.items()))
    if meshes.carrying is None or meshes.carrying[0] != key:
        meshes.carrying = key, _find_carrying(placed, meshes, seat)
    return meshes.carrying[1]


def _find_carrying(props: Mapping[str, Prop], meshes: PropMeshes, seat: Seat) -> tuple[str, float]:
    found = ("", 0.0)
    if seat.floor:
        return found
    high = seat.at[1] + ABOVE
    for ident, prop in props.items():
        mesh = meshes.meshes[meshes.locate(prop.path)]
        points = rotation.rotate_vectors(np.array(make_turn(prop)), mesh.positions * prop.scale) + prop.at
        corners = points[mesh.triangles][..., [0, 2]] - np.array([seat.at[0], seat.at[2]])
        near = (corners.min(1) < ROUND[2]).all(1) & (corners.max(1) > -ROUND[2]).all(1)
        triangles, tops = mesh.triangles[near], []
        places = _list_places(seat, ROUND[2])
        for x, z in places:
            tops += (high - find_hits(points, triangles, (x, high, z), (0.0, -1.0, 0.0))[:1]).tolist()
        low, top, upper = np.percentile(tops, (20, 50, 80)) if len(tops) > len(places) / 2 else np.zeros(3)
        if upper - low > LEVEL:  # leaves carry nobody
            continue
        if top > max(found[1], LEAST * seat.at[1]):
            found = (ident, float(top))
    return found


def fit_prop_to_seat(prop: Prop, top: float, wanted: float) -> Prop:
    """Return a prop whose seat is as high as wanted: larger or smaller where it stands on the floor, higher
    or lower where it is lifted. top, wanted: metres.
    """
    x, y, z = prop.at
    if abs(y) > SAME or top <= 0:
        return msgspec.structs.replace(prop, at=(x, round(y + wanted - top, 4), z))
    return msgspec.structs.replace(prop, scale=round(min(LARGEST, prop.scale * wanted / top), 4))
