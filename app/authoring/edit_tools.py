"""Tools that change actions and stances: timing, likelihood, names, tags, where they belong."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any

from msgspec import UNSET, Meta, Struct, UnsetType

from app.authoring.finding import find_actions, find_clips, find_named_stance
from app.authoring.tool import AuthorError, AuthorTool, EditReport, ToolOutcome, ToolWork
from app.translation import tr, tr_noop
from metagraph.graph import edits
from metagraph.graph.check import check_project
from metagraph.graph.editing.merging_stances import merge_stances
from metagraph.graph.model import Action, Kind, Layer, Limb, Project, Stance

Name = Annotated[str, Meta(min_length=1, max_length=300)]
Seconds = Annotated[float, Meta(ge=0, le=1e6)]
Maybe = Seconds | None | UnsetType  # null: as it is found; left out: as it is
_OWN = ("name", "limb", "likelihood", "cooldown", "prominence")
_TIMES = ("start", "blend_in", "blend_out", "loop", "repeat")
_MAYBE = ("end", "earliest_exit", "stroke", "ready", "stroke_end", "relax")


class EditAction(Struct, forbid_unknown_fields=True, omit_defaults=True):
    """actions: by id or name; all get what is given, the rest stays as it is. Times are seconds of the clip:
    `start` and `end` of what plays, `stroke` the most telling moment, `earliest_exit` from when on it may be
    left; null is as it is found, for `end` the clip's end. repeat: seconds for which it repeats, 0 for once.
    likelihood: relative to others, above 0. cooldown: seconds in which it is not drawn again. prominence: how
    much it stands out, 0 to 1. stance, end_stance: by id or name. tags: all of them, in place of those there.
    """

    actions: Annotated[list[str], Meta(min_length=1)]
    name: Name | None = None
    kind: Kind | None = None
    stance: Name | None = None
    end_stance: Name | None = None
    limb: Limb | None = None
    tags: list[Name] | None = None
    likelihood: Annotated[float, Meta(gt=0, le=1e6)] | None = None
    cooldown: Seconds | None = None
    prominence: Annotated[float, Meta(ge=0, le=1)] | None = None
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


def _edit_action(work: ToolWork, given: EditAction) -> ToolOutcome:
    """Change actions. Raises AuthorError for what would make an error of them."""
    before, found = work.project, find_actions(work.project, given.actions)
    after = _move(before, found, given)
    idents = [action.id for action in found]
    after = edits.update_actions(after, idents, **_fields(given))
    _refuse_errors(before, after, idents)
    return ToolOutcome(
        EditReport(), after, tr("Edit '{name}'", name=found[0].name) if len(found) == 1 else ""
    )


def _move(project: Project, found: Sequence[Action], given: EditAction) -> Project:
    """Return the project with actions on the kind and stances that are wanted."""
    for action in found:
        layer: Layer = action.layer
        kind = given.kind or action.kind
        stance = (
            find_named_stance(project, given.stance, layer).id if given.stance is not None else action.stance
        )
        end = action.end_stance
        if given.end_stance is not None:
            end = find_named_stance(project, given.end_stance, layer).id
            if kind != "transition":
                raise AuthorError(f"end_stance: '{action.name}' is a {kind}; only transitions end elsewhere")
        if (kind, stance, end) != (action.kind, action.stance, action.end_stance):
            project = edits.move_actions(project, [action.id], kind, stance, end)
    return project


def _fields(given: EditAction) -> dict[str, Any]:
    own = {key: value for key in _OWN if (value := getattr(given, key)) is not None}
    if given.tags is not None:
        own["tags"] = tuple(dict.fromkeys(tag.strip() for tag in given.tags if tag.strip()))
    timing = {key: value for key in _TIMES if (value := getattr(given, key)) is not None}
    timing |= {key: value for key in _MAYBE if (value := getattr(given, key)) is not UNSET}
    return {**own, "timing": timing} if timing else own


def _refuse_errors(before: Project, after: Project, idents: Sequence[str]) -> None:
    """Raise AuthorError if actions have errors after an edit that they did not have before it."""
    if before is after:
        return
    known = {(p.code, p.action) for p in check_project(before) if p.severity == "error"}
    made = [
        p
        for p in check_project(after)
        if p.severity == "error" and p.action in idents and (p.code, p.action) not in known
    ]
    if made:
        raise AuthorError("; ".join(f"{p.message}. {p.remedy}" for p in made[:3]))


class EditStance(Struct, forbid_unknown_fields=True, omit_defaults=True):
    """stance: by id or name; layer: where several layers have one of that name. name: a new one. start:
    performances of its layer begin in it. merge_into: its actions go to this stance, and it is gone. remove:
    it and its actions go; their clips stay.
    """

    stance: str
    layer: Layer | None = None
    name: Name | None = None
    start: bool = False
    merge_into: str | None = None
    remove: bool = False


def _edit_stance(work: ToolWork, given: EditStance) -> ToolOutcome:
    """Rename, merge or remove a stance, or begin in it."""
    project, stance = work.project, find_named_stance(work.project, given.stance, given.layer)
    if given.remove and (given.name or given.start or given.merge_into):
        raise AuthorError("remove: a stance that is removed cannot be changed, too")
    if given.remove:
        return ToolOutcome(
            EditReport(), edits.remove_stance(project, stance.id), tr("Remove '{name}'", name=stance.name)
        )
    if given.name is not None:
        project = _rename(project, stance, given.name)
    if given.start:
        project = edits.set_start_stance(project, stance.id)
    if given.merge_into is not None:
        project = merge_stances(
            project, stance.id, find_named_stance(project, given.merge_into, stance.layer).id
        )
    return ToolOutcome(EditReport(), project, tr("Edit stance '{name}'", name=stance.name))


def _rename(project: Project, stance: Stance, name: str) -> Project:
    others = [s for s in project.graphs[stance.layer].stances.values() if s.id != stance.id]
    if any(s.name == name.strip() for s in others):
        raise AuthorError(f"name: {stance.layer} has another stance '{name}'; merge_into merges the two")
    return edits.rename_stance(project, stance.id, name)


class RenameClip(Struct, forbid_unknown_fields=True):
    """clip: by id or name. name: its new name, also of its actions that have the old one."""

    clip: str
    name: Name


def _rename_clip(work: ToolWork, given: RenameClip) -> ToolOutcome:
    """Give a clip another name."""
    (clip,) = find_clips(work.project, [given.clip])
    old = work.project.clips[clip].name
    project = edits.rename_clip(work.project, clip, given.name)
    new = project.clips[clip].name
    same = {a.id: {"name": new} for a in project.uses.get(clip, ()) if a.name == old}
    return ToolOutcome(EditReport(), edits.update_each(project, same), tr("Rename '{name}'", name=old))


TOOLS = (
    AuthorTool(
        "edit_action",
        "Change the timing, likelihood, name, tags, kind or stance of actions.",
        EditAction,
        EditReport,
        _edit_action,
        "edits",
        tr_noop("Edit actions"),
    ),
    AuthorTool(
        "edit_stance",
        "Rename a stance, merge it into another, remove it, or let performances begin in it.",
        EditStance,
        EditReport,
        _edit_stance,
        "edits",
        tr_noop("Edit stance"),
    ),
    AuthorTool(
        "rename_clip",
        "Give a clip and its actions a name that says what it is.",
        RenameClip,
        EditReport,
        _rename_clip,
        "edits",
        tr_noop("Rename clip"),
    ),
)
