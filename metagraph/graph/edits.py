"""Edit projects with pure functions, `Project -> Project`. Every change, from a drop to a script, ends here.

An edit that cannot be done raises EditError, whose message is for the user. The project is then unchanged.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from metagraph.common.wording import phrase
from metagraph.graph import ids
from metagraph.graph.clip_source import with_changed_file, with_source
from metagraph.graph.edit_error import EditError
from metagraph.graph.face.takes import FACE_TAKE, find_face_joints
from metagraph.graph.manual.machine import remove_clips_from_machines
from metagraph.graph.model import (
    PARTS,
    Action,
    BasePose,
    ClipEntry,
    Kind,
    Layer,
    Limb,
    Markov,
    Part,
    Project,
    Settings,
    Stance,
    Timing,
)
from metagraph.motion.clip import Clip
from metagraph.motion.features import measure_loop_error

SEAM = 0.01  # metres a loop may be open before its seam is blended
_LIMB_WORDS: tuple[tuple[Limb, str], ...] = (
    ("both", r"(?:bt|both|lr|2h|twohands?)"),
    ("left", r"(?:lf|lt|left|l)"),
    ("right", r"(?:rt|right|r)"),
)


def guess_limb(name: str) -> Limb:
    """Guess the limb from a clip's name: `_lf`, `_rt`, `_bt`, `Left`, `Right` and similar. Return "both" if
    the name does not say.
    """
    words = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()
    for limb, pattern in _LIMB_WORDS:
        if re.search(rf"(?:^|[^a-z]){pattern}(?:[^a-z]|$)", words):
            return limb
    return "both"


# --- clips


def add_clips(project: Project, loaded: Iterable[tuple[str, int, str, Clip]]) -> Project:
    """Add clips given as (path, take, digest, clip). A clip that the project has already (same path and take)
    is refreshed in place.

    If the project has no skeleton yet, it takes that of the first clip.
    """
    clips = dict(project.clips)
    known: dict[tuple[str, int], list[str]] = {}
    for entry in clips.values():
        known.setdefault((entry.path, entry.take), []).append(entry.id)
    skeleton = project.skeleton
    for path, take, digest, clip in loaded:
        if skeleton is None:
            skeleton = clip.skeleton
        there = known.get((path, take), [])
        if not there:
            there = [ids.make_id(project, "c", path, take, more=clips)]
            clips[there[0]] = ClipEntry(there[0], clip.name, path, take)
        for entry in [clips[i] for i in there]:
            entry = replace(entry, brought_from=clip.brought_from)
            clips[entry.id] = with_changed_file(entry, clip, digest)
    return replace(project, clips=clips, skeleton=skeleton)


def with_motions(project: Project, motions: Mapping[str, Clip]) -> Project:
    """Return the project with the motions of clips filled in, by clip id. What is saved does not change."""
    clips = {
        i: replace(with_source(e, motions[i]), frames=e.frames, fps=e.fps) if i in motions else e
        for i, e in project.clips.items()
    }
    return replace(project, clips=clips)


def rename_clip(project: Project, clip: str, name: str) -> Project:
    if clip not in project.clips:
        raise EditError(phrase("that clip is no longer in the project"))
    return replace(project, clips={**project.clips, clip: replace(project.clips[clip], name=_clean(name))})


def remove_clips(project: Project, clips: Collection[str]) -> Project:
    """Remove clips and the actions and states that use them. A base pose taken from one becomes the rest
    pose.
    """
    gone = [a.id for clip in clips for a in project.uses.get(clip, ())]
    project = remove_actions(project, gone)
    left = {i: e for i, e in project.clips.items() if i not in clips}
    base = BasePose() if project.base.clip in clips else project.base
    manual = remove_clips_from_machines(project.manual, clips)
    marks = {i: m for i, m in project.marks.items() if i in left} if project.marks else project.marks
    skeleton = project.skeleton if left else None
    return replace(project, clips=left, base=base, skeleton=skeleton, manual=manual, marks=marks)


# --- stances


def add_stance(project: Project, layer: Layer, name: str, clips: Sequence[str] = ()) -> Project:
    """Make a stance with `clips` as its loops. Performances start in the first stance of a layer."""
    graph = project.graphs[layer]
    name = find_free_name(_clean(name), {s.name for s in graph.stances.values()})
    stance = Stance(ids.make_id(project, "s", layer, name), layer, name)
    graph = graph.but(stances={**graph.stances, stance.id: stance}, start=graph.start or stance.id)
    project = project.with_graph(graph)
    return place_clips(project, clips, layer, "stance", stance.id) if clips else project


def rename_stance(project: Project, stance: str, name: str) -> Project:
    found = _stance(project, stance)
    graph = project.graphs[found.layer]
    return project.with_graph(graph.but(stances={**graph.stances, stance: replace(found, name=_clean(name))}))


def remove_stance(project: Project, stance: str) -> Project:
    """Remove a stance, its actions, and the transitions that end in it."""
    found = _stance(project, stance)
    graph = project.graphs[found.layer]
    gone = [a.id for a in graph.actions.values() if stance in (a.stance, a.end_stance)]
    graph = graph.with_actions(dict.fromkeys(gone))
    stances = {i: s for i, s in graph.stances.items() if i != stance}
    start = graph.start if graph.start != stance else next(iter(stances), None)
    return project.with_graph(graph.but(stances=stances, start=start))


def set_start_stance(project: Project, stance: str) -> Project:
    """Make performances begin in this stance."""
    found = _stance(project, stance)
    return project.with_graph(project.graphs[found.layer].but(start=stance))


# --- actions


def find_placing_refusal(
    project: Project,
    clips: Sequence[str],
    layer: Layer,
    kind: Kind,
    stance: str | None,
    end: str | None = None,
) -> str | None:
    """Return the reason why clips cannot be placed like this, or None if they can. A `stance` of None makes a
    new stance.
    """
    if not clips:
        return phrase("nothing to place")
    missing = [c for c in clips if c not in project.clips]
    if missing:
        return phrase("a clip that is not in this project")
    for clip in clips:
        entry = project.clips[clip]
        if (
            entry.motion is not None
            and project.skeleton is not None
            and entry.motion.skeleton != project.skeleton
        ):
            return phrase("'{name}' has a different skeleton from this project", name=entry.name)
    graph = project.graphs[layer]
    if kind == "stance":
        return None
    if stance is None or stance not in graph.stances:
        return phrase(
            "make a stance first: drop a clip in the middle of the {layer} layer", layer=phrase(layer)
        )
    if kind == "transition":
        if end is None or end not in graph.stances:
            return phrase("first choose the stance that this transition ends in")
        if end == stance:
            return phrase("a transition must end in another stance")
    return None


def place_clips(
    project: Project,
    clips: Sequence[str],
    layer: Layer,
    kind: Kind,
    stance: str | None,
    end_stance: str | None = None,
) -> Project:
    """Place clips on a meta node. On "stance" with no stance given, the first clip makes a new one.

    The first loop of the whole project also gives the base pose, unless one was chosen, because offsets
    relative to a rest pose with stretched arms twist the character. Raises EditError with the reason that
    `find_placing_refusal` returns.
    """
    why = find_placing_refusal(project, clips, layer, kind, stance, end_stance)
    if why is not None:
        raise EditError(why)
    if stance is None:
        return add_stance(project, layer, project.clips[clips[0]].name, clips)
    graph = project.graphs[layer]
    _stance(project, stance)
    changes: dict[str, Action | None] = {}
    for clip in clips:
        entry = project.clips[clip]
        ident = ids.make_id(project, "a", layer, kind, stance, end_stance or "", clip, more=changes)
        changes[ident] = Action(
            id=ident,
            clip=clip,
            kind=kind,
            layer=layer,
            stance=stance,
            name=entry.name,
            end_stance=end_stance if kind == "transition" else None,
            timing=make_default_timing(entry, kind),
            joints=find_face_joints(project) if entry.brought_from == FACE_TAKE and kind != "stance" else (),
            limb=guess_limb(entry.name) if layer == "arms" and kind in ("gesture", "fidget") else "both",
        )
    first = (
        kind == "stance"
        and project.base.clip is None
        and not any(k == "stance" for g in project.graphs.values() for _, k in g.index)
    )
    base = BasePose(clips[0], 0) if first else project.base
    return project.with_graph(graph.with_actions(changes), base=base)


def find_added_actions(before: Project, after: Project) -> tuple[str, ...]:
    """Return the ids of the actions that `after` has and `before` does not, in the order of `after`."""
    return tuple(a.id for a in after.actions() if before.action(a.id) is None)


def make_default_timing(entry: ClipEntry, kind: Kind) -> Timing:
    """Return the timing of a newly placed clip: blends of at most a quarter of its length, and a blended seam
    if a loop is open.
    """
    quarter = round(entry.duration / 4, 3)
    if kind == "stance":
        open_by = measure_loop_error(entry.motion) if entry.motion is not None and entry.frames > 1 else 0.0
        return Timing(blend_in=min(0.4, quarter) if open_by > SEAM else 0.0, blend_out=0.0, loop=True)
    return Timing(blend_in=min(0.2, quarter), blend_out=min(0.25, quarter))


def update_actions(project: Project, actions: Collection[str], **changes: Any) -> Project:
    """Set fields of actions. `timing` is a mapping of the Timing fields to change, or a whole Timing.

    Return the same project if nothing differs.
    """
    return update_each(project, dict.fromkeys(actions, changes))


def update_each(project: Project, changes: Mapping[str, Mapping[str, Any]]) -> Project:
    """Set different fields for each action, by id, as `update_actions` does."""
    graphs = dict(project.graphs)
    for layer, graph in project.graphs.items():
        edits: dict[str, Action | None] = {}
        for ident, wanted in changes.items():
            action = graph.actions.get(ident)
            if action is None:
                continue
            fields = dict(wanted)
            if "clip" in fields:  # a person chose this clip
                fields |= {"clip_name": "", "clip_sha256": ""}
            if isinstance(fields.get("timing"), Mapping):
                fields["timing"] = replace(action.timing, **fields["timing"])
            after = replace(action, **fields)
            if after != action:
                edits[ident] = after
        if edits:
            graphs[layer] = graph.with_actions(edits)
    return project if graphs == project.graphs else replace(project, graphs=graphs)


def move_actions(
    project: Project, actions: Collection[str], kind: Kind, stance: str, end_stance: str | None = None
) -> Project:
    """Put actions on another meta node or stance, also across layers, keeping their settings."""
    target = _stance(project, stance)
    moved = [a for i in actions if (a := project.action(i)) is not None]
    why = find_placing_refusal(project, [a.clip for a in moved], target.layer, kind, stance, end_stance)
    if why is not None:
        raise EditError(why)
    project = remove_actions(project, [a.id for a in moved if a.layer != target.layer])
    changes: dict[str, Action | None] = {}
    for action in moved:
        timing = action.timing
        if (kind == "stance") != (action.kind == "stance"):
            timing = make_default_timing(project.clips[action.clip], kind)
        changes[action.id] = replace(
            action,
            kind=kind,
            layer=target.layer,
            stance=stance,
            end_stance=end_stance if kind == "transition" else None,
            timing=timing,
        )
    return project.with_graph(project.graphs[target.layer].with_actions(changes))


def to_stance(project: Project, actions: Collection[str], stance: str) -> Project:
    """Move actions to another stance. Each keeps its kind, and transitions keep their ends. Raises
    EditError.
    """
    groups: dict[tuple[Kind, str | None], list[str]] = {}
    for ident in actions:
        action = project.action(ident)
        if action is not None:
            groups.setdefault((action.kind, action.end_stance), []).append(ident)
    for (kind, end), idents in groups.items():
        project = move_actions(project, idents, kind, stance, end)
    return project


def set_kind(
    project: Project, actions: Collection[str], kind: Kind, end_stance: str | None = None
) -> Project:
    """Give actions another kind. Each keeps its layer and stance. A transition keeps its end, and what
    becomes one ends in `end_stance`. Raises EditError if one would have no end, or end where it starts.
    """
    groups: dict[tuple[str, str | None], list[str]] = {}
    for ident in actions:
        action = project.action(ident)
        if action is not None and action.kind != kind:
            groups.setdefault((action.stance, action.end_stance or end_stance), []).append(ident)
    for (stance, end), idents in groups.items():
        project = move_actions(project, idents, kind, stance, end if kind == "transition" else None)
    return project


def set_ends(project: Project, actions: Collection[str], end_stance: str) -> Project:
    """Make transitions end in a stance. Other kinds stay as they are. Raises EditError if one would end where
    it starts.
    """
    groups: dict[str, list[str]] = {}
    for ident in actions:
        action = project.action(ident)
        if action is not None and action.kind == "transition":
            groups.setdefault(action.stance, []).append(ident)
    for start, idents in groups.items():
        project = move_actions(project, idents, "transition", start, end_stance)
    return project


def remove_actions(project: Project, actions: Collection[str]) -> Project:
    """Remove actions from the graph. Their clips stay in the library."""
    graphs = dict(project.graphs)
    for layer, graph in project.graphs.items():
        gone = dict.fromkeys(i for i in actions if i in graph.actions)
        if gone:
            graphs[layer] = graph.with_actions(gone)
    return project if graphs == project.graphs else replace(project, graphs=graphs)


# --- the rest


def set_base(project: Project, clip: str | None, frame: int = 0) -> Project:
    """Set the base pose to a frame of a clip, or to the skeleton's rest pose if `clip` is None. Raises
    EditError.
    """
    if clip is not None:
        entry = project.clips.get(clip)
        if entry is None:
            raise EditError(phrase("the clip of the base pose is not in this project"))
        frame = min(max(0, frame), max(0, entry.frames - 1))
    return replace(project, base=BasePose(clip, frame if clip else 0))


def set_weight(project: Project, layer: Layer, part: Part, weight: float) -> Project:
    """Set how strongly a layer moves a body part, 0 to 2. Raises EditError for an unknown part."""
    if part not in PARTS:
        raise EditError(
            phrase(
                "there is no body part '{part}'; choose from {names}",
                part=phrase(part),
                names=", ".join(PARTS),
            )
        )
    graph = project.graphs[layer]
    return project.with_graph(graph.but(weights={**graph.weights, part: min(2.0, max(0.0, weight))}))


def set_role(project: Project, role: str, joint: str | None) -> Project:
    """Set which joint has a role. None restores what was found."""
    roles = {r: j for r, j in project.roles.items() if r != role}
    return replace(project, roles=roles if joint is None else {**roles, role: joint})


def set_part(project: Project, joints: Collection[str], part: Part | None) -> Project:
    """Set which body part joints belong to. None restores what was found."""
    parts = {j: p for j, p in project.parts.items() if j not in joints}
    return replace(project, parts=parts if part is None else {**parts, **dict.fromkeys(joints, part)})


def set_settings(project: Project, **changes: Any) -> Project:
    settings: Settings = replace(project.settings, **changes)
    return replace(project, settings=settings)


def set_markov(project: Project, model: Markov) -> Project:
    return replace(project, markov={**project.markov, model.layer: model})


def reset_markov(project: Project, layer: Layer) -> Project:
    """Restore the default model of a layer."""
    return replace(project, markov={k: m for k, m in project.markov.items() if k != layer})


def set_character(project: Project, path: str | None) -> Project:
    """Draw another character, the default body for None. Meshes hidden on the one before are forgotten."""
    return replace(project, character=path, hidden=()) if path != project.character else project


def hide_meshes(project: Project, meshes: Iterable[str]) -> Project:
    """Hide the character's meshes of these names, and show all others."""
    return replace(project, hidden=tuple(dict.fromkeys(meshes)))


def rename_project(project: Project, name: str) -> Project:
    return replace(project, name=_clean(name))


def _stance(project: Project, ident: str) -> Stance:
    found = project.stance(ident)
    if found is None:
        raise EditError(phrase("that stance is no longer in the project"))
    return found


def _clean(name: str) -> str:
    name = " ".join(name.split())
    if not name:
        raise EditError(phrase("a name needs at least one letter"))
    return name


def find_free_name(name: str, taken: Collection[str]) -> str:
    candidate, n = name, 1
    while candidate in taken:
        n += 1
        candidate = f"{name} {n}"
    return candidate
