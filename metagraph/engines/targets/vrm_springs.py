"""The spring bones of a VRM 1.0 file (VRMC_springBone), kept for the joints that an export has."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from metagraph.formats.gltf.file import get_extras, open_gltf
from metagraph.formats.gltf.skeleton import build_rig
from metagraph.motion.skeleton import Skeleton

EXTENSION = "VRMC_springBone"


def read_spring_bones(path: Path, skeleton: Skeleton) -> tuple[dict[str, Any] | None, int]:
    """Return the spring bones of the file that the character comes from, with the skeleton's joints as nodes,
    and how many joints of them are left out because the skeleton lacks them. None if there are none. Raises
    FileError.
    """
    gltf = open_gltf(path)
    stated = get_extras(gltf.json.extensions).get(EXTENSION)
    if not isinstance(stated, dict):
        return None, 0
    rig = build_rig(gltf)
    known = {name: joint for joint, name in enumerate(skeleton.names)}

    def find(node: Any) -> int | None:
        place = rig.places.get(node) if isinstance(node, int) and not isinstance(node, bool) else None
        return known.get(rig.skeleton.names[place]) if place is not None else None

    return keep_spring_bones(stated, find)


def keep_spring_bones(
    stated: Mapping[str, Any], find: Callable[[Any], int | None]
) -> tuple[dict[str, Any] | None, int]:
    """Return the extension with other nodes, and how many joints it loses. find: returns the new node of an
    old one, None if there is none. A spring ends above a joint that is gone; colliders of nodes that are gone
    go, too. Colliders keep the shape that every program reads, without extensions.
    """

    def move_collider(one: dict[str, Any]) -> dict[str, Any] | None:
        return _move({key: value for key, value in one.items() if key != "extensions"}, find)

    colliders, collider_places = _keep(_list(stated, "colliders"), move_collider)
    groups, group_places = _keep(
        _list(stated, "colliderGroups"), lambda one: _renumber(one, "colliders", collider_places)
    )
    springs: list[dict[str, Any]] = []
    lost = 0
    for spring in _list(stated, "springs"):
        joints: list[dict[str, Any]] = []
        every = _list(spring, "joints")
        for joint in every:
            moved = _move(joint, find)
            if moved is None:
                break
            joints.append(moved)
        lost += len(every) - len(joints)
        if len(joints) < 2:  # the last joint of a spring only says where the one before points
            lost += len(joints)
            continue
        kept = {**spring, "joints": joints}
        named = _renumber(spring, "colliderGroups", group_places)
        kept.pop("colliderGroups", None)
        if named is not None:
            kept["colliderGroups"] = named["colliderGroups"]
        center = find(kept.pop("center", None))
        springs.append({**kept, "center": center} if center is not None else kept)
    if not springs:
        return None, lost
    out: dict[str, Any] = {"specVersion": "1.0", "springs": springs}
    if colliders:
        out["colliders"] = colliders
    if groups:
        out["colliderGroups"] = groups
    return out, lost


def _list(value: Mapping[str, Any], name: str) -> list[dict[str, Any]]:
    found = value.get(name)
    return [one for one in found if isinstance(one, dict)] if isinstance(found, list) else []


def _keep(
    rows: Sequence[dict[str, Any]], change: Callable[[dict[str, Any]], dict[str, Any] | None]
) -> tuple[list[dict[str, Any]], dict[int, int]]:
    """Return the rows that are left, and the new place of each old one."""
    kept: list[dict[str, Any]] = []
    places: dict[int, int] = {}
    for n, row in enumerate(rows):
        changed = change(row)
        if changed is not None:
            places[n] = len(kept)
            kept.append(changed)
    return kept, places


def _move(row: Mapping[str, Any], find: Callable[[Any], int | None]) -> dict[str, Any] | None:
    node = find(row.get("node"))
    return {**row, "node": node} if node is not None else None


def _renumber(row: Mapping[str, Any], field: str, places: Mapping[int, int]) -> dict[str, Any] | None:
    named = row.get(field)
    kept = [places[n] for n in named if n in places] if isinstance(named, list) else []
    return {**row, field: kept} if kept else None
