"""Labels of actions as a file: what another program says of clips, for a project that takes them in.

A JSON object `{"labels": 1, "actions": [...]}`. Each row names a clip, among those that come in with it or
the project's, and says what it is; what a row does not say stays as it is, or as a dropped clip gets it.
`action` is the id of one that is there already and is changed; without it that is the one of the same name,
kind, layer and stance, and if there is none a new one is placed. Stances are called by their names, and made
where a layer has none of that name.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
from msgspec import UNSET, Meta, Struct, UnsetType

from metagraph.common.budgets import TEXT_FILE
from metagraph.common.files import read_file
from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.graph.edit_error import EditError
from metagraph.graph.edits import add_stance, find_added_actions, move_actions, place_clips, update_actions
from metagraph.graph.model import Kind, Layer, Limb, Project

Name = Annotated[str, Meta(min_length=1, max_length=300)]
Seconds = Annotated[float, Meta(ge=0, le=1e6)]
Maybe = Seconds | None | UnsetType  # null: as it is found; left out: as it is


class LabelRow(Struct, forbid_unknown_fields=True, omit_defaults=True):
    """What one action is. clip: a name. Times are seconds of the clip; `end` null is the clip's own."""

    clip: Name
    action: str | None = None
    name: Name | None = None
    kind: Kind | None = None
    layer: Layer | None = None
    stance: Name | None = None
    end_stance: Name | None = None
    limb: Limb | None = None
    tags: list[Name] | None = None
    likelihood: Annotated[float, Meta(gt=0, le=1e6)] | None = None
    cooldown: Seconds | None = None
    start: Seconds | None = None
    end: Maybe = UNSET
    blend_in: Seconds | None = None
    blend_out: Seconds | None = None
    loop: bool | None = None
    repeat: Seconds | None = None
    earliest_exit: Maybe = UNSET
    stroke: Maybe = UNSET
    ready: Maybe = UNSET
    stroke_end: Maybe = UNSET
    relax: Maybe = UNSET


class LabelFile(Struct, forbid_unknown_fields=True):
    labels: Literal[1]
    actions: list[LabelRow]


_OWN = ("name", "limb", "likelihood", "cooldown")
_TIMES = ("start", "blend_in", "blend_out", "loop", "repeat")
_MAYBE = ("end", "earliest_exit", "stroke", "ready", "stroke_end", "relax")


def read_labels(path: Path) -> tuple[LabelRow, ...]:
    """Read a file of labels. Raises FileError."""
    try:
        return tuple(msgspec.json.decode(read_file(path, TEXT_FILE), type=LabelFile).actions)
    except (msgspec.MsgspecError, UnicodeDecodeError) as error:
        message, _, where = str(error).partition(" - at ")
        raise FileError(
            path,
            message[:1].lower() + message[1:],
            where.strip("`") or "its content",
            phrase("docs/animators/label-files.md describes what such a file contains."),
        ) from None


def apply_labels(
    project: Project, rows: Iterable[LabelRow], fresh: Mapping[str, str]
) -> tuple[Project, int, tuple[str, ...]]:
    """Return a project with rows applied, how many were, and why others were not, in words.

    fresh: name in its file -> id, of the clips that came in with the rows.
    """
    done, left = 0, []
    for row in rows:
        try:
            project = _applied(project, row, fresh)
            done += 1
        except EditError as error:
            left.append(f"{row.name or row.clip}: {error}")
    return project, done, tuple(left)


def _applied(project: Project, row: LabelRow, fresh: Mapping[str, str]) -> Project:
    clip = fresh.get(row.clip) or next((e.id for e in project.clips.values() if e.name == row.clip), None)
    known = project.action(row.action) if row.action is not None else None
    if row.action is not None and known is None:
        raise EditError(phrase("this project has no action '{action}'", action=row.action))
    if clip is None:
        raise EditError(phrase("there is no clip '{clip}'", clip=row.clip))
    layer = row.layer or (known.layer if known is not None else None)
    kind = row.kind or (known.kind if known is not None else None)
    if layer is None or kind is None:
        raise EditError(phrase("a new action needs a kind and a layer"))
    stance = known.stance if known is not None and row.stance is None and layer == known.layer else None
    end = known.end_stance if known is not None and row.end_stance is None and layer == known.layer else None
    if row.stance is not None:
        project, stance = _stance(project, layer, row.stance)
    if row.end_stance is not None:
        project, end = _stance(project, layer, row.end_stance)
    if stance is None:
        raise EditError(phrase("it does not name a stance of the layer {layer}", layer=phrase(layer)))
    if known is None:
        alike = project.graphs[layer].of(stance, kind)
        known = next((a for a in alike if a.name == (row.name or row.clip)), None)
    ident = known.id if known is not None else ""
    if known is None:
        before, project = project, place_clips(project, [clip], layer, kind, stance, end)
        ident = find_added_actions(before, project)[0]
    elif (layer, kind, stance, end) != (known.layer, known.kind, known.stance, known.end_stance):
        project = move_actions(project, [ident], kind, stance, end)
    return update_actions(project, [ident], clip=clip, **_fields(row))


def _stance(project: Project, layer: Layer, name: str) -> tuple[Project, str]:
    """Return the stance of a name in a layer, and the project that has it."""
    for _ in range(2):
        found = next((s.id for s in project.graphs[layer].stances.values() if s.name == name.strip()), None)
        if found is not None:
            return project, found
        project = add_stance(project, layer, name)
    raise EditError(phrase("'{name}' cannot be a stance's name", name=name))


def _fields(row: LabelRow) -> dict[str, Any]:
    own = {key: value for key in _OWN if (value := getattr(row, key)) is not None}
    if row.tags is not None:
        own["tags"] = tuple(dict.fromkeys(tag.strip() for tag in row.tags if tag.strip()))
    timing = {key: value for key in _TIMES if (value := getattr(row, key)) is not None}
    timing |= {key: value for key in _MAYBE if (value := getattr(row, key)) is not UNSET}
    return {**own, **({"timing": timing} if timing else {})}
