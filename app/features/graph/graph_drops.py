"""What a drop on the canvas would do: said in words before it happens, done by the same value when it
does.
"""

from __future__ import annotations

from dataclasses import dataclass

from app.features.graph.graph_layout import GraphHit
from app.look.names import node_names
from app.project.load import ANNOTATIONS, Load
from metagraph.graph.edits import EditError, move_actions, place, refusal, to_stance
from metagraph.graph.listing_edits import reordered
from metagraph.graph.model import Kind, Layer, Project


@dataclass(frozen=True)
class Drop:
    """kind, stance, end: where things go; stance None makes a new one, kind None keeps each action's own.

    words: what will happen, or why not. reorder: actions stay in their node and are listed in front of the
    action `before`, None for its end.
    """

    possible: bool
    words: str
    kind: Kind | None = None
    stance: str | None = None
    end: str | None = None
    reorder: bool = False
    before: str | None = None


def drop_at(
    project: Project, layer: Layer, stance: str | None, other: str | None, hit: GraphHit, load: Load
) -> Drop:
    """Return what dropping `load` on `hit` does; the current stance and the other stance say where."""
    if not load:
        return Drop(False, "only clips, folders of clips and actions can be dropped here")
    if load.files and all(f.lower().endswith(ANNOTATIONS) for f in load.files):
        return Drop(True, "drop to learn from this annotation")
    if load.actions and hit.area == "chip" and hit.ident is not None:
        return _move(project, hit.ident, load)
    if load.actions and _in_node(project, layer, stance, hit, load):
        return _reorder(project, hit, load)
    what = _count(load)
    if hit.area in ("card", "add"):
        kind: Kind = "stance"
        target, end = None, None
        words = f"drop {what} as a new stance"
    elif hit.area in ("loop", "chip"):
        kind, target, end = "stance", hit.ident, None
        words = (
            f"drop {what} as {'another loop' if load.count == 1 else 'more loops'} of "
            f"*{_name(project, hit.ident)}*"
        )
    elif hit.area in ("node", "row", "bar", "other") and hit.kind is not None:
        kind, target, end = hit.kind, stance, other if hit.kind == "transition" else None
        noun = f"{kind}s" if load.count > 1 else f"a {kind}"
        words = f"drop {what} as {noun} of *{_name(project, stance)}*"
        if kind == "transition":
            noun = "transitions" if load.count > 1 else "a transition"
            words = f"drop {what} as {noun} from *{_name(project, stance)}* to *{_name(project, other)}*"
    else:
        return Drop(False, "drop on one of the nodes")
    clips = [a.clip for i in load.actions if (a := project.action(i)) is not None] or list(load.clips)
    if load.files and not clips:
        # Files are imported first; only what does not depend on the clips can be refused now.
        clips = [next(iter(project.clips))] if project.clips else []
        why = refusal(project, clips, layer, kind, target, end) if clips else None
        if not clips and kind != "stance":
            why = f"make a stance first: drop a clip on the middle of the {layer} layer"
    else:
        why = refusal(project, clips, layer, kind, target, end)
    if why is None and load.actions and target is None and kind == "stance":
        why = "drag its clip from the library to make a new stance of it"
    if why is not None:
        return Drop(False, why, kind, target, end)
    return Drop(True, words, kind, target, end)


def _in_node(project: Project, layer: Layer, stance: str | None, hit: GraphHit, load: Load) -> bool:
    """Return whether all actions are in the node that is pointed at, already."""
    node = layer, stance, hit.kind
    found = (project.action(i) for i in load.actions)
    return hit.area in ("node", "row") and all(a and (a.layer, a.stance, a.kind) == node for a in found)


def _reorder(project: Project, hit: GraphHit, load: Load) -> Drop:
    """Actions dropped in their own node are listed elsewhere in it."""
    first = project.action(load.actions[0])
    assert first is not None
    node = project.graphs[first.layer].of(first.stance, first.kind)
    rest = [a for a in node if a.id not in load.actions]
    place = next((n for n, a in enumerate(node) if a.id == hit.ident), len(node)) + hit.behind
    before = next((a for a in node[place:] if a.id not in load.actions), None)
    if reordered(project, load.actions, before.id if before else None) is project:
        return Drop(False, "already here", first.kind, first.stance, None, True)
    called = node_names(project, first.layer, first.stance, first.kind)
    words = f"list {_count(load)} before *{called[before.id]}*" if before else f"list {_count(load)} last"
    if before is not None and before is rest[0]:
        words = f"list {_count(load)} first"
    return Drop(True, words, first.kind, first.stance, None, True, before.id if before else None)


def _move(project: Project, stance: str, load: Load) -> Drop:
    """Actions dropped on a stance's chip move there and stay what they are."""
    name = _name(project, stance)
    if all((a := project.action(i)) is None or a.stance == stance for i in load.actions):
        return Drop(False, f"already in *{name}*", None, stance)
    try:
        to_stance(project, load.actions, stance)
    except EditError as error:
        return Drop(False, str(error), None, stance)
    return Drop(True, f"move {_count(load)} to *{name}*", None, stance)


def perform(project: Project, layer: Layer, drop: Drop, load: Load) -> Project:
    """Do what a possible drop said, for clips or actions. Raises EditError."""
    if drop.reorder:
        return reordered(project, load.actions, drop.before)
    if load.actions:
        assert drop.stance is not None
        if drop.kind is None:
            return to_stance(project, load.actions, drop.stance)
        return move_actions(project, load.actions, drop.kind, drop.stance, drop.end)
    assert drop.kind is not None
    return place(project, load.clips, layer, drop.kind, drop.stance, drop.end)


def _count(load: Load) -> str:
    noun = "clip" if load.clips else "action" if load.actions else "file"
    return f"{load.count} {noun}s" if load.count > 1 else f"this {noun}"


def _name(project: Project, stance: str | None) -> str:
    found = project.stance(stance)
    return found.name if found is not None else "?"
