"""Describe what a drop on the canvas would do, and do it: the same value serves for both."""

from __future__ import annotations

from dataclasses import dataclass

from app.features.graph.graph_layout import GraphHit
from app.look.names import name_node_rows
from app.project.load import ANNOTATIONS, Load
from app.translation import tr, tr_error, tr_noop, tr_phrase, tr_plural
from app.widgets.vocabulary import get_vocabulary_word
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing.listing import reorder_actions
from metagraph.graph.edits import find_placing_refusal, move_actions, place_clips, to_stance
from metagraph.graph.model import Kind, Layer, Project

ONE: dict[Kind, str] = {
    "stance": tr_noop("a stance"),
    "gesture": tr_noop("a gesture"),
    "fidget": tr_noop("a fidget"),
    "transition": tr_noop("a transition"),
}
MORE: dict[Kind, str] = {
    "stance": tr_noop("stances"),
    "gesture": tr_noop("gestures"),
    "fidget": tr_noop("fidgets"),
    "transition": tr_noop("transitions"),
}


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
    """Return what dropping `load` on `hit` does, given the current stance and the end stance."""
    if not load:
        return Drop(False, tr("you can drop clips, folders of clips and actions here"))
    if load.files and all(f.lower().endswith(ANNOTATIONS) for f in load.files):
        return Drop(True, tr("drop to learn a model from this annotation"))
    if load.actions and hit.area == "chip" and hit.ident is not None:
        return _move(project, hit.ident, load)
    if load.actions and _in_node(project, layer, stance, hit, load):
        return _reorder(project, hit, load)
    what = _count(load)
    if hit.area in ("card", "add"):
        kind: Kind = "stance"
        target, end = None, None
        words = tr("drop {what} as a new stance", what=what)
    elif hit.area in ("loop", "chip"):
        kind, target, end = "stance", hit.ident, None
        name = _name(project, hit.ident)
        words = (
            tr("drop {what} as another loop of *{name}*", what=what, name=name)
            if load.count == 1
            else tr("drop {what} as more loops of *{name}*", what=what, name=name)
        )
    elif hit.area in ("node", "row", "bar", "other") and hit.kind is not None:
        kind, target, end = hit.kind, stance, other if hit.kind == "transition" else None
        noun = tr(MORE[kind]) if load.count > 1 else tr(ONE[kind])
        words = tr("drop {what} as {noun} of *{name}*", what=what, noun=noun, name=_name(project, stance))
        if kind == "transition":
            words = tr(
                "drop {what} as {noun} from *{stance}* to *{other}*",
                what=what,
                noun=noun,
                stance=_name(project, stance),
                other=_name(project, other),
            )
    else:
        return Drop(False, tr("drop this on one of the nodes"))
    clips = [a.clip for i in load.actions if (a := project.action(i)) is not None] or list(load.clips)
    if load.files and not clips:
        # Files are imported first; only what does not depend on the clips can be refused now.
        clips = [next(iter(project.clips))] if project.clips else []
        why = find_placing_refusal(project, clips, layer, kind, target, end) if clips else None
        if not clips and kind != "stance":
            why = tr(
                "make a stance first: drop a clip in the middle of the {layer} layer",
                layer=get_vocabulary_word(layer),
            )
    else:
        why = find_placing_refusal(project, clips, layer, kind, target, end)
    if why is None and load.actions and target is None and kind == "stance":
        why = tr("to make a new stance from this action, drag its clip from the library")
    if why is not None:
        return Drop(False, tr_phrase(why), kind, target, end)
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
    if reorder_actions(project, load.actions, before.id if before else None) is project:
        return Drop(False, tr("already here"), first.kind, first.stance, None, True)
    called = name_node_rows(project, first.layer, first.stance, first.kind)
    words = (
        tr("move {what} before *{name}*", what=_count(load), name=called[before.id])
        if before
        else tr("move {what} to the end", what=_count(load))
    )
    if before is not None and before is rest[0]:
        words = tr("move {what} to the start", what=_count(load))
    return Drop(True, words, first.kind, first.stance, None, True, before.id if before else None)


def _move(project: Project, stance: str, load: Load) -> Drop:
    """Actions dropped on a stance's chip move there and stay what they are."""
    name = _name(project, stance)
    if all((a := project.action(i)) is None or a.stance == stance for i in load.actions):
        return Drop(False, tr("already in *{name}*", name=name), None, stance)
    try:
        to_stance(project, load.actions, stance)
    except EditError as error:
        return Drop(False, tr_error(error), None, stance)
    return Drop(True, tr("move {what} to *{name}*", what=_count(load), name=name), None, stance)


def merge_at(project: Project, stance: str, hit: GraphHit) -> Drop:
    """Return what dropping a stance's chip on `hit` does."""
    if hit.area != "chip" or hit.ident is None or hit.ident == stance:
        return Drop(False, tr("drop this on another stance to merge the two"))
    two = {stance, hit.ident}
    ways = sum(a.kind == "transition" and {a.stance, a.end_stance} == two for a in project.actions())
    name, other = _name(project, stance), _name(project, hit.ident)
    words = (
        tr_plural(
            "merge *{stance}* into *{other}*; this removes the transition between them",
            "merge *{stance}* into *{other}*; this removes {count:,} transitions between them",
            ways,
            stance=name,
            other=other,
        )
        if ways
        else tr("merge *{stance}* into *{other}*", stance=name, other=other)
    )
    return Drop(True, words, None, hit.ident)


def perform_drop(project: Project, layer: Layer, drop: Drop, load: Load) -> Project:
    """Carry out a drop of clips or actions. Raises EditError."""
    if drop.reorder:
        return reorder_actions(project, load.actions, drop.before)
    if load.actions:
        assert drop.stance is not None
        if drop.kind is None:
            return to_stance(project, load.actions, drop.stance)
        return move_actions(project, load.actions, drop.kind, drop.stance, drop.end)
    assert drop.kind is not None
    return place_clips(project, load.clips, layer, drop.kind, drop.stance, drop.end)


def _count(load: Load) -> str:
    if load.count == 1:
        return tr("this clip") if load.clips else tr("this action") if load.actions else tr("this file")
    if load.files and not load.clips and not load.actions:
        return tr_plural("{count:,} file", "{count:,} files", load.count)
    return (
        tr_plural("{count:,} clip", "{count:,} clips", load.count)
        if load.clips
        else tr_plural("{count:,} action", "{count:,} actions", load.count)
    )


def _name(project: Project, stance: str | None) -> str:
    found = project.stance(stance)
    return found.name if found is not None else "?"
