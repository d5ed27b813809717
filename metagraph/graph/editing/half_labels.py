"""Edits of labels that are known in part: a clip may have a kind before its stance is known, or a stance
before its kind. It is placed in the graph as soon as the rest is known.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from msgspec import structs

from metagraph.common.wording import phrase
from metagraph.graph import edits
from metagraph.graph.clip_mark import BARE, ClipMark, HalfLabel
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing.marks import mark_of
from metagraph.graph.model import LAYERS, Kind, Layer, Project

UNKNOWN = HalfLabel()
_Place = tuple[Layer, Kind, str, str | None]  # layer, kind, the ids of the stances it begins and ends in


def find_half_label(project: Project, clip: str) -> HalfLabel:
    """Return what is known of a clip without an action; nothing is known of one that has actions."""
    if clip in project.uses:
        return UNKNOWN
    return mark_of(project, clip).label or UNKNOWN


def has_half_label(project: Project, clip: str) -> bool:
    """Return whether a clip waits for the rest of its label."""
    return find_half_label(project, clip) != UNKNOWN


def set_half_labels(project: Project, labels: Mapping[str, Mapping[str, Any]]) -> Project:
    """Set fields of `HalfLabel` for clips that have no action, by clip id, and place those that are complete
    now. Clips that are gone or have an action stay as they are.

    A new stance that exists on another layer only makes the layer unknown. Raises EditError for a transition
    that would end where it begins.
    """
    marks = dict(project.marks)
    for clip, fields in labels.items():
        if clip not in project.clips or clip in project.uses:
            continue
        known = structs.replace(find_half_label(project, clip), **fields)
        if known.kind == "transition" and known.stance and known.stance == known.end_stance:
            raise EditError(phrase("a transition must end in another stance"))
        if known.layer and "layer" not in fields and "stance" in fields:
            layers = find_layers(project, known.stance)
            known = structs.replace(known, layer="") if layers and known.layer not in layers else known
        _put(marks, clip, known)
    return place_complete(_with_marks(project, marks))


def place_complete(project: Project) -> Project:
    """Place every clip whose label is complete: its kind and stance are known, and the end of a transition.
    Loops come first, since they make the stances that others wait for.
    """
    if all(found.label is None for found in project.marks.values()):
        return project
    marks = dict(project.marks)
    waiting: dict[str, HalfLabel] = {}
    for clip, found in project.marks.items():
        if found.label is not None and clip in project.uses:  # placed by other means
            _put(marks, clip, UNKNOWN)
        elif found.label is not None and clip in project.clips:
            waiting[clip] = found.label
    for loops in (True, False):
        groups: dict[_Place, list[str]] = {}
        for clip, known in waiting.items():
            if (known.kind == "stance") == loops:
                project, place = _find_place(project, clip, known)
                if place is not None:
                    groups.setdefault(place, []).append(clip)
        for (layer, kind, stance, end), clips in groups.items():
            before = project
            project = edits.place_clips(project, clips, layer, kind, stance, end)
            made = edits.find_added_actions(before, project)
            project = _with_waiting_fields(project, made, waiting)
            for clip in clips:
                _put(marks, clip, UNKNOWN)
    return _with_marks(project, marks)


def find_layers(project: Project, stance: str) -> tuple[Layer, ...]:
    """Return the layers that have a stance of a name."""
    return tuple(layer for layer in LAYERS if find_stance_named(project, layer, stance) is not None)


def find_stance_named(project: Project, layer: Layer, name: str) -> str | None:
    """Return the id of a layer's stance by its name, without case; None if there is none."""
    wanted = name.strip().casefold()
    stances = project.graphs[layer].stances.values()
    return next((s.id for s in stances if s.name.casefold() == wanted), None)


def follow_stance_name(project: Project, layer: Layer, old: str, new: str) -> Project:
    """Follow a stance's new name in the labels that wait for it."""
    marks = dict(project.marks)
    for clip, found in project.marks.items():
        known = found.label
        if known is not None and known.layer in ("", layer) and old in (known.stance, known.end_stance):
            stance = new if known.stance == old else known.stance
            end = new if known.end_stance == old else known.end_stance
            _put(marks, clip, structs.replace(known, stance=stance, end_stance=end))
    return _with_marks(project, marks)


def _put(marks: dict[str, ClipMark], clip: str, known: HalfLabel) -> None:
    found = structs.replace(marks.get(clip, BARE), label=None if known == UNKNOWN else known)
    if found == BARE:
        marks.pop(clip, None)
    else:
        marks[clip] = found


def _with_marks(project: Project, marks: Mapping[str, ClipMark]) -> Project:
    return project if marks == project.marks else replace(project, marks=marks)


def _find_place(project: Project, clip: str, known: HalfLabel) -> tuple[Project, _Place | None]:
    """Return where a clip belongs, or None while something is missing; with the stance that it makes."""
    if not known.kind or not known.stance:
        return project, None
    layers = (known.layer,) if known.layer else find_layers(project, known.stance)
    if len(layers) != 1:
        return project, None
    layer: Layer = layers[0]
    stance = find_stance_named(project, layer, known.stance)
    end = find_stance_named(project, layer, known.end_stance) if known.kind == "transition" else None
    if edits.find_placing_refusal(project, [clip], layer, known.kind, stance, end) is not None:
        return project, None
    if stance is None:
        project = edits.add_stance(project, layer, known.stance)
        stance = find_stance_named(project, layer, known.stance)
    assert stance is not None
    return project, (layer, known.kind, stance, end)


def _with_waiting_fields(
    project: Project, made: tuple[str, ...], waiting: Mapping[str, HalfLabel]
) -> Project:
    """Give new actions the limb and the tags that their clips had."""
    changes: dict[str, dict[str, Any]] = {}
    for ident in made:
        action = project.action(ident)
        assert action is not None
        known = waiting[action.clip]
        fields: dict[str, Any] = {"tags": known.tags} if known.tags else {}
        if known.limb and action.layer == "arms" and action.kind != "stance":
            fields["limb"] = known.limb
        if fields:
            changes[ident] = fields
    return edits.update_each(project, changes) if changes else project
