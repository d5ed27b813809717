"""Find the fix for each problem that a project, its clips or its performance has."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from math import ceil, isfinite
from typing import Any

import msgspec

from app.stage.fixes import Fix
from app.translation import tr, tr_plural
from metagraph.graph import edits
from metagraph.graph.checks import end_gaps
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing import merging_stances, retiming
from metagraph.graph.editing.one_sided import describe_one_sided, list_one_sided
from metagraph.graph.model import Action, Project
from metagraph.graph.problem import Problem
from metagraph.graph.repeating import LONGEST_REPEAT, seconds_played

BLENDED = 0.45  # of what plays, that each blend may take
LIKELIER = 4.0  # times as likely a transition to a stance that is not reached
ALIKE = 0.12  # metres of a figure `end_gaps.TALL` high between stances that are offered to be merged
Finding = Callable[[Project, Problem, Action], "Fix | None"]


def fix_clips(project: Project, problems: Iterable[Problem]) -> dict[Problem, Fix]:
    """Return a fix for each problem that has one: the edit that a person would make, where it is possible;
    else, for what a viewer sees, an action that is left out.
    """
    out: dict[Problem, Fix] = {}
    for problem in problems:
        action = project.action(problem.action or "")
        found: Fix | None = None
        if action is not None and action.clip in project.clips and problem.code in _OF_ACTIONS:
            found = _OF_ACTIONS[problem.code](project, problem, action)
        elif action is not None and problem.code in ("lost-stance", "lost-clip", "lost-end", "no-end"):
            found = leave_out(action)
        elif problem.stance is not None and problem.code in ("no-gestures", "no-fidgets"):
            found = _merge(project, problem.stance)
        elif problem.code == "one-arm":
            found = _twins(project, problem)
        elif problem.stance is not None and problem.code == "play-never":
            found = _lead_to(project, problem.stance)
        if found is not None:
            out[problem] = found
    return out


def _twins(project: Project, problem: Problem) -> Fix | None:
    """Return the fix that mirrors what one arm alone has in a stance."""
    actions = tuple(
        action
        for one in list_one_sided(project)
        if one.stance == problem.stance and describe_one_sided(one) == problem.message
        for action in one.actions
    )
    words = tr_plural("Make {count:,} twin", "Make {count:,} twins", len(actions))
    tip = tr("Mirrors them for the other arm, as new clips and actions. You can undo this in one step.")
    return Fix(words, tip=tip, alone=True, command="twins", actions=actions) if actions else None


def leave_out(action: Action) -> Fix:
    """Return the fix that takes an action out of the graph."""
    tip = tr("Takes '{name}' out of the graph. Its clip stays in the library.", name=action.name)
    return Fix(tr("Leave it out"), action.id, does=edits.remove_actions, args=((action.id,),), tip=tip,
               alone=True)  # fmt: skip


def find_original_clip(project: Project, action: Action) -> str | None:
    """Return the id of the clip that an action was made of; None if it is not in the project."""
    of = [e for e in project.clips.values() if e.name == action.clip_name]
    same = [e for e in of if action.clip_sha256 and e.digest.startswith(action.clip_sha256)]
    return next((e.id for e in (*same, *of)), None)


def fix_gap(project: Project, action: Action, edge: str) -> Fix:
    """Return what covers the gap between an end of an action and its stance: a longer blend where its part
    has room, else a stance that it fits, else leaving it out. `edge` is "begins" or "ends".
    """
    blend = _blend_over(project, action, edge)
    if blend is not None:
        name, seconds = blend
        words = tr("Blend {seconds:.2f} s", seconds=seconds)
        return Fix(words, action.id, {"timing": {name: seconds}}, instead=leave_out(action))
    graph = project.graphs[action.layer]
    for stance in graph.stances.values():
        if stance.id not in (action.stance, action.end_stance):
            moved = replace(action, stance=stance.id)
            gaps = end_gaps.find_end_gaps(project, graph, moved)
            if gaps and not any(gap.far for gap in gaps):
                return move_to(action, stance.id, stance.name)
    return leave_out(action)


def move_to(action: Action, stance: str, name: str) -> Fix:
    """Return the fix that moves an action to another stance."""
    return Fix(
        tr("Move to '{name}'", name=name),
        action.id,
        does=_to_stance,
        args=(action.id, stance),
        instead=leave_out(action),
    )


def _to_stance(project: Project, action: str, stance: str) -> Project:
    try:
        return edits.to_stance(project, [action], stance)
    except EditError:
        return project  # the stance was removed, or it is where a transition ends


def set_end_stance(project: Project, action: str, stance: str) -> Project:
    """Return the project with a transition that ends in a stance; unchanged if it cannot."""
    try:
        return edits.set_ends(project, [action], stance)
    except EditError:
        return project


def _length(project: Project, action: Action) -> float:
    return seconds_played(action.kind, action.timing, *project.span(action))


def _blend_over(project: Project, action: Action, edge: str) -> tuple[str, float] | None:
    """Return the field and the seconds of a blend that covers the gap at an edge; None if its part has no
    room for it.
    """
    graph, skeleton = project.graphs[action.layer], project.skeleton
    gap = next((g for g in end_gaps.find_end_gaps(project, graph, action) if g.edge == edge), None)
    if gap is None or skeleton is None:
        return None
    needed = ceil(100 * end_gaps.blend_for(skeleton.height, gap.metres)) / 100
    name = "blend_in" if edge == "begins" else "blend_out"
    return (name, needed) if needed <= BLENDED * _length(project, action) else None


def _gap(project: Project, problem: Problem, action: Action) -> Fix | None:
    return fix_gap(project, action, "begins" if problem.code == "far-start" else "ends")


def _slower(project: Project, problem: Problem, action: Action) -> Fix | None:
    """Return blends twice as long, as far as the part has room for them; else leave the action out."""
    if action.kind == "stance":
        return None
    most, timing = BLENDED * _length(project, action), action.timing
    longer = {
        name: round(min(most, max(2 * blend, end_gaps.LONG)), 2)
        for name, blend in (("blend_in", timing.blend_in), ("blend_out", timing.blend_out))
    }
    if all(longer[name] <= 1.05 * getattr(timing, name) for name in longer):
        return leave_out(action)
    words = tr("Blend {seconds:.2f} s", seconds=max(longer.values()))
    return Fix(words, action.id, {"timing": longer}, instead=leave_out(action))


def _in_clip(project: Project, problem: Problem, action: Action) -> Fix | None:
    return None if action.kind == "stance" else leave_out(action)


def _stay(project: Project, problem: Problem, action: Action) -> Fix | None:
    entry = project.clips[action.clip]
    if entry.in_place:
        return _slower(project, problem, action) if problem.code == "play-slide" else None
    return Fix(tr("Keep in place"), does=_keep_in_place, args=(entry.id,))


def _keep_in_place(project: Project, clip: str) -> Project:
    return retiming.keep_clips_in_place(project, [clip]) if clip in project.clips else project


def _scale(project: Project, problem: Problem, action: Action) -> Fix | None:
    keep = Fix(tr("Keep the times"), does=_of_clip, args=(retiming.keep_times, action.clip))
    return Fix(tr("Scale the times"), does=_of_clip, args=(retiming.scale_times, action.clip), instead=keep)


def _of_clip(project: Project, edit: Callable[[Project, str], Project], clip: str) -> Project:
    return edit(project, clip) if clip in project.clips else project


def _repeat(project: Project, problem: Problem, action: Action) -> Fix | None:
    if action.timing.repeat > 0:
        return None
    return Fix(tr("Repeat it"), action.id, does=_repeated, args=(action.id,))


def _repeated(project: Project, action: str) -> Project:
    from metagraph.suggest.jumps.soft_blends import repeat_actions

    return repeat_actions(project, [action])


def _swapped(project: Project, problem: Problem, action: Action) -> Fix | None:
    name = project.clips[action.clip].name
    keep = Fix(tr("Keep '{clip}'", clip=name), action.id, {"clip": action.clip})
    made_of = find_original_clip(project, action)
    if made_of is None:
        return keep
    words = tr("Play '{clip}'", clip=project.clips[made_of].name)
    return Fix(words, action.id, {"clip": made_of}, instead=keep)


def _times(words: Callable[[], str], **timing: Any) -> Finding:
    """Return what sets times that are the same for every action."""
    return lambda project, problem, action: Fix(words(), action.id, {"timing": timing})


def _shorten(project: Project, problem: Problem, action: Action) -> Fix | None:
    """Return blends that fit into the part that plays."""
    timing, most = action.timing, BLENDED * _length(project, action)
    fits = {
        name: round(min(most, blend), 3) if isfinite(blend) and blend > 0 else 0.0
        for name, blend in (("blend_in", timing.blend_in), ("blend_out", timing.blend_out))
    }
    return Fix(tr("Shorten its blends"), action.id, {"timing": fits})


def _seam(project: Project, problem: Problem, action: Action) -> Fix | None:
    seconds = round(min(end_gaps.LONG, _length(project, action) / 3), 2)
    return Fix(tr("Blend {seconds:.2f} s", seconds=seconds), action.id, {"timing": {"blend_in": seconds}})


def _trim(project: Project, problem: Problem, action: Action) -> Fix | None:
    duration, timing = project.clips[action.clip].duration, action.timing
    start = timing.start if 0 <= timing.start < duration else 0.0
    end = timing.end if timing.end is not None and start < timing.end <= duration else None
    return Fix(tr("Move inside the clip"), action.id, {"timing": {"start": start, "end": end}})


def _keep_out(project: Project, problem: Problem, action: Action) -> Fix | None:
    """Return the guard that keeps hands out of the body, where it is off."""
    if project.touch.guard:
        return None if action.kind == "stance" else leave_out(action)
    return Fix(tr("Keep hands out"), does=_guard, instead=leave_out(action))


def _guard(project: Project) -> Project:
    return replace(project, touch=msgspec.structs.replace(project.touch, guard=True))


def _merge(project: Project, stance: str) -> Fix | None:
    """Return the merge of a stance into the nearest one of its layer that looks the same."""
    near = _nearest_stance(project, stance)
    if near is None:
        return None
    other = project.stance(near)
    assert other is not None
    return Fix(
        tr("Merge into '{name}'", name=other.name),
        does=_merged,
        args=(stance, near),
        alone=True,
    )


def _merged(project: Project, stance: str, into: str) -> Project:
    if project.stance(stance) is None or project.stance(into) is None:
        return project
    return merging_stances.merge_stances(project, stance, into)


def _nearest_stance(project: Project, stance: str) -> str | None:
    here = project.stance(stance)
    if here is None or project.skeleton is None:
        return None
    graph = project.graphs[here.layer]
    loop = next(iter(graph.of(stance, "stance")), None)
    if loop is None:
        return None
    most = ALIKE * project.skeleton.height / end_gaps.TALL
    found = []
    for other in graph.stances.values():
        if other.id != stance:  # as a gesture of the other stance, how far would its loop begin from it?
            gaps = end_gaps.find_end_gaps(project, graph, replace(loop, kind="gesture", stance=other.id))
            found += [(gap.metres, other.id) for gap in gaps if gap.edge == "begins" and gap.metres <= most]
    return min(found)[1] if found else None


def _lead_to(project: Project, stance: str) -> Fix | None:
    """Return transitions that lead to a stance more often."""
    into = [a.id for a in project.actions() if a.kind == "transition" and a.end_stance == stance]
    return Fix(tr("Go there more often"), does=_likelier, args=(tuple(into),)) if into else None


def _likelier(project: Project, actions: tuple[str, ...]) -> Project:
    found = [a for i in actions if (a := project.action(i)) is not None]
    return edits.update_each(project, {a.id: {"likelihood": LIKELIER * a.likelihood} for a in found})


_NO_PHASES = dict.fromkeys(("stroke", "ready", "stroke_end", "relax"))
_OF_ACTIONS: dict[str, Finding] = {
    "travels": _stay,
    "play-slide": _stay,
    "play-sway": _slower,
    "play-skate": _slower,
    "play-jump": _slower,
    "play-fast": _slower,
    "clip-jump": _in_clip,
    "play-in-air": _in_clip,
    "play-under-floor": _in_clip,
    "play-arm-inside": _keep_out,
    "far-start": _gap,
    "far-end": _gap,
    "open-loop": _seam,
    "other-length": _scale,
    "hardly-seen": _repeat,
    "swapped-clip": _swapped,
    "moment": _times(lambda: tr("Clear the stroke"), **_NO_PHASES),
    "short-cycle": _times(lambda: tr("Play it once"), repeat=0.0),
    "long-repeat": _times(
        lambda: tr("Repeat {seconds:.0f} s", seconds=LONGEST_REPEAT), repeat=LONGEST_REPEAT
    ),
    "exit": _times(lambda: tr("Clear the exit"), earliest_exit=None),
    "blend": _shorten,
    "trim": _trim,
    "empty": _trim,
    "likelihood": lambda project, problem, action: Fix(tr("Set it to 1"), action.id, {"likelihood": 1.0}),
    "mask": lambda project, problem, action: Fix(tr("Move all joints"), action.id, {"joints": ()}),
    "circle": lambda project, problem, action: Fix(
        tr("Make it a gesture"), action.id, {"kind": "gesture", "end_stance": None}
    ),
}
