"""Left/right twins of actions: which clips to mirror, and where their actions go.

A mirrored clip must be written to a file before a project can keep it, so this comes in two halves:
`make_twin_clips` gives the motion to write, `place_twins` the edit once those files are in the project's
library.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

from metagraph.common.wording import phrase
from metagraph.errors import describe_error
from metagraph.graph import anatomy, ids
from metagraph.graph.edit_error import EditError
from metagraph.graph.edits import find_free_name
from metagraph.graph.model import Action, ClipEntry, Limb, Project
from metagraph.motion.clip import Clip
from metagraph.motion.features import measure_pose_distance
from metagraph.motion.mirror import find_joint_twins, mirror, swap_sides

SAME = 0.01  # metres: a motion nowhere further from its mirror image than this has no side
_OTHER: Mapping[Limb, Limb] = {"left": "right", "right": "left", "both": "both"}


@dataclass(frozen=True, eq=False)
class TwinClip:
    """A clip to be written: the mirrored motion, named, and the ids of the actions whose twins use it."""

    name: str
    motion: Clip
    actions: tuple[str, ...]


def make_twin_clips(project: Project, actions: Collection[str], skip: bool = False) -> list[TwinClip]:
    """Return the mirrored clips that twins of these actions need, one for each clip, with names no other clip
    has. skip: leave out what cannot be mirrored, unless that is all.

    Raises EditError, in words, when an action has no side to mirror, or when the skeleton is not the same on
    both sides.
    """
    if not actions:
        raise EditError(phrase("nothing to mirror"))
    groups: dict[str, list[Action]] = {}
    for ident in dict.fromkeys(actions):
        action = _action(project, ident)
        groups.setdefault(action.clip, []).append(action)
    wanted = {clip: (used[0].name, tuple(a.id for a in used)) for clip, used in groups.items()}
    return _mirrored(project, wanted, skip)


def mirror_clips(project: Project, clips: Collection[str]) -> list[TwinClip]:
    """Return the mirror images of clips, for the library alone. Raises EditError as
    `make_twin_clips` does.
    """
    if not clips:
        raise EditError(phrase("nothing to mirror"))
    names = {i: project.clips[i].name for i in dict.fromkeys(clips) if i in project.clips}
    return _mirrored(project, {i: (name, ()) for i, name in names.items()})


def _mirrored(
    project: Project, wanted: Mapping[str, tuple[str, tuple[str, ...]]], skip: bool = False
) -> list[TwinClip]:
    """wanted: clip -> what it is for, in words, and the actions its mirror image is for."""
    skeleton = project.skeleton
    pairs = find_joint_twins(skeleton, anatomy.project_roles(project)) if skeleton is not None else ()
    taken = {entry.name for entry in project.clips.values()}
    out: list[TwinClip] = []
    skipped: list[EditError] = []
    for clip, (called, actions) in wanted.items():
        entry = project.clips.get(clip)
        try:
            twin = _mirror_sided(entry, called, pairs)
        except EditError as error:
            if not skip:
                raise
            skipped.append(error)
            continue
        assert entry is not None
        name = find_free_name(name_twin(entry.name), taken)
        taken.add(name)
        out.append(TwinClip(name, twin.renamed(name), actions))
    if skipped and not out:
        raise skipped[0]
    return out


def _mirror_sided(entry: ClipEntry | None, called: str, pairs: Sequence[int]) -> Clip:
    if entry is None or entry.motion is None:
        raise EditError(phrase("'{called}' cannot be mirrored: its clip's file is missing", called=called))
    try:
        twin = mirror(entry.motion, pairs)
    except ValueError as error:
        raise EditError(describe_error(error)) from None
    distance = float(measure_pose_distance(twin.skeleton, entry.motion.poses(), twin.poses()).max())
    if distance < SAME and not _faces_differ(entry.motion, twin):
        raise EditError(
            phrase(
                "'{called}' does not need a mirrored twin: it is within {far:.1f} cm of its mirror image",
                called=called,
                far=100 * distance,
            )
        )
    return twin


def place_twins(project: Project, pairs: Mapping[str, str]) -> Project:
    """Place twins of actions (id -> id of the mirrored clip) beside them.

    They keep kind, timing and likelihood; limb, tags, joints and name change sides; contacts are to be found
    again. A stance or end stance that has a twin by name on its layer ("weight left", "weight right") is
    exchanged for that; a loop keeps to its own stance only when it has none. Raises EditError.
    """
    for ident, clip in pairs.items():
        action = _action(project, ident)
        entry, before = project.clips.get(clip), project.clips.get(action.clip)
        if entry is None:
            raise EditError(phrase("the mirrored clip of '{name}' is not in the project", name=action.name))
        if clip == action.clip:
            raise EditError(phrase("'{name}' cannot be its own twin", name=action.name))
        if before is not None and (entry.frames, entry.fps) != (before.frames, before.fps):
            raise EditError(
                phrase(
                    "'{name}' cannot be the twin of '{other}': they differ in length",
                    name=entry.name,
                    other=before.name,
                )
            )
        graph = project.graphs[action.layer]
        end = None if action.end_stance is None else _stance_twin(project, action.end_stance)
        stance = _stance_twin(project, action.stance)
        if action.kind == "transition" and end == stance:
            raise EditError(
                phrase(
                    "the twin of '{name}' would end where it starts: no stances have matching left and "
                    "right names",
                    name=action.name,
                )
            )
        twin = replace(
            action,
            id=ids.make_id(project, "a", action.layer, action.kind, stance, end or "", clip),
            clip=clip,
            name=name_twin(action.name),
            stance=stance,
            end_stance=end,
            limb=_OTHER[action.limb],
            tags=tuple(dict.fromkeys(swap_sides(tag) for tag in action.tags)),
            joints=tuple(_joint_twin(project, name) for name in action.joints),
            joint_weights=tuple(
                (_joint_twin(project, name), weight) for name, weight in action.joint_weights
            ),
            contacts=(),
        )
        project = project.with_graph(graph.with_actions({twin.id: twin}))
    return project


def name_twin(name: str) -> str:
    """Return the name with its sides exchanged, or "... mirrored" where it says none; the twin's twin has the
    first name again.
    """
    swapped = swap_sides(name)
    if swapped != name:
        return swapped
    return name.removesuffix(" mirrored") if name.endswith(" mirrored") else f"{name} mirrored"


def _action(project: Project, ident: str) -> Action:
    action = project.action(ident)
    if action is None:
        raise EditError(phrase("that action is no longer in the project"))
    return action


def _stance_twin(project: Project, ident: str) -> str:
    stance = project.stance(ident)
    if stance is None:
        return ident
    wanted = swap_sides(stance.name)
    stances = project.graphs[stance.layer].stances.values()
    return next((s.id for s in stances if s.name == wanted), ident)


def _joint_twin(project: Project, name: str) -> str:
    skeleton = project.skeleton
    if skeleton is None or name not in skeleton:
        return name
    twin = find_joint_twins(skeleton, anatomy.project_roles(project))[skeleton.index(name)]
    return skeleton.names[twin] if twin >= 0 else name


def _faces_differ(clip: Clip, twin: Clip) -> bool:
    if clip.weights is None or twin.weights is None or not clip.morphs:
        return False
    return bool(abs(clip.weights - twin.weights).max() > 0.01)
