"""A project as plain data - dicts, lists, strings, numbers - and back. What project files and the journal hold.

Fields at their default are left out, floats are rounded to microseconds, so that one edit changes few lines.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import MISSING, fields
from functools import cache
from typing import Any

import msgspec
import numpy as np

from metagraph.graph.asks import words_of
from metagraph.graph.model import (
    KINDS,
    LAYERS,
    LIMBS,
    PARTS,
    Action,
    BasePose,
    ClipEntry,
    Face,
    Layer,
    Life,
    Line,
    Markov,
    MetaGraph,
    Performance,
    Point,
    Project,
    Settings,
    Stance,
    Timing,
)
from metagraph.motion.skeleton import Skeleton

FORMAT = 1  # of the project file; older ones are upgraded when read
Data = dict[str, Any]


LARGEST = 1e15  # no number in a project is larger; up to here whole numbers are exact


class DataError(ValueError):
    """The data is not a project: `where` names the field, the message says what is wrong with it."""

    def __init__(self, where: str, message: str) -> None:
        self.where = where
        super().__init__(message)


def _number(value: float) -> float | int:
    """Return a number rounded to six decimals, or to six digits where nothing else would be left. Raises ValueError."""
    if not abs(value) <= LARGEST:
        raise ValueError(f"{value!r} is not a number that can be saved")
    rounded = round(float(value), 6) or float(f"{value:.6g}")
    return int(rounded) if rounded == int(rounded) else rounded


def _plain(value: Any) -> Any:
    if isinstance(value, bool) or value is None or isinstance(value, str):
        return value
    if isinstance(value, int) and abs(value) <= LARGEST:
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
            try:
                out[f.name] = _plain(v)
            except ValueError as error:
                raise DataError(f"{type(value).__name__.lower()} {getattr(value, 'name', '')!r}, {f.name}", str(error)) from None
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
    """Return one dict a joint: name, parent (its name), at (local rest translation, metres), turn (local rest rotation, xyzw).

    These numbers are not rounded: skeletons are compared to 0.1 mm, and a rounded one may fall on the other side.
    """
    out: list[Data] = []
    for i, name in enumerate(skeleton.names):
        joint: Data = {"name": name}
        if skeleton.parents[i] >= 0:
            joint["parent"] = skeleton.names[skeleton.parents[i]]
        joint["at"] = [_whole(x) for x in skeleton.rest_translations[i]]
        if skeleton.rest_rotations[i].tolist() != [0, 0, 0, 1]:
            joint["turn"] = [_whole(x) for x in skeleton.rest_rotations[i]]
        out.append(joint)
    return out


def _whole(value: float) -> float | int:
    return int(value) if value == int(value) else float(value)


def stance_data(stance: Stance) -> Data:
    return {"id": stance.id, "name": stance.name}


def weights_data(graph: MetaGraph) -> Data:
    return {p: _number(graph.weights[p]) for p in PARTS if p in graph.weights}


def to_data(project: Project) -> Data:
    """Return the whole project; inverse of `from_data` but for the motion of clips and what lies below a microsecond.

    Raises DataError when a number is not finite.
    """
    layers: Data = {}
    for layer in LAYERS:
        graph = project.graphs[layer]
        layers[layer] = {
            "start": graph.start,
            "weights": weights_data(graph),
            "stances": [stance_data(s) for s in graph.stances.values()],
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
        **{key: data for key in STRUCTS if (data := struct_data(getattr(project, key)))},
        "skeleton": skeleton_data(project.skeleton) if project.skeleton is not None else [],
    }


def markov_data(model: Markov) -> Data:
    """Return a model; a state's tags stand behind it: "both gesture positive"."""
    return {
        **_sparse(model, ("layer", "states", "matrix", "tags")),
        "states": [f"{limb} {kind} {model.tag(n)}".rstrip() for n, (limb, kind) in enumerate(model.states)],
        "matrix": [[_whole(p) for p in row] for row in model.matrix],
    }


# What the life layers, asks and performances are made of describes itself; written and read by type.
STRUCTS: dict[str, Any] = {
    "life": Life, "face": Face, "points": dict[str, Point], "lines": dict[str, Line], "performances": dict[str, Performance],
    "tiers": dict[str, str], "labels": dict[str, str],
}  # fmt: skip


def struct_data(value: Any) -> Any:
    """Return what one of `STRUCTS` holds, fields at their default left out."""
    return _rounded(msgspec.to_builtins(value))


def _rounded(value: Any) -> Any:
    if isinstance(value, dict):
        return {k: _rounded(v) for k, v in value.items()}
    return [_rounded(v) for v in value] if isinstance(value, list | tuple) else _plain(value)


def struct_from(data: Any, kind: Any, where: str) -> Any:
    """Return one of `STRUCTS` from data. Raises DataError."""
    try:
        return msgspec.convert(data, kind)
    except msgspec.ValidationError as error:
        field, _, rest = words_of(error).rpartition(": ")
        raise DataError(f"{where}.{field}" if field else where, rest) from None


# --- reading ---------------------------------------------------------------------------------------------------------

_WORDS = {str: "text", int: "a whole number", float: "a number", bool: "true or false", list: "a list", dict: "fields"}


def _named(value: Any) -> str:
    if value is None:
        return "nothing"
    if isinstance(value, list | dict):
        return "a list" if isinstance(value, list) else "fields"
    if isinstance(value, int) and abs(value) > LARGEST:
        return "a huge number"
    text = repr(value)
    return text if len(text) <= 40 else text[:37] + "..."


def _get(data: Any, key: str, kind: Any, where: str, default: Any = MISSING) -> Any:
    """Return a field checked for its type, `default` where it is missing or empty; numbers are finite and not beyond `LARGEST`."""
    if not isinstance(data, Mapping):
        raise DataError(where, f"should be fields, found {_named(data)}")
    value = data.get(key, MISSING)
    place = f"{where}.{key}" if where else key
    if value is MISSING and default is MISSING:
        raise DataError(place, "is missing")
    if default is not MISSING and (value is None or value is MISSING):
        return default
    wrong = isinstance(value, bool) and kind is not bool
    if wrong or not isinstance(value, (int, float) if kind is float else kind):
        raise DataError(place, f"should be {_WORDS[kind]}, found {_named(value)}")
    if kind in (int, float) and not abs(value) <= LARGEST:
        raise DataError(place, f"should be a finite number, found {_named(value)}")
    if isinstance(value, dict) and not all(isinstance(k, str) for k in value):
        raise DataError(place, "should be fields with names")
    return float(value) if kind is float else value


def _known(data: Data, allowed: Collection[str], where: str) -> None:
    """Refuse fields nobody reads: what a slip of the pen was meant to say would be lost."""
    for key in data:
        if key not in allowed:
            from difflib import get_close_matches

            near = get_close_matches(str(key), allowed, 1)
            hint = f"; did you mean '{near[0]}'?" if near else ""
            raise DataError(f"{where}.{key}" if where else str(key), f"is not a field known here{hint}")


def _one_of(value: Any, allowed: tuple[str, ...], where: str) -> Any:
    if value not in allowed:
        raise DataError(where, f"should be one of {', '.join(allowed)}, found {_named(value)}")
    return value


_RANGES = {  # field -> least and greatest value of what no check of the graph looks at
    "fps": (1e-3, 1e6), "frames": (0, 1e9), "take": (0, 1e6), "frame": (0, 1e9), "seed": (0, 0xFFFFFFFF), "alpha": (0, LARGEST),
    "shortest": (0, LARGEST), "wait": (0, LARGEST), "gap": (1e-3, LARGEST), "positive": (0, 1), "negative": (0, 1),
    "memory": (0, 600), "rest": (0, 600), "lookahead": (0, 10), "cooldown": (0, LARGEST),
}  # fmt: skip


def _fill(cls: Any, data: Data, where: str, skip: tuple[str, ...] = ()) -> dict[str, Any]:
    """Return a dataclass's simple fields read from data, those that are there."""
    out: dict[str, Any] = {}
    for name, kind in _kinds(cls).items():
        if name in skip or name not in data:
            continue
        if kind is tuple:
            items = _get(data, name, list, where)
            if not all(isinstance(x, str) for x in items):
                raise DataError(f"{where}.{name}", "should be a list of texts")
            out[name] = tuple(items)
        elif isinstance(kind, tuple):
            out[name] = _get(data, name, kind[0], where, None)
        else:
            out[name] = _get(data, name, kind, where)
            if name in _RANGES and not _RANGES[name][0] <= out[name] <= _RANGES[name][1]:
                low, high = _RANGES[name]
                limit = f"{low:g} or more" if high in (1e9, LARGEST) else f"between {low:g} and {high:.10g}"
                raise DataError(f"{where}.{name}", f"should be {limit}, found {_named(data[name])}")
    return out


@cache
def _kinds(cls: Any) -> dict[str, Any]:
    """Return field -> type; (type,) where None is a value, too; `tuple` for a list of texts."""
    out: dict[str, Any] = {}
    for f in fields(cls):
        text = str(f.type)
        plain = {"bool": bool, "int": int, "float": float}.get(text.split(" ")[0], str)
        out[f.name] = tuple if text.startswith("tuple[str") else (plain,) if "None" in text else plain
    return out


def _items(data: Data, key: str, where: str, seen: set[str]) -> list[tuple[str, Data]]:
    """Return a list of dicts with ids, each with words for where it stands; `seen` are ids already taken."""
    out: list[tuple[str, Data]] = []
    for n, item in enumerate(_get(data, key, list, where, ())):
        place = f"{where}.{key}[{n}]" if where else f"{key}[{n}]"
        ident = _get(item, "id", str, place)
        if not ident:
            raise DataError(f"{place}.id", "should not be empty")
        if ident in seen:
            raise DataError(f"{place}.id", f"'{ident}' is used twice")
        seen.add(ident)
        out.append((place, item))
    return out


_ACTION_FIELDS = ({f.name for f in fields(Action)} | {f.name for f in fields(Timing)}) - {"layer", "timing"}
_CLIP_FIELDS = ({f.name for f in fields(ClipEntry)} | {"sha256"}) - {"motion", "digest"}
_PROJECT_FIELDS = ({f.name for f in fields(Project)} | {"metagraph", "layers"}) - {"graphs", "voices"}


def action_from(data: Data, layer: Layer, where: str) -> Action:
    _known(data, _ACTION_FIELDS, where)
    values = _fill(Action, data, where, ("timing", "layer"))
    for key in ("id", "clip", "kind", "stance", "name"):
        if key not in values:
            raise DataError(f"{where}.{key}", "is missing")
    _one_of(values["kind"], KINDS, f"{where}.kind")
    _one_of(values.get("limb", "both"), LIMBS, f"{where}.limb")
    return Action(layer=layer, timing=Timing(**_fill(Timing, data, where)), **values)


def _clip_from(data: Data, where: str) -> ClipEntry:
    _known(data, _CLIP_FIELDS, where)
    values = _fill(ClipEntry, data, where, ("motion", "digest"))
    for key in ("name", "path"):
        if key not in values:
            raise DataError(f"{where}.{key}", "is missing")
    return ClipEntry(digest=_get(data, "sha256", str, where, ""), **values)


def skeleton_from(joints: list[Any], where: str = "skeleton") -> Skeleton | None:
    """Return the skeleton of `skeleton_data`, None for an empty list."""
    if not joints:
        return None
    names, parents, at, turn = [], [], [], []
    places: dict[str, int] = {}
    for n, joint in enumerate(joints):
        place = f"{where}[{n}]"
        name = _get(joint, "name", str, place)
        _known(joint, ("name", "parent", "at", "turn"), place)
        parent = _get(joint, "parent", str, place, None)
        if parent is not None and parent not in places:
            raise DataError(f"{place}.parent", f"'{parent}' does not come before joint '{name}'")
        if name in places:
            raise DataError(f"{place}.name", f"'{name}' is used twice")
        places[name] = n
        names.append(name)
        parents.append(-1 if parent is None else places[parent])
        at.append(_floats(_get(joint, "at", list, place), 3, f"{place}.at", 1e6))
        turn.append(_floats(_get(joint, "turn", list, place, [0.0, 0.0, 0.0, 1.0]), 4, f"{place}.turn", 2.0))
        if not 0.9 < math.hypot(*turn[-1]) < 1.1:
            raise DataError(f"{place}.turn", "should be a quaternion of length 1")
    try:
        return Skeleton(tuple(names), np.array(parents), np.array(turn), np.array(at))
    except ValueError as error:
        raise DataError(where, str(error)) from None


def _floats(values: list[Any], count: int, where: str, largest: float = LARGEST) -> list[float]:
    numbers = [x for x in values if isinstance(x, int | float) and not isinstance(x, bool) and abs(x) <= largest]
    if not len(numbers) == len(values) == count:
        raise DataError(where, f"should be {count} numbers")
    return [float(x) for x in values]


def _graph_from(layer: Layer, data: Any, stance_ids: set[str], action_ids: set[str]) -> MetaGraph:
    where = f"layers.{layer}"
    start = _get(data, "start", str, where, None)
    _known(data, ("start", "weights", "stances", "actions"), where)
    stances: dict[str, Stance] = {}
    for place, item in _items(data, "stances", where, stance_ids):
        _known(item, ("id", "name"), place)
        stances[item["id"]] = Stance(item["id"], layer, _get(item, "name", str, place))
    actions = {item["id"]: action_from(item, layer, place) for place, item in _items(data, "actions", where, action_ids)}
    weights = _get(data, "weights", dict, where, {})
    for part in weights:
        _one_of(part, PARTS, f"{where}.weights")
        _get(weights, part, float, f"{where}.weights")
    return MetaGraph(layer, stances, actions, start, {p: float(w) for p, w in weights.items()})


def from_data(data: Any) -> Project:
    """Return the project, its clips without motion. Raises DataError naming the first field that is wrong."""
    if not isinstance(data, Mapping) or "metagraph" not in data:
        raise DataError("metagraph", "is missing: this is not a Metagraph project")
    data = dict(data)
    _known(data, _PROJECT_FIELDS, "")
    clips = {item["id"]: _clip_from(item, where) for where, item in _items(data, "clips", "", set())}
    layers = _get(data, "layers", dict, "", {})
    _known(layers, LAYERS, "layers")
    stance_ids: set[str] = set()
    action_ids: set[str] = set()
    graphs = {layer: _graph_from(layer, _get(layers, layer, dict, "layers", {}), stance_ids, action_ids) for layer in LAYERS}
    parts, roles = _get(data, "parts", dict, "", {}), _get(data, "roles", dict, "", {})
    for joint, part in parts.items():
        _one_of(part, PARTS, f"parts.{joint}")
    models = _get(data, "markov", dict, "", {})
    _known(models, LAYERS, "markov")
    base, settings = _get(data, "base", dict, "", {}), _get(data, "settings", dict, "", {})
    _known(base, [f.name for f in fields(BasePose)], "base")
    _known(settings, [f.name for f in fields(Settings)], "settings")
    return Project(
        name=_get(data, "name", str, "", "untitled"),
        skeleton=skeleton_from(_get(data, "skeleton", list, "", [])),
        clips=clips,
        graphs=graphs,
        base=BasePose(**_fill(BasePose, base, "base")),
        roles={r: _get(roles, r, str, "roles") for r in roles},
        parts=dict(parts),
        markov={layer: markov_from(layer, models[layer], f"markov.{layer}") for layer in LAYERS if layer in models},
        settings=Settings(**_fill(Settings, settings, "settings")),
        **{key: struct_from(data[key], kind, key) for key, kind in STRUCTS.items() if data.get(key) is not None},
        character=_get(data, "character", str, "", None),
        next_id=max(_get(data, "next_id", int, "", 1), above(*clips, *stance_ids, *action_ids)),
    )


def above(*idents: str) -> int:
    """Return a number above every id's, so that an id is never made twice, whoever made it."""
    numbers = (i[1:] for i in idents)
    return 1 + max((int(n) for n in numbers if n.isascii() and n.isdigit() and len(n) < 15), default=0)


def markov_from(layer: Layer, data: Any, where: str) -> Markov:
    states, tags = [], []
    for text in _get(data, "states", list, where):
        limb, kind, tag = (*(text.split(" ", 2) if isinstance(text, str) else ()), "", "", "")[:3]
        states.append((_one_of(limb, LIMBS, f"{where}.states"), _one_of(kind, KINDS, f"{where}.states")))
        tags.append(tag)
    _known(data, [f.name for f in fields(Markov) if f.name not in ("layer", "tags")], where)
    rows = _get(data, "matrix", list, where)
    if not rows or len(rows) != len(states):
        raise DataError(f"{where}.matrix", f"should have {max(1, len(states))} rows, one for each state")
    matrix = tuple(tuple(_floats(row if isinstance(row, list) else [], len(states), f"{where}.matrix[{n}]")) for n, row in enumerate(rows))
    for n, row in enumerate(matrix):
        if min(row) < 0 or not 0.99 < sum(row) < 1.01:
            raise DataError(f"{where}.matrix[{n}]", "should be probabilities that sum to 1")
    lengths = [_floats(x if isinstance(x, list) else [], 2, f"{where}.lengths", 1e6) for x in _get(data, "lengths", list, where, [])]
    if lengths and len(lengths) != len(states):
        raise DataError(f"{where}.lengths", f"should be {len(states)} pairs of seconds, one for each state")
    if any(mean < 1e-3 or deviation < 0 for mean, deviation in lengths):
        raise DataError(f"{where}.lengths", "should be means above 0 and deviations of 0 or more")
    more = _fill(Markov, data, where, ("layer", "states", "matrix", "tags", "lengths"))
    return Markov(layer, tuple(states), matrix, **more, tags=tuple(tags) if any(tags) else (), lengths=tuple((a, b) for a, b in lengths))
