"""A project as plain data - dicts, lists, strings, numbers - and back. What project files and the journal hold.

Fields at their default are left out, floats are rounded to microseconds, so that one edit changes few lines.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import MISSING, fields
from typing import Any

import numpy as np

from metagraph.graph.model import (
    KINDS,
    LAYERS,
    LIMBS,
    PARTS,
    Action,
    BasePose,
    ClipEntry,
    Layer,
    Markov,
    MetaGraph,
    Project,
    Settings,
    Stance,
    Timing,
)
from metagraph.motion.skeleton import Skeleton

FORMAT = 1  # of the project file; older ones are upgraded when read
Data = dict[str, Any]


class DataError(ValueError):
    """The data is not a project: `where` names the field, the message says what is wrong with it."""

    def __init__(self, where: str, message: str) -> None:
        self.where = where
        super().__init__(message)


def _number(value: float) -> float | int:
    rounded = round(float(value), 6)
    return int(rounded) if rounded == int(rounded) and abs(rounded) < 1e15 else rounded


def _plain(value: Any) -> Any:
    if isinstance(value, bool) or value is None or isinstance(value, str):
        return value
    if isinstance(value, int | float):
        return _number(value)
    if isinstance(value, tuple | list):
        return [_plain(v) for v in value]
    raise TypeError(f"{type(value).__name__} has no place in a project file")


def _sparse(value: Any, skip: tuple[str, ...] = ()) -> Data:
    """Return a dataclass's fields that differ from their defaults."""
    out: Data = {}
    for f in fields(value):
        if f.name in skip:
            continue
        v = getattr(value, f.name)
        if f.default is MISSING or v != f.default:
            out[f.name] = _plain(v)
    return out


def action_data(action: Action) -> Data:
    """Return an action; its timing's fields stand beside its own. The layer is said by where it is."""
    return {**_sparse(action, ("timing", "layer")), **_sparse(action.timing)}


def clip_data(entry: ClipEntry) -> Data:
    out = _sparse(entry, ("motion", "digest"))
    if entry.digest:
        out["sha256"] = entry.digest
    return out


def skeleton_data(skeleton: Skeleton) -> list[Data]:
    """Return one dict a joint: name, parent (its name), at (local rest translation, metres), turn (local rest rotation, xyzw)."""
    out: list[Data] = []
    for i, name in enumerate(skeleton.names):
        joint: Data = {"name": name}
        if skeleton.parents[i] >= 0:
            joint["parent"] = skeleton.names[skeleton.parents[i]]
        joint["at"] = [_number(x) for x in skeleton.rest_translations[i]]
        if abs(skeleton.rest_rotations[i][3]) < 1 - 1e-12:
            joint["turn"] = [round(float(x), 9) for x in skeleton.rest_rotations[i]]
        out.append(joint)
    return out


def to_data(project: Project) -> Data:
    """Return the whole project; inverse of `from_data` but for the motion of clips."""
    layers: Data = {}
    for layer in LAYERS:
        graph = project.graphs[layer]
        layers[layer] = {
            "start": graph.start,
            "weights": {p: _number(graph.weights[p]) for p in PARTS if p in graph.weights},
            "stances": [{"id": s.id, "name": s.name} for s in graph.stances.values()],
            "actions": [action_data(a) for a in graph.actions.values()],
        }
    return {
        "metagraph": FORMAT,
        "name": project.name,
        "character": project.character,
        "next_id": project.next_id,
        "base": _sparse(project.base),
        "settings": _sparse(project.settings),
        "roles": dict(sorted(project.roles.items())),
        "parts": dict(sorted(project.parts.items())),
        "clips": [clip_data(entry) for entry in project.clips.values()],
        "layers": layers,
        "markov": {layer: markov_data(project.markov[layer]) for layer in LAYERS if layer in project.markov},
        "skeleton": skeleton_data(project.skeleton) if project.skeleton is not None else [],
    }


def markov_data(model: Markov) -> Data:
    return {
        **_sparse(model, ("layer", "states", "matrix")),
        "states": [f"{limb} {kind}" for limb, kind in model.states],
        "matrix": [[round(float(p), 9) for p in row] for row in model.matrix],
    }


# --- reading ---------------------------------------------------------------------------------------------------------


def _get(data: Any, key: str, kind: Any, where: str, default: Any = MISSING) -> Any:
    """Return a field checked for its type; numbers must be finite."""
    if not isinstance(data, Mapping):
        raise DataError(where, f"expected fields, found {_named(data)}")
    value = data.get(key, default)
    place = f"{where}.{key}" if where else key
    if value is MISSING:
        raise DataError(place, "is missing")
    if value is None and (default is None or (default is MISSING and kind is dict)):
        return default if default is not MISSING else {}
    if kind is float and isinstance(value, int) and not isinstance(value, bool):
        value = float(value)
    if not isinstance(value, kind) or (isinstance(value, bool) and kind is not bool):
        raise DataError(place, f"should be {_WORDS[kind]}, found {_named(value)}")
    if kind is float and not math.isfinite(value):
        raise DataError(place, "should be a finite number")
    return value


_WORDS = {str: "text", int: "a whole number", float: "a number", bool: "true or false", list: "a list", dict: "fields"}


def _named(value: Any) -> str:
    text = repr(value)
    return "nothing" if value is None else text if len(text) <= 40 else text[:37] + "..."


def _one_of(value: Any, allowed: tuple[str, ...], where: str) -> Any:
    if value not in allowed:
        raise DataError(where, f"should be one of {', '.join(allowed)}, found {_named(value)}")
    return value


def _fill(cls: Any, data: Data, where: str, skip: tuple[str, ...] = ()) -> dict[str, Any]:
    """Return a dataclass's simple fields read from data, those that are there."""
    out: dict[str, Any] = {}
    for f in fields(cls):
        if f.name in skip or f.name not in data:
            continue
        text = str(f.type)
        value = data[f.name]
        if value is None and "None" in text:
            out[f.name] = None
        elif text.startswith("tuple[str"):
            items = _get(data, f.name, list, where)
            if not all(isinstance(x, str) for x in items):
                raise DataError(f"{where}.{f.name}", "should be a list of texts")
            out[f.name] = tuple(items)
        else:
            kind = {"bool": bool, "int": int, "float": float}.get(text.split(" ")[0], str)
            out[f.name] = _get(data, f.name, kind, where)
    return out


def _items(data: Data, key: str, where: str) -> list[tuple[str, Data]]:
    """Return a list of dicts with ids, each with words for where it stands; ids must be unique."""
    out: list[tuple[str, Data]] = []
    seen: set[str] = set()
    for n, item in enumerate(_get(data, key, list, where, []) or []):
        place = f"{where}.{key}[{n}]" if where else f"{key}[{n}]"
        ident = _get(item, "id", str, place)
        if ident in seen:
            raise DataError(place, f"id '{ident}' is used twice")
        seen.add(ident)
        out.append((f"{place} '{ident}'", item))
    return out


def action_from(data: Data, layer: Layer, where: str) -> Action:
    values = _fill(Action, data, where, ("timing", "layer"))
    for key in ("id", "clip", "kind", "stance", "name"):
        if key not in values:
            raise DataError(f"{where}.{key}", "is missing")
    _one_of(values["kind"], KINDS, f"{where}.kind")
    _one_of(values.get("limb", "both"), LIMBS, f"{where}.limb")
    return Action(layer=layer, timing=Timing(**_fill(Timing, data, where)), **values)


def skeleton_from(joints: list[Any], where: str = "skeleton") -> Skeleton | None:
    if not joints:
        return None
    names, parents, at, turn = [], [], [], []
    places: dict[str, int] = {}
    for n, joint in enumerate(joints):
        place = f"{where}[{n}]"
        name = _get(joint, "name", str, place)
        parent = _get(joint, "parent", str, place, None)
        if parent is not None and parent not in places:
            raise DataError(place, f"parent '{parent}' does not come before joint '{name}'")
        places[name] = n
        names.append(name)
        parents.append(-1 if parent is None else places[parent])
        at.append(_floats(_get(joint, "at", list, place), 3, f"{place}.at"))
        turn.append(_floats(_get(joint, "turn", list, place, [0.0, 0.0, 0.0, 1.0]), 4, f"{place}.turn"))
    try:
        return Skeleton(tuple(names), np.array(parents), np.array(turn), np.array(at))
    except ValueError as error:
        raise DataError(where, str(error)) from None


def _floats(values: list[Any], count: int, where: str) -> list[float]:
    if len(values) != count or not all(isinstance(x, int | float) and not isinstance(x, bool) and math.isfinite(x) for x in values):
        raise DataError(where, f"should be {count} numbers")
    return [float(x) for x in values]


def from_data(data: Any) -> Project:
    """Return the project, its clips without motion. Raises DataError naming the first field that is wrong."""
    if not isinstance(data, Mapping) or "metagraph" not in data:
        raise DataError("metagraph", "is missing: this is not a Metagraph project")
    data = dict(data)
    clips: dict[str, ClipEntry] = {}
    for where, item in _items(data, "clips", ""):
        values = _fill(ClipEntry, item, where, ("motion", "digest"))
        for key in ("name", "path"):
            if key not in values:
                raise DataError(f"{where}.{key}", "is missing")
        if values.get("fps", 30.0) <= 0:
            raise DataError(f"{where}.fps", "should be above 0")
        clips[values["id"]] = ClipEntry(digest=_get(item, "sha256", str, where, ""), **values)
    graphs: dict[Layer, MetaGraph] = {}
    layers = _get(data, "layers", dict, "", {})
    for layer in LAYERS:
        content = _get(layers, layer, dict, "layers", {})
        where = f"layers.{layer}"
        stances = {
            item["id"]: Stance(item["id"], layer, _get(item, "name", str, place)) for place, item in _items(content, "stances", where)
        }
        actions = {item["id"]: action_from(item, layer, place) for place, item in _items(content, "actions", where)}
        weights = _get(content, "weights", dict, where, {})
        for part in weights:
            _one_of(part, PARTS, f"{where}.weights")
            _get(weights, part, float, f"{where}.weights")
        start = _get(content, "start", str, where, None)
        graphs[layer] = MetaGraph(layer, stances, actions, start, {p: float(w) for p, w in weights.items()})
    parts = _get(data, "parts", dict, "", {})
    for joint, part in parts.items():
        _one_of(part, PARTS, f"parts.{joint}")
    markov = {
        _one_of(layer, LAYERS, "markov"): markov_from(layer, model, f"markov.{layer}")
        for layer, model in _get(data, "markov", dict, "", {}).items()
    }
    base = _get(data, "base", dict, "", {})
    settings = _get(data, "settings", dict, "", {})
    return Project(
        name=_get(data, "name", str, "", "untitled"),
        skeleton=skeleton_from(_get(data, "skeleton", list, "", [])),
        clips=clips,
        graphs=graphs,
        base=BasePose(**_fill(BasePose, base, "base")),
        roles={r: _get(data["roles"], r, str, "roles") for r in _get(data, "roles", dict, "", {})},
        parts=dict(parts),
        markov=markov,
        settings=Settings(**_fill(Settings, settings, "settings")),
        character=_get(data, "character", str, "", None),
        next_id=max(_get(data, "next_id", int, "", 1), _above(clips, graphs)),
    )


def _above(clips: Mapping[str, ClipEntry], graphs: Mapping[Layer, MetaGraph]) -> int:
    """Return a number above every id's, so that ids made by hand are never made again."""
    idents = [*clips, *(i for g in graphs.values() for i in (*g.stances, *g.actions))]
    return 1 + max((int(i[1:]) for i in idents if i[1:].isdigit()), default=0)


def markov_from(layer: Layer, data: Any, where: str) -> Markov:
    states = []
    for text in _get(data, "states", list, where):
        limb, _, kind = str(text).partition(" ")
        states.append((_one_of(limb, LIMBS, f"{where}.states"), _one_of(kind, KINDS, f"{where}.states")))
    rows = _get(data, "matrix", list, where)
    if len(rows) != len(states):
        raise DataError(f"{where}.matrix", f"should have {len(states)} rows")
    matrix = tuple(tuple(_floats(row if isinstance(row, list) else [], len(states), f"{where}.matrix[{n}]")) for n, row in enumerate(rows))
    for n, row in enumerate(matrix):
        if min(row) < 0 or not 0.99 < sum(row) < 1.01:
            raise DataError(f"{where}.matrix[{n}]", "should be probabilities that sum to 1")
    return Markov(layer, tuple(states), matrix, **_fill(Markov, data, where, ("layer", "states", "matrix")))
