"""Let who is shown rest hands on what stands before them, and stand on steps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np

from app.stage.playback_source import ShownPlayback
from app.stage.props import PropMeshes
from metagraph.graph.prop import Prop, make_turn
from metagraph.motion import rotation
from metagraph.motion.prop_tops import PropTop, find_tops
from metagraph.speech.duet import Stand

Corners = tuple[tuple[float, float, float], ...]


def put_on_props(
    shown: ShownPlayback, meshes: PropMeshes, props: Mapping[str, Prop] | None = None
) -> ShownPlayback:
    """Return what is shown with hands and feet of all speakers on the tops of what stands there; the same if
    nothing changes. props: those of the first speaker, if not those it was planned with. A clip that plays
    alone has none.
    """
    everyone = [_rest(one, shown.everyone[0], meshes, props) for one in (shown, *shown.others)]
    if everyone[0] is shown and all(a is b for a, b in zip(everyone[1:], shown.others, strict=True)):
        return shown
    return everyone[0].keep_evaluator(replace(everyone[0], others=tuple(everyone[1:])))


def _rest(
    one: ShownPlayback, first: ShownPlayback, meshes: PropMeshes, props: Mapping[str, Prop] | None
) -> ShownPlayback:
    if one.clip is not None or one.skeleton is None:
        return one
    now = first.project.props if props is None else props
    tops = tuple(
        top
        for prop in now.values()
        if not prop.joint
        for top in list_prop_tops(prop, meshes, first.folder, (first.stand, one.stand))
    )
    own = now if one.side == first.side else one.project.props
    carried = _list_carried(own, meshes, one) if tops else {}
    if tops == one.tops and carried == one.carried:
        return one
    return one.keep_evaluator(replace(one, tops=tops, carried=carried))


def list_prop_tops(
    prop: Prop,
    meshes: PropMeshes,
    folder: Path | None = None,
    stands: tuple[Stand | None, Stand | None] = (None, None),
) -> tuple[PropTop, ...]:
    """Return the tops of a prop that stands, in a character's space; none until its file is read. folder:
    what its path is relative to, if not what the meshes have. stands: of whose project it is, and of that
    character.
    """
    mesh = meshes.meshes.get(meshes.locate(prop.path, folder))
    if mesh is None:
        return ()
    key = (mesh, prop.at, prop.turn, prop.scale, stands)
    if key not in meshes.tops:
        points = rotation.rotate_vectors(np.array(make_turn(prop)), np.asarray(mesh.positions, float))
        points = points * prop.scale + prop.at
        theirs, own = (stand or Stand() for stand in stands)
        if theirs != own:
            still = np.broadcast_to(np.array((0.0, 0.0, 0.0, 1.0)), (len(points), 4))
            points = theirs.placed(still, points)[1]
            back = Stand(turn=-own.turn)
            points = back.placed(still, points - (own.x, 0.0, own.z))[1]
        # An open surface may be upside down: it is seen from both sides.
        found = find_tops(points, mesh.triangles) or find_tops(points, mesh.triangles, both=True)
        meshes.keep_tops(key, found)
    return meshes.tops[key]


def _list_carried(props: Mapping[str, Prop], meshes: PropMeshes, one: ShownPlayback) -> dict[str, Corners]:
    """Return the corners of the boxes round what each joint carries, in the joint's space, metres."""
    out: dict[str, Corners] = {}
    for prop in props.values():
        mesh = meshes.meshes.get(meshes.locate(prop.path, one.folder)) if prop.joint else None
        if mesh is None:
            continue
        ends = np.stack([mesh.positions.min(0), mesh.positions.max(0)]).astype(float) * prop.scale
        corners = ends[np.array(list(product((0, 1), repeat=3))), (0, 1, 2)]
        placed = rotation.rotate_vectors(np.array(make_turn(prop)), corners) + prop.at
        out[prop.joint] = (*out.get(prop.joint, ()), *((x, y, z) for x, y, z in placed.tolist()))
    return out
