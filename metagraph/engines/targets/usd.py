"""Universal Scene Description: the character with an animation for each clip, and the graph as properties.

Below `/Character/Graph` stands a prim for each layer, with its stances, actions and transitions; what the
JSON says of each is a property `metagraph:<field>` under the JSON's own name, and relationships lead from
actions to their clips and stances. The JSON itself lies beside, with the GLB, and the character names it.
"""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import msgspec

from metagraph.common.wording import phrase
from metagraph.engines.export import list_exported_clips
from metagraph.engines.targets.meshes import find_ordered_mesh
from metagraph.engines.targets.runtimes import write_with_sounds
from metagraph.engines.targets.target import ExportedFiles, ExportOrder, ExportTarget, Loss
from metagraph.formats.usd.usda import (
    Names,
    Prim,
    format_usda_number,
    format_usda_string,
    format_usda_strings,
)
from metagraph.formats.usd.writer import CHARACTER, find_clip_paths, keep_name, write_usd

GRAPH = f"{CHARACTER}/Graph"


def make_graph_prims(document: dict[str, Any]) -> Prim:
    """Return the graph of an export's JSON as prims."""
    places = find_clip_paths([clip["name"] for clip in document["clips"]])
    clips = {clip["id"]: places[clip["name"]] for clip in document["clips"]}
    out = Prim("Scope", "Graph")
    for layer in document["order"]:
        out.children.append(_layer(layer, document["layers"][layer], clips))
    return out


def _layer(layer: str, said: dict[str, Any], clips: dict[str, str]) -> Prim:
    where = f"{GRAPH}/{layer}"
    stances = _named("Stances", said["stances"])
    actions = _named("Actions", said["actions"])
    stance_at = _places(f"{where}/Stances", said["stances"], stances)
    action_at = _places(f"{where}/Actions", said["actions"], actions)
    for action, prim in zip(said["actions"], actions.children, strict=True):
        prim.properties += [
            *_relationship("clip", [clips.get(action["clip"])]),
            *_relationship("stance", [stance_at.get(action["stance"])]),
            *_relationship("end_stance", [stance_at.get(action["end_stance"])]),
        ]
    names, ways = Names(), Prim("Scope", "Transitions")
    called = {s["id"]: s["name"] for s in said["stances"]}
    for way in said["transitions"]:
        own = names.of(f"{called[way['from']]}_to_{called[way['to']]}")
        ends = _relationship("from", [stance_at[way["from"]]]) + _relationship("to", [stance_at[way["to"]]])
        taken = _relationship("actions", [action_at[ident] for ident in way["actions"]])
        ways.children.append(Prim("", own, [], ends + taken))
    rest = {k: v for k, v in said.items() if k not in ("stances", "actions", "transitions", "start")}
    own_properties = [*_relationship("start", [stance_at.get(said["start"])]), *_properties(rest)]
    return Prim("Scope", layer, [], own_properties, [stances, actions, ways])


def _named(scope: str, rows: list[dict[str, Any]]) -> Prim:
    """Return a prim for each row, called as it is."""
    names, out = Names(), Prim("Scope", scope)
    for row in rows:
        own = names.of(row["name"], ident=row["id"])
        shown = {k: v for k, v in row.items() if k not in ("clip", "stance", "end_stance")}
        out.children.append(Prim("", own, keep_name(row["name"], own), _properties(shown)))
    return out


def _places(where: str, rows: list[dict[str, Any]], scope: Prim) -> dict[str, str]:
    """Return where the prim of each row is, by the row's id."""
    return {row["id"]: f"{where}/{p.name}" for row, p in zip(rows, scope.children, strict=True)}


def _relationship(name: str, to: list[str | None]) -> list[str]:
    """Return a relationship to prims, nothing if one is missing."""
    if None in to or not to:
        return []
    ends = ", ".join(f"<{place}>" for place in to)
    return [f"custom rel metagraph:{name} = {ends if len(to) == 1 else f'[{ends}]'}"]


def _properties(said: dict[str, Any]) -> list[str]:
    """Return the fields of an object of JSON; what is nested deeper than a list is its JSON as a text."""
    out = []
    for key, value in said.items():
        if value is None or value in ([], {}):
            continue
        kind, shown = _value(value)
        out.append(f"custom {kind} metagraph:{key} = {shown}")
    return out


def _value(value: Any) -> tuple[str, str]:
    if isinstance(value, bool):
        return "bool", "true" if value else "false"
    if isinstance(value, int | float):
        return "double", format_usda_number(value)
    if isinstance(value, str):
        return "string", format_usda_string(value)
    if isinstance(value, list) and all(isinstance(v, str) for v in value):
        return "string[]", format_usda_strings(value)
    if isinstance(value, list) and all(isinstance(v, int | float) and not isinstance(v, bool) for v in value):
        return "double[]", f"[{', '.join(map(format_usda_number, value))}]"
    return "string", format_usda_string(json.dumps(value, ensure_ascii=False))


def write(order: ExportOrder) -> ExportedFiles:
    """Write JSON, GLB and sounds, and the stage with its textures."""
    made = write_with_sounds(
        replace(order, tell=lambda done, total, words: order.tell(done, total + 1, words))
    )
    document = msgspec.json.decode(made.files[0].read_bytes())
    project = order.project
    assert project.skeleton is not None
    body, _ = find_ordered_mesh(order)  # what there is to say of it is said already
    resting = document["layers"]["body"]
    first = next(
        (a["clip"] for a in resting["actions"] if a["kind"] == "stance" and a["stance"] == resting["start"]),
        None,
    )
    called = {clip["id"]: clip["name"] for clip in document["clips"]}
    files = write_usd(
        order.folder / f"{order.stem}.usda",
        project.skeleton,
        list_exported_clips(project),
        body,
        called.get(first),
        [make_graph_prims(document)],
        [
            "customData = {",
            "    dictionary metagraph = {",
            f"        string name = {format_usda_string(document['name'])}",
            f"        double version = {format_usda_number(document['metagraph'])}"
            if isinstance(document["metagraph"], int | float)
            else f"        string version = {format_usda_string(str(document['metagraph']))}",
            f"        asset export = @./{made.files[0].name}@",
            "    }",
            "}",
        ],
    )
    order.tell(4, 4, "done")
    return ExportedFiles((*files, *made.files), made.notes)


TARGETS = (
    ExportTarget(
        "usd",
        "USD (UsdSkel)",
        phrase(
            "a stage with skeleton, skinned mesh, blend shapes, an animation for each clip and the "
            "graph; plus JSON and GLB"
        ),
        write,
        (
            Loss(
                phrase(
                    "no planner: the stage contains the clips and the graph for other programs; only one "
                    "clip plays"
                )
            ),
            Loss(
                phrase(
                    "no life layers: the clips have no breathing, gaze, blinks or lip sync; a baked "
                    "performance has them"
                )
            ),
        ),
    ),
)
