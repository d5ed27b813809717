"""A project as plain data - dicts, lists, strings, numbers - and back. What project files and the journal
hold.

Fields at their default are left out, floats are rounded to microseconds, so that one edit changes few lines.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import fields
from functools import lru_cache
from typing import Any

import msgspec
import numpy as np

from metagraph.common.network_paths import close_path, recover_original_path
from metagraph.formats.clip_identity import remove_clip_identity
from metagraph.formats.project.contact_data import decode_contacts, encode_contacts
from metagraph.formats.project.fields import (
    LARGEST,
    Data,
    DataError,
    as_plain,
    decode_joint_weights,
    encode_joint_weights,
    fill_fields,
    get,
    is_too_large,
    list_changed_fields,
    read_floats,
    read_items,
    read_texts,
    refuse_unknown_fields,
    require_one_of,
    round_number,
)
from metagraph.formats.project.manual_data import decode_manual, make_manual_data
from metagraph.formats.project.text import as_text
from metagraph.formats.takes import REPAIRS
from metagraph.graph.backdrop import Backdrop
from metagraph.graph.clip_mark import ClipMark
from metagraph.graph.conversation.model import AUTO, Conversation, Segment, Side, Word
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
from metagraph.graph.parameter import CharacterParameter
from metagraph.graph.prop import Prop
from metagraph.graph.requests import explain_invalid_ask
from metagraph.graph.timeline import Timeline
from metagraph.graph.touch import Touch
from metagraph.graph.words import LASTING_MODES, MODES
from metagraph.motion.contact_hold import Contact
from metagraph.motion.joint_map import JointMap
from metagraph.motion.retime import LONGEST, MOST, SPEEDS, Hold, Retime
from metagraph.motion.skeleton import Skeleton

FORMAT = 2  # of the project file; older ones are upgraded when read


def encode_action(action: Action) -> Data:
    """Return an action; its timing's fields stand beside its own. The layer is said by where it is."""
    out = {
        **list_changed_fields(action, ("timing", "layer", "joint_weights", "contacts")),
        **list_changed_fields(action.timing),
    }
    out |= encode_joint_weights(action.joint_weights)
    if action.contacts:
        out["contacts"] = encode_contacts(action.contacts)
    return out


_CONTACT = ("upper", "lower", "hand", "to", "first", "last")


def make_clip_data(entry: ClipEntry) -> Data:
    """Return a clip as the project file has it, without its motion."""
    out = list_changed_fields(entry, ("motion", "source", "digest", "retime"))
    out["path"] = recover_original_path(entry.path)
    if entry.retime.speed != 1.0:
        out["speed"] = as_plain(entry.retime.speed)
    if entry.retime.contacts:
        out["contacts"] = [{n: as_plain(getattr(c, n)) for n in _CONTACT} for c in entry.retime.contacts]
    if entry.retime.holds:
        out["holds"] = [{"at": as_plain(h.at), "seconds": as_plain(h.seconds)} for h in entry.retime.holds]
    if entry.digest:
        out["sha256"] = entry.digest
    return out


def encode_skeleton(skeleton: Skeleton) -> list[Data]:
    """Return one dict a joint: name, parent (its name), at (local rest translation, metres), turn (local rest
    rotation, xyzw).

    These numbers are not rounded: skeletons are compared to 0.1 mm, and a rounded one may fall on the other
    side.
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


def encode_stance(stance: Stance) -> Data:
    return {"id": stance.id, "name": stance.name}


def encode_weights(graph: MetaGraph) -> Data:
    return {p: round_number(graph.weights[p]) for p in PARTS if p in graph.weights}


def to_data(project: Project) -> Data:
    """Return the whole project; inverse of `from_data` except for the motion of clips and what lies below a
    microsecond.

    Raises DataError when a number is not finite.
    """
    layers: Data = {}
    for layer in LAYERS:
        graph = project.graphs[layer]
        layers[layer] = {
            "start": graph.start,
            "weights": encode_weights(graph),
            "stances": [encode_stance(s) for s in graph.stances.values()],
            "actions": [encode_action(a) for a in graph.actions.values()],
        }
    return {
        "metagraph": FORMAT,
        "name": project.name,
        "character": as_plain(project.character),
        **({"hidden": list(project.hidden)} if project.hidden else {}),
        **({"language": project.language} if project.language != AUTO else {}),
        "base": list_changed_fields(project.base),
        "settings": list_changed_fields(project.settings),
        "roles": dict(sorted(project.roles.items())),
        "parts": dict(sorted(project.parts.items())),
        "clips": [make_clip_data(entry) for entry in project.clips.values()],
        "layers": layers,
        "markov": {
            layer: encode_markov(project.markov[layer]) for layer in LAYERS if layer in project.markov
        },
        **{key: data for key in STRUCTS if (data := encode_struct(getattr(project, key)))},
        **(
            {"manual": {x: make_manual_data(project.manual[x]) for x in LAYERS if x in project.manual}}
            if project.manual
            else {}
        ),
        "skeleton": encode_skeleton(project.skeleton) if project.skeleton is not None else [],
    }


def encode_markov(model: Markov) -> Data:
    """Return a model; a state's tags stand behind it: "both gesture positive"."""
    return {
        **list_changed_fields(model, ("layer", "states", "matrix", "tags")),
        "states": [f"{limb} {kind} {model.tag(n)}".rstrip() for n, (limb, kind) in enumerate(model.states)],
        "matrix": [[_whole(p) for p in row] for row in model.matrix],
    }


# What the life layers, asks and performances are made of describes itself; written and read by type.
STRUCTS: dict[str, Any] = {
    "life": Life,
    "face": Face,
    "points": dict[str, Point],
    "props": dict[str, Prop],
    "lines": dict[str, Line],
    "performances": dict[str, Performance],
    "conversations": dict[str, Conversation],
    "timelines": dict[str, Timeline],
    "tiers": dict[str, str],
    "labels": dict[str, str],
    "notes": dict[str, str],
    "marks": dict[str, ClipMark],
    "joint_maps": dict[str, JointMap],
    "touch": Touch,
    "parameters": dict[str, CharacterParameter],
    "backdrop": Backdrop,
}


def encode_struct(value: Any) -> Any:
    """Return what one of `STRUCTS` holds, fields at their default left out. It is not to be changed in
    place.
    """
    if isinstance(value, Mapping) and any(isinstance(v, Conversation) for v in value.values()):
        return {key: _conversation_data(v) for key, v in value.items()}
    return _rounded(msgspec.to_builtins(value))


def _conversation_data(conversation: Conversation) -> Data:
    """Return a conversation; what most edits leave as it was, thousands of words of each side, is not worked
    out again.
    """
    short = tuple(msgspec.structs.replace(side, words=(), segments=()) for side in conversation.sides)
    out: Data = _rounded(msgspec.to_builtins(msgspec.structs.replace(conversation, sides=short)))
    for n, side in enumerate(conversation.sides):
        rows = {"words": side.words, "segments": side.segments}
        data = {**out["sides"][n], **{name: _rows_data(some) for name, some in rows.items() if some}}
        out["sides"][n] = {name: data[name] for name in Side.__struct_fields__ if name in data}
    return out


@lru_cache(maxsize=64)
def _rows_data(rows: tuple[Word | Segment, ...]) -> list[Data]:
    return [_rounded(row) for row in msgspec.to_builtins(rows)]


def _rounded(value: Any) -> Any:
    if isinstance(value, dict):
        return {k: _rounded(v) for k, v in value.items()}
    return [_rounded(v) for v in value] if isinstance(value, list | tuple) else as_plain(value)


def decode_struct(data: Any, kind: Any, where: str) -> Any:
    """Return one of `STRUCTS` from data, its numbers rounded as they are written. Raises DataError."""
    try:
        return msgspec.convert(_rounded(data), kind)
    except msgspec.ValidationError as error:
        field, _, rest = explain_invalid_ask(error).rpartition(": ")
        raise DataError(f"{where}.{field}" if field else where, rest) from None
    except (ValueError, TypeError, RecursionError):
        words = f"should be a number from {-LARGEST:g} to {LARGEST:g}"
        raise DataError(is_too_large(data, where) or where, words) from None


# --- reading


def _closed(name: str | None) -> str | None:
    return close_path(name) if name else name


def _with_closed_paths(value: Any) -> Any:
    """Return lines, props, conversations and a backdrop without paths that are not to be opened; anything
    else as it is.
    """
    if isinstance(value, Backdrop):
        return msgspec.structs.replace(value, path=_closed(value.path) or "")
    if not isinstance(value, Mapping):
        return value
    return {k: _with_closed(v) if isinstance(v, Line | Prop | Conversation) else v for k, v in value.items()}


def _with_closed(value: Line | Prop | Conversation) -> Line | Prop | Conversation:
    if isinstance(value, Prop):
        return msgspec.structs.replace(value, path=close_path(value.path))
    if isinstance(value, Conversation):
        return msgspec.structs.replace(value, sides=tuple(map(_with_closed_side, value.sides)))
    return msgspec.structs.replace(value, audio=_closed(value.audio), phones=_closed(value.phones))


def _with_closed_side(side: Side) -> Side:
    audio, project, character = map(_closed, (side.audio, side.project, side.character))
    return msgspec.structs.replace(side, audio=audio, project=project, character=character)


_ACTION_FIELDS = ({f.name for f in fields(Action)} | {f.name for f in fields(Timing)}) - {"layer", "timing"}
_CLIP_FIELDS = ({f.name for f in fields(ClipEntry)} | {"sha256", "speed", "holds", "contacts"}) - {
    "motion",
    "source",
    "digest",
    "retime",
}
# next_id: a counter that files of format 1 and their journals have; ids need none any more.
_PROJECT_FIELDS = ({f.name for f in fields(Project)} | {"metagraph", "layers", "next_id"}) - {
    "graphs",
    "voices",
}


def decode_action(data: Data, layer: Layer, where: str) -> Action:
    refuse_unknown_fields(data, _ACTION_FIELDS, where)
    values = fill_fields(Action, data, where, ("timing", "layer", "joint_weights", "contacts"))
    for key in ("id", "clip", "kind", "stance", "name"):
        if key not in values:
            raise DataError(f"{where}.{key}", "is missing")
    require_one_of(values["kind"], KINDS, f"{where}.kind")
    require_one_of(values.get("limb", "both"), LIMBS, f"{where}.limb")
    contacts = decode_contacts(data, where)
    timing, weights = Timing(**fill_fields(Timing, data, where)), decode_joint_weights(data, where)
    return Action(layer=layer, timing=timing, contacts=contacts, joint_weights=weights, **values)


def _clip_from(data: Data, where: str) -> ClipEntry:
    refuse_unknown_fields(data, _CLIP_FIELDS, where)
    values = fill_fields(ClipEntry, data, where, ("motion", "source", "digest", "retime"))
    for key in ("name", "path"):
        if key not in values:
            raise DataError(f"{where}.{key}", "is missing")
    values["path"] = close_path(values["path"])
    for name in values.get("as_is", ()):
        require_one_of(name, REPAIRS, f"{where}.as_is")
    return ClipEntry(digest=get(data, "sha256", str, where, ""), retime=_retime_from(data, where), **values)


def _retime_from(data: Data, where: str) -> Retime:
    speed = get(data, "speed", float, where, 1.0)
    low, high = SPEEDS
    if not low <= speed <= high:
        raise DataError(f"{where}.speed", f"should be between {low:g} and {high:g}, found {speed:g}")
    holds = []
    for n, item in enumerate(get(data, "holds", list, where, ())):
        place = f"{where}.holds[{n}]"
        at, seconds = get(item, "at", float, place), get(item, "seconds", float, place)
        refuse_unknown_fields(item, ("at", "seconds"), place)
        if not 0 <= at <= 1e5:
            raise DataError(f"{place}.at", f"should be 0 or more, found {at:g}")
        if not 0 < seconds <= LONGEST:
            raise DataError(f"{place}.seconds", f"should be above 0 and up to {LONGEST:g}, found {seconds:g}")
        holds.append(Hold(at, seconds))
    if len(holds) > MOST or len({h.at for h in holds}) < len(holds):
        raise DataError(f"{where}.holds", f"should be at most {MOST}, at different moments")
    return Retime(speed, tuple(sorted(holds, key=lambda h: h.at)), tuple(_contacts_from(data, where)))


def _contacts_from(data: Data, where: str) -> Iterator[Contact]:
    for n, item in enumerate(get(data, "contacts", list, where, ())):
        place = f"{where}.contacts[{n}]"
        upper, lower, hand, to = (get(item, name, str, place) for name in _CONTACT[:4])
        first, last = (get(item, name, float, place) for name in _CONTACT[4:])
        refuse_unknown_fields(item, _CONTACT, place)
        if not 0 <= first < last <= 1e5:
            raise DataError(f"{place}.first", f"should be 0 or more and before last, found {first:g}")
        yield Contact(upper, lower, hand, to, first, last)


def decode_skeleton(joints: list[Any], where: str = "skeleton") -> Skeleton | None:
    """Return the skeleton of `encode_skeleton`, None for an empty list."""
    if not joints:
        return None
    names, parents, at, turn = [], [], [], []
    places: dict[str, int] = {}
    for n, joint in enumerate(joints):
        place = f"{where}[{n}]"
        name = get(joint, "name", str, place)
        refuse_unknown_fields(joint, ("name", "parent", "at", "turn"), place)
        parent = get(joint, "parent", str, place, None)
        if parent is not None and parent not in places:
            raise DataError(f"{place}.parent", f"'{parent}' does not come before joint '{name}'")
        if name in places:
            raise DataError(f"{place}.name", f"'{name}' is used twice")
        places[name] = n
        names.append(name)
        parents.append(-1 if parent is None else places[parent])
        at.append(read_floats(get(joint, "at", list, place), 3, f"{place}.at", 1e6))
        turn.append(
            read_floats(get(joint, "turn", list, place, [0.0, 0.0, 0.0, 1.0]), 4, f"{place}.turn", 2.0)
        )
        if not 0.9 < math.hypot(*turn[-1]) < 1.1:
            raise DataError(f"{place}.turn", "should be a quaternion of length 1")
    try:
        return Skeleton(tuple(names), np.array(parents), np.array(turn), np.array(at))
    except ValueError as error:
        raise DataError(where, str(error)) from None


def _graph_from(
    layer: Layer, data: Any, clips: Mapping[str, ClipEntry], stance_ids: set[str], action_ids: set[str]
) -> MetaGraph:
    where = f"layers.{layer}"
    start = get(data, "start", str, where, None)
    refuse_unknown_fields(data, ("start", "weights", "stances", "actions"), where)
    stances: dict[str, Stance] = {}
    for place, item in read_items(data, "stances", where, stance_ids):
        refuse_unknown_fields(item, ("id", "name"), place)
        stances[item["id"]] = Stance(item["id"], layer, get(item, "name", str, place))
    actions = {
        item["id"]: decode_action(remove_clip_identity(item, clips), layer, place)
        for place, item in read_items(data, "actions", where, action_ids)
    }
    weights = get(data, "weights", dict, where, {})
    for part in weights:
        require_one_of(part, PARTS, f"{where}.weights")
        get(weights, part, float, f"{where}.weights")
    return MetaGraph(layer, stances, actions, start, {p: float(w) for p, w in weights.items()})


def from_data(data: Any, notes: list[str] | None = None) -> Project:
    """Return the project, its clips without motion. Raises DataError naming the first field that is wrong.

    notes: where given, a joint map that is wrong is left out, and said there: nothing but its clips depends
    on it.
    """
    if not isinstance(data, Mapping) or "metagraph" not in data:
        raise DataError("metagraph", "is missing: this is not a Metagraph project")
    data = dict(as_text(data))
    refuse_unknown_fields(data, _PROJECT_FIELDS, "")
    clips = {item["id"]: _clip_from(item, where) for where, item in read_items(data, "clips", "", set())}
    layers = get(data, "layers", dict, "", {})
    refuse_unknown_fields(layers, LAYERS, "layers")
    stance_ids: set[str] = set()
    action_ids: set[str] = set()
    graphs = {
        layer: _graph_from(layer, get(layers, layer, dict, "layers", {}), clips, stance_ids, action_ids)
        for layer in LAYERS
    }
    machines = get(data, "manual", dict, "", {})
    refuse_unknown_fields(machines, LAYERS, "manual")
    manual_ids: set[str] = set()
    manual = {
        x: decode_manual(x, get(machines, x, dict, "manual"), manual_ids) for x in LAYERS if x in machines
    }
    parts, roles = get(data, "parts", dict, "", {}), get(data, "roles", dict, "", {})
    for joint, part in parts.items():
        require_one_of(part, PARTS, f"parts.{joint}")
    models = get(data, "markov", dict, "", {})
    refuse_unknown_fields(models, LAYERS, "markov")
    base, settings = get(data, "base", dict, "", {}), get(data, "settings", dict, "", {})
    refuse_unknown_fields(base, [f.name for f in fields(BasePose)], "base")
    refuse_unknown_fields(settings, [f.name for f in fields(Settings)], "settings")
    return Project(
        name=get(data, "name", str, "", "untitled"),
        skeleton=decode_skeleton(get(data, "skeleton", list, "", [])),
        clips=clips,
        graphs=graphs,
        base=BasePose(**fill_fields(BasePose, base, "base")),
        roles={r: get(roles, r, str, "roles") for r in roles},
        parts=dict(parts),
        markov={
            layer: decode_markov(layer, models[layer], f"markov.{layer}")
            for layer in LAYERS
            if layer in models
        },
        settings=Settings(**fill_fields(Settings, settings, "settings")),
        **{
            key: _with_closed_paths(decode_struct(data[key], kind, key))
            for key, kind in STRUCTS.items()
            if data.get(key) is not None and key != "joint_maps"
        },
        joint_maps=_joint_maps_from(data, notes),
        manual=manual,
        character=_closed(get(data, "character", str, "", None)),
        hidden=read_texts(data, "hidden"),
        language=get(data, "language", str, "", AUTO),
    )


def _joint_maps_from(data: Data, notes: list[str] | None) -> dict[str, JointMap]:
    out: dict[str, JointMap] = {}
    try:
        maps = get(data, "joint_maps", dict, "", {})
        for key in maps:
            try:
                out[key] = decode_struct(maps[key], JointMap, f"joint_maps.{key}")
            except DataError as error:
                if notes is None:
                    raise
                notes.append(_left_out(error))
    except DataError as error:
        if notes is None:
            raise
        notes.append(_left_out(error))
    return out


def _left_out(error: DataError) -> str:
    return (
        f"{error.where} {error}; that joint map is left out. Import its clips again to map their joints anew."
    )


def decode_markov(layer: Layer, data: Any, where: str) -> Markov:
    states, tags = [], []
    for text in get(data, "states", list, where):
        limb, kind, tag = (*(text.split(" ", 2) if isinstance(text, str) else ()), "", "", "")[:3]
        states.append(
            (require_one_of(limb, LIMBS, f"{where}.states"), require_one_of(kind, KINDS, f"{where}.states"))
        )
        tags.append(tag)
    refuse_unknown_fields(data, [f.name for f in fields(Markov) if f.name not in ("layer", "tags")], where)
    rows = get(data, "matrix", list, where)
    if not rows or len(rows) != len(states):
        raise DataError(f"{where}.matrix", f"should have {max(1, len(states))} rows, one for each state")
    matrix = tuple(
        tuple(read_floats(row if isinstance(row, list) else [], len(states), f"{where}.matrix[{n}]"))
        for n, row in enumerate(rows)
    )
    for n, row in enumerate(matrix):
        if min(row) < 0 or not 0.99 < sum(row) < 1.01:
            raise DataError(f"{where}.matrix[{n}]", "should be probabilities that sum to 1")
    lengths = [
        read_floats(x if isinstance(x, list) else [], 2, f"{where}.lengths", 1e6)
        for x in get(data, "lengths", list, where, [])
    ]
    if lengths and len(lengths) != len(states):
        raise DataError(f"{where}.lengths", f"should be {len(states)} pairs of seconds, one for each state")
    if any(mean < 1e-3 or deviation < 0 for mean, deviation in lengths):
        raise DataError(f"{where}.lengths", "should be means above 0 and deviations of 0 or more")
    modes = [
        read_floats(x if isinstance(x, list) else [], 3, f"{where}.modes")
        for x in get(data, "modes", list, where, [])
    ]
    if modes and (
        not len(LASTING_MODES) <= len(modes) <= len(MODES)
        or not all(0 <= x <= 1 for row in modes for x in row)
    ):
        rows = f"{len(LASTING_MODES)} to {len(MODES)} rows ({', '.join(MODES)})"
        raise DataError(f"{where}.modes", f"should be {rows} of three shares from 0 to 1")
    more = fill_fields(Markov, data, where, ("layer", "states", "matrix", "tags", "lengths", "modes"))
    return Markov(
        layer,
        tuple(states),
        matrix,
        **more,
        tags=tuple(tags) if any(tags) else (),
        lengths=tuple((a, b) for a, b in lengths),
        modes=tuple((a, b, c) for a, b, c in modes),
    )
