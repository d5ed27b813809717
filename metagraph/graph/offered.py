"""What may be asked of a character: as data to look things up in, and as tools for a language model."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from copy import deepcopy
from itertools import islice
from typing import Any, get_args

import msgspec

from metagraph.graph import anatomy
from metagraph.graph import requests as a
from metagraph.graph.model import LAYERS, Action, MetaGraph, Project
from metagraph.graph.parameter import describe_parameters
from metagraph.graph.repeating import seconds_played
from metagraph.graph.words import MODES

EVERYTHING: Mapping[str, int] = {}
CHOICES = 500  # values a tool lists at most; with more of them any text may be given
ENGINES = tuple(word for word in a.WORDS if word != "bml")  # what runtimes in engines understand
_NEVER = ("do", "told")  # fields of requests that are no matter of an agent's
_AFTER = {"type": "number", "minimum": 0, "maximum": 1e6, "description": "seconds from now; wins over `at`"}


def list_offered_requests(
    project: Project, words: Sequence[str] = ENGINES, most: Mapping[str, int] = EVERYTHING
) -> dict[str, Any]:
    """Return what may be asked for, as plain data. words: of requests that are understood. most: of actions
    of a layer, lines and points that are reported.

    `project`, its name; `words`; `modes`; `joints` (name, parent, part); `layers`: for each its `start`, its
    `stances` (id, name), its `actions` but loops of stances (id, name, kind, stance, seconds; `to`, `limb`
    and `tags` if there are any) and `tags` with the number of actions; `lines` (id, text), by id; `points` by
    name, metres; `parameters`, if there are any, see `describe_parameters`.
    """
    skeleton, parts = project.skeleton, anatomy.project_parts(project) if project.skeleton is not None else ()
    return {
        "project": project.name,
        "words": list(words),
        "modes": list(MODES),
        "joints": [] if skeleton is None else [
            {"name": name, "parent": None if parent < 0 else skeleton.names[parent], "part": part}
            for name, parent, part in zip(skeleton.names, skeleton.parents.tolist(), parts, strict=True)
        ],
        "layers": {layer: _layer(project, project.graphs[layer], most.get("actions")) for layer in LAYERS},
        "lines": [
            {"id": ident, "text": project.lines[ident].text}
            for ident in sorted(project.lines)[: most.get("lines")]
        ],
        "points": {name: list(point) for name, point in islice(project.points.items(), most.get("points"))},
        **({"parameters": describe_parameters(project.parameters)} if project.parameters else {}),
    }  # fmt: skip


def _layer(project: Project, graph: MetaGraph, most: int | None) -> dict[str, Any]:
    actions = (x for x in graph.actions.values() if x.kind != "stance")
    return {
        "start": graph.start,
        "stances": [{"id": s.id, "name": s.name} for s in graph.stances.values()],
        "actions": [_action(project, action) for action in islice(actions, most)],
        "tags": dict(Counter(tag for action in graph.actions.values() for tag in action.tags)),
    }


def _action(project: Project, action: Action) -> dict[str, Any]:
    start, end = project.span(action)
    out: dict[str, Any] = {
        "id": action.id,
        "name": action.name,
        "kind": action.kind,
        "stance": action.stance,
        "seconds": round(seconds_played(action.kind, action.timing, start, end), 6),
    }
    if action.kind == "transition":
        out["to"] = action.end_stance
    if action.limb != "both":
        out["limb"] = action.limb
    if action.tags:
        out["tags"] = list(action.tags)
    return out


def list_tools(project: Project, words: Sequence[str] = ENGINES) -> list[dict[str, Any]]:
    """Return a tool for each word of requests: `name`, the word; `description`; `input_schema`, a JSON Schema
    (draft 2020-12) of the request's other fields, in which tags, stances, actions, lines and points are those
    of this character. What a model gives for tool `gesture` is asked for as `{"do": "gesture", **given}`.
    """
    known = {str(kind.__struct_config__.tag): kind for kind in get_args(a.AnyRequest)}
    return [_tool(project, word, known[word]) for word in words]


def _tool(project: Project, word: str, kind: type[a.Request]) -> dict[str, Any]:
    schema = deepcopy(msgspec.json.schema(kind)["$defs"][kind.__name__])
    fields = {name: field for name, field in schema["properties"].items() if name not in _NEVER}
    fields["after"] = _AFTER
    for name, field in fields.items():
        _choose(project, word, name, field)
    return {
        "name": word,
        "description": " ".join(schema["description"].split()),
        "input_schema": {
            "type": "object",
            "properties": fields,
            "required": [name for name in schema["required"] if name not in _NEVER],
            "additionalProperties": False,
        },
    }


def _choose(project: Project, word: str, name: str, field: dict[str, Any]) -> None:
    """Narrow a field of a tool to what this character has."""
    choices: dict[str, Callable[[], Iterable[str]]] = {
        "tags": lambda: _tags(project, word),
        "stance": lambda: (s.name for graph in project.graphs.values() for s in graph.stances.values()),
        "action": lambda: (action.name for action in project.actions() if action.kind != "stance"),
        "line": lambda: iter(project.lines),
    }
    found = _few(choices[name]()) if name in choices else []
    if name == "to":
        names = dict.fromkeys(("user", "ahead", *project.points))
        field["anyOf"][0]["description"] = f"a name: {', '.join(names)}"
    elif found and name == "tags":
        field["items"] = {"enum": found}
    elif found and name == "line":
        field.pop("anyOf")
        field["enum"] = [*found, None]
        field["description"] = "; ".join(f"{ident}: {line.text}" for ident, line in project.lines.items())
    elif found:
        field["enum"] = found


def _tags(project: Project, word: str) -> Iterable[str]:
    """Return the tags of what a word asks for, those of most actions first."""
    kind = word if word in ("gesture", "fidget") else "gesture"
    graphs = [project.graphs["head"]] if word in ("nod", "shake") else project.graphs.values()
    actions = (x for graph in graphs for x in graph.actions.values() if x.kind == kind)
    return (tag for tag, _ in Counter(tag for action in actions for tag in action.tags).most_common())


def _few(values: Iterable[str]) -> list[str]:
    """Return values once each, none where they are too many to be listed."""
    found = list(dict.fromkeys(values))
    return found if len(found) <= CHOICES else []
