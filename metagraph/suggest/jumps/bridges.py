"""Ways between stances that no clip leads to or from: blends from pose to pose, told as what they are.

A set of takes often lacks a transition. Without it a stance is never reached and all its gestures never play.
A bridge is a transition that plays the loop of the stance it ends in and takes long to blend into it; if that
is too short, the loop of the stance it leaves, and takes long to blend out of it; if that is too short as
well, a copy of the clip that is held in the moment of the loop. It takes so long that no joint goes faster on
average than it usually goes in the clips: at its fastest, half as fast again. The hips go over the floor no
faster than they usually do even at their fastest, if there is time: a body that shifts its weight takes a
second for a hand's breadth. No bridge is made where the body would slide or turn on the spot, or if there is
no time for the distance.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from math import atan2, degrees
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import Phrase, phrase
from metagraph.graph import anatomy, edits, ids
from metagraph.graph.checks.end_gaps import TALL, find_reached_joints, get_action_motion
from metagraph.graph.clip_source import get_clip_course, get_source_clip, with_source
from metagraph.graph.expand import find_reachable
from metagraph.graph.model import LAYERS, Action, Layer, MetaGraph, Project
from metagraph.motion.retime import RAMP, Hold, Retime
from metagraph.playback.own_moves import SHIFTS
from metagraph.playback.posing.composer import find_composer, find_playable_motion
from metagraph.playback.posing.layers import sample_offsets

Array = NDArray[Any]

# Of a figure TALL metres high:
SPEED = 0.6  # metres a second that the farthest joint goes on a bridge, on average: an unhurried movement
NOTICED = 0.3  # metres that a joint goes on a bridge, from which on a clip would look better
SHORTEST, LONGEST = 0.6, 3.0  # seconds of a bridge
HASTY = 2.0  # metres a second, on average, above which a movement looks thrown
CALM = 0.4  # metres a second, on average, that every joint may go, even where it hardly moves in the clips
USUAL = 99.0  # the percentile of a joint's speeds in the clips that is how fast it usually goes
PEAK = 1.5  # times its average speed that a joint goes in the middle of a blend
SHIFT = 0.15  # metres a second, at its fastest, that the body may go over the floor, however still the clips
LOOKS, MOMENT = 8.0, 1 / 60  # a second, at which speeds in clips are measured, and the seconds each takes
AWAY = 0.3  # metres over the floor that a body may slide on a bridge
TURNED = 45.0  # degrees that it may turn on one
FADE = 0.25  # of a bridge, that it takes to blend into or out of the loop that it is of
CAREFUL = 0.9  # seconds of a bridge by a moment of a clip that moves before and after it, at least
STILL = 0.2  # seconds, below which a clip is too short to be blended over
HELD = 0.25  # of a bridge that is held in a moment, that its shorter blend takes


@dataclass(frozen=True)
class Bridge:
    """A transition made of nothing but a blend. start, end: ids of stances. metres: how far the farthest
    joint goes. seconds: how long it takes.
    """

    action: str
    start: str
    end: str
    metres: float
    seconds: float


def bridge_all(project: Project) -> tuple[Project, tuple[Bridge, ...]]:
    """Return the project with transitions by blending to stances its start does not lead to, and back from
    those that do not lead to it; and what was made. Stances without a loop are left as they are, and those
    that `describe_unbridged` names.
    """
    out: list[Bridge] = []
    for layer in LAYERS:
        start = project.graphs[layer].start
        poses = _without_far_rests(project, layer, _poses(project, project.graphs[layer]))
        if start not in poses:
            continue
        for there in (True, False):
            while True:
                home, lost = _parted(project.graphs[layer], start, poses, there)
                project, made = _nearest(project, poses, home, lost, there)
                if made is None:
                    break
                out.append(made)
    return project, tuple(out)


def bridge_stance(project: Project, stance: str) -> tuple[Project, tuple[Bridge, ...]]:
    """Return the project with one stance joined to the rest of its layer by blending, and what was made: a
    way to it if the start does not lead there, and a way from it if it leads nowhere, or not back. Nothing is
    made where it has no loop, or is the only one that has.
    """
    there = project.stance(stance)
    graph = project.graphs[there.layer] if there is not None else None
    poses = _poses(project, graph) if graph is not None else {}
    if graph is None or stance not in poses:
        return project, ()
    out: list[Bridge] = []
    others = [s for s in poses if s != stance]
    for to in (True, False):
        graph = project.graphs[graph.layer]
        if graph.start in poses and graph.start != stance:
            home, lost = _parted(graph, graph.start, poses, to)
            ends = [s for s in home if s != stance] if stance in lost else []
        else:  # the start itself, or none: a way that leads anywhere at all
            ends = [] if to or len(find_reachable(graph, stance)) > 1 else others
        project, made = _nearest(project, poses, ends, [stance], to)
        out += [made] if made is not None else []
    return project, tuple(out)


def find_missing_bridges(project: Project) -> list[str]:
    """Return the stances that bridges would join to the start of their layer, in the order of the project."""
    after, made = bridge_all(project)
    if not made:
        return []
    return [
        stance
        for layer in LAYERS
        for stance in project.graphs[layer].stances
        if _joined(after, layer, stance) and not _joined(project, layer, stance)
    ]


def _joined(project: Project, layer: Layer, stance: str) -> bool:
    graph = project.graphs[layer]
    start = graph.start or ""
    return stance in find_reachable(graph, start) and start in find_reachable(graph, stance)


def describe_bridges(project: Project, bridges: Iterable[Bridge]) -> list[str]:
    """Return a line for each bridge, in words."""
    names: Mapping[str, str] = {s.id: s.name for g in project.graphs.values() for s in g.stances.values()}
    most = NOTICED * _size(project)
    return [
        f'no clip leads from "{names[x.start]}" to "{names[x.end]}": blended in {x.seconds:.1f} s over '
        f"{100 * x.metres:.0f} cm" + (", which shows; a clip would look better" if x.metres > most else "")
        for x in bridges
    ]


def describe_unbridged(project: Project) -> list[str]:
    """Return a line for each stance that no bridge can join to the start of its layer, with the reason."""
    out: list[str] = []
    for layer in LAYERS:
        graph = project.graphs[layer]
        poses = _poses(project, graph)
        if graph.start not in poses:
            continue
        home = [s for s in poses if _joined(project, layer, s)]
        wanted = _without_far_rests(project, layer, poses)
        for stance in (s for s in poses if s not in home):
            lost = poses[stance]
            near = sorted((poses[s] for s in home), key=lambda one: _metres(one, lost))
            reasons = [_refusal(project, one, lost) for one in near]
            if stance not in wanted:
                far = phrase(
                    "nothing but its loop plays there, {length:.0f} cm away. Add a clip that leads there, "
                    "or bridge it under Problems.",
                    length=100 * _metres(near[0], lost),
                )
                reasons = [reasons[0] or far]
            why = reasons[0] if reasons and None not in reasons else None
            if why is not None:
                name = graph.stances[stance].name
                out.append(phrase('"{name}" is not joined to the others: {why}', name=name, why=why))
    return out


def _without_far_rests(project: Project, layer: Layer, poses: Mapping[str, _Rest]) -> dict[str, _Rest]:
    """Return the poses without those of stances in which no gesture or fidget plays, nor in any that
    transitions join to them, and which are so far from the others that a blend shows: nothing is lost if
    nobody stands in them.
    """
    graph, most = project.graphs[layer], NOTICED * _size(project)
    groups = {s: {s} for s in poses}
    for one in poses:
        for other in find_reachable(graph, one) & poses.keys():
            joined = groups[one] | groups[other]
            groups.update(dict.fromkeys(joined, joined))
    kept = {
        s
        for s, mine in groups.items()
        if graph.start in mine or any(graph.of(x, kind) for x in mine for kind in ("gesture", "fidget"))
    }
    while near := {
        s
        for one in poses.keys() - kept
        if any(_metres(poses[one], poses[s]) <= most for s in kept)
        for s in groups[one]
    }:
        kept |= near
    return {s: rest for s, rest in poses.items() if s in kept}


def _parted(graph: MetaGraph, start: str, poses: Collection[str], there: bool) -> tuple[list[str], list[str]]:
    """Return the stances that the start leads to, or that lead to it, and those of which that is not so."""
    if there:
        home = find_reachable(graph, start)
    else:
        home = frozenset(s for s in poses if start in find_reachable(graph, s))
    return [s for s in poses if s in home], [s for s in poses if s not in home]


def _nearest(
    project: Project, poses: Mapping[str, _Rest], home: Iterable[str], lost: Collection[str], there: bool
) -> tuple[Project, Bridge | None]:
    """Bridge the shortest way between stances at home and lost ones: there, or back; None if none can."""
    ways = [(_metres(poses[a], poses[b]), *((a, b) if there else (b, a))) for a in home for b in lost]
    for metres, start, end in sorted(ways):
        if _refusal(project, poses[start], poses[end]) is None:
            return _bridge(project, poses, start, end, metres)
    return project, None


def _refusal(project: Project, one: _Rest, other: _Rest) -> Phrase | None:
    """Return why a bridge between two rests would look wrong, None if it would not."""
    size, metres = _size(project), _metres(one, other)
    away = float(np.linalg.norm(one.hips - other.hips)) if one.on_legs else 0.0
    turned = abs((one.heading - other.heading + 180) % 360 - 180) if one.on_legs else 0.0
    room = max(one.room, other.room)
    if room < STILL:
        return phrase("both are single poses, which leave no time to blend")
    if away > AWAY * size:
        return phrase("the body would slide {length:.1f} m over the floor", length=away)
    if turned > TURNED:
        return phrase("the body would turn by {angle:.0f} degrees on the spot", angle=turned)
    course = _course(project, one, other)
    if course.hurry <= 1.001:
        most = max(SHIFTS * size, PEAK * one.pace.usual_shift)
        if PEAK * away <= 1.001 * most * course.seconds:
            return None
        return phrase(
            "the body would slide {length:.0f} cm at {speed:.1f} m/s. Add a clip that leads there, or a "
            "longer loop.",
            length=100 * away,
            speed=PEAK * away / max(1e-6, course.seconds),
        )
    joint, limit = course.joint, float(one.pace.limits[course.joint])
    if limit < HASTY * size:
        return phrase(
            "{part} moves at {speed:.1f} m/s, but at most at {usual:.1f} m/s in the clips",
            part=f"'{one.pace.skeleton.names[joint]}'",
            speed=PEAK * course.hurry * limit,
            usual=PEAK * limit,
        )
    return phrase(
        "both loops are too short: moving {length:.0f} cm in {seconds:.1f} s would look like a jolt",
        length=100 * metres,
        seconds=room,
    )


def _loop(project: Project, graph: MetaGraph, stance: str) -> Action | None:
    """Return the first loop of a stance whose motion is there."""
    return next((a for a in graph.of(stance, "stance") if get_action_motion(project, a) is not None), None)


class _Pace:
    """How fast the joints of a project may go on bridges."""

    def __init__(self, project: Project) -> None:
        assert project.skeleton is not None
        self.project, self.skeleton = project, project.skeleton

    @property
    def limits(self) -> Array:
        """How fast each joint may go on average, `[J]` m/s: as fast as it usually goes in what plays. Only
        HASTY limits it if nothing but loops plays.
        """
        return self._found[0]

    @property
    def usual_shift(self) -> float:
        """How fast the hips usually go over the floor in what plays, m/s; SHIFT where that is more."""
        return self._found[1]

    @cached_property
    def _found(self) -> tuple[Array, float]:
        size, speeds, shifts = _size(self.project), [], []
        hips = anatomy.project_roles(self.project).get("hips", 0)
        moves = False
        for action in self.project.actions():
            clip = find_playable_motion(self.project, action)
            start, end = self.project.span(action)
            if clip is None or end - start < 2 * MOMENT:
                continue
            moves = moves or action.kind != "stance"
            times = np.arange(start, end - MOMENT, 1 / LOOKS)
            first, second = (clip.skeleton.globals(clip.pose_at(t))[1] for t in (times, times + MOMENT))
            speeds.append(np.linalg.norm(second - first, axis=-1) / MOMENT)
            shifts.append(np.linalg.norm((second - first)[:, hips][:, (0, 2)], axis=-1) / MOMENT)
        if not moves:
            return np.full(len(self.skeleton), HASTY * size), SHIFT * size
        usual = np.percentile(np.concatenate(speeds), USUAL, axis=0)
        shift = float(np.percentile(np.concatenate(shifts), USUAL))
        return np.clip(usual, CALM * size, HASTY * size), max(SHIFT * size, shift)


@dataclass(frozen=True, eq=False)
class _Rest:
    """The pose that a stance's loop begins in.

    `places` `[J, 3]`, metres, are those that its layer alone gives the joints. `joints` are
    those that the layer moves. `hips` `[2]`, metres, on the floor. `heading`: where the hips face, degrees.
    `on_legs`: whether the layer moves the legs. `span`: of the loop, seconds of its clip, which has `room`
    seconds. `holds`: whether a copy of the clip can be held in a moment of the loop.
    """

    loop: Action
    places: Array
    joints: tuple[int, ...]
    hips: Array
    heading: float
    on_legs: bool
    span: tuple[float, float]
    room: float
    holds: bool
    pace: _Pace


def _poses(project: Project, graph: MetaGraph) -> dict[str, _Rest]:
    """Return stance -> the pose of its loop; of those that have a loop that is there."""
    out: dict[str, _Rest] = {}
    if project.skeleton is None:
        return out
    roles, pace, rig = anatomy.project_roles(project), _Pace(project), find_composer(project)
    for stance in graph.stances:
        loop = _loop(project, graph, stance)
        motion = get_action_motion(project, loop)
        if loop is not None and motion is not None:
            span = project.span(loop)
            start = np.array([span[0]])
            _, places = motion.skeleton.globals(motion.pose_at(span[0]))
            added = sample_offsets(rig.ground, rig.reach[graph.layer], motion, start)
            _, shown = motion.skeleton.globals(rig.compose({graph.layer: added}, 1))
            left, right = (places[roles.get(f"{side}_upper_leg", 0)] for side in ("left", "right"))
            across = left - right
            out[stance] = _Rest(
                loop,
                shown[0],
                find_reached_joints(project, graph, loop),
                places[roles.get("hips", 0)][[0, 2]],
                degrees(atan2(-across[2], across[0])),
                graph.weight("legs") > 0,
                span,
                motion.duration,
                motion.frames > 1 and project.clips[loop.clip].retime.plain,
                pace,
            )
    return out


def _ways(one: _Rest, other: _Rest) -> Array:
    """Return how far joints go from one pose to the other, `[J]` metres; 0 for those no loop moves."""
    out = np.zeros(len(one.places))
    joints = sorted({*one.joints, *other.joints})
    out[joints] = np.linalg.norm(one.places[joints] - other.places[joints], axis=-1)
    return out


def _metres(one: _Rest, other: _Rest) -> float:
    return float(_ways(one, other).max(initial=0.0))


@dataclass(frozen=True)
class _Course:
    """What a bridge plays: seconds first to last of the loop that it leaves (leaving) or enters, and which
    share of them its short blend takes. hurry: how fast the fastest joint goes, as a multiple of its limit.
    held: the loop's moment that is held all the while; None if its clip goes on.
    """

    leaving: bool
    first: float
    last: float
    fade: float
    joint: int
    hurry: float
    held: float | None = None

    @property
    def seconds(self) -> float:
        """How long the long blend takes."""
        return (self.last - self.first) * (1 - self.fade)


def _course(project: Project, start: _Rest, end: _Rest) -> _Course:
    ways = _ways(start, end)
    needs = ways / start.pace.limits  # seconds of the long blend
    shift = float(np.linalg.norm(start.hips - end.hips)) if start.on_legs else 0.0
    calm = PEAK * shift / start.pace.usual_shift
    least = max(float(ways.max()) / (SPEED * _size(project)), max(float(needs.max()), calm) / (1 - FADE))
    seconds, fade = float(np.clip(least, SHORTEST, LONGEST)), FADE
    joint = int(needs.argmax())
    loops = [rest.span[1] - rest.span[0] for rest in (start, end)]
    if max(loops) < seconds and (rest := end if end.holds else start).holds:
        hurry = float(needs[joint]) / (seconds * (1 - HELD))
        moment = sum(rest.span) / 2
        return _Course(rest is start, 0.0, seconds, HELD, joint, hurry, moment)
    leaving = end.room < min(seconds, start.room) or loops[1] < seconds <= loops[0]
    begins, ends = start.span if leaving else end.span
    room = start.room if leaving else end.room
    if ends - begins < min(seconds, room):  # the moment itself is where neither blend is
        seconds, fade = max(seconds * (1 - FADE) / 0.5, CAREFUL), 0.5
        begins = max(0.0, (begins + ends - seconds) / 2)
    first = max(0.0, min(begins, room - seconds))
    last = min(first + seconds, room)
    hurry = float(needs[joint]) / max(1e-6, (last - first) * (1 - fade))
    return _Course(leaving, first, last, fade, joint, hurry)


def _size(project: Project) -> float:
    return max(project.skeleton.height / TALL, 1e-6) if project.skeleton is not None else 1.0


def _bridge(
    project: Project, poses: Mapping[str, _Rest], start: str, end: str, metres: float
) -> tuple[Project, Bridge]:
    stance = project.stance(end)
    assert stance is not None
    course = _course(project, poses[start], poses[end])
    kept = start if course.leaving else end
    clip = poses[kept].loop.clip
    if course.held is not None:
        project, clip, first = _hold(project, clip, course, kept)
        course = replace(course, first=first, last=first + course.last)
    project = edits.place_clips(project, [clip], stance.layer, "transition", start, end)
    made = list(project.graphs[stance.layer].actions)[-1]
    seconds = course.last - course.first
    long, short = round(seconds * (1 - course.fade), 3), round(seconds * course.fade, 3)
    timing = {
        "start": round(course.first, 3),
        "end": round(course.last, 3),
        "blend_in": short if course.leaving else long,
        "blend_out": long if course.leaving else short,
    }
    project = edits.update_actions(project, [made], timing=timing, name=f"to {stance.name}, blended")
    return project, Bridge(made, start, end, metres, seconds)


def _hold(project: Project, clip: str, course: _Course, stance: str) -> tuple[Project, str, float]:
    """Return the project with a copy of a clip that is held in a moment for as long as a bridge takes, the
    copy's id, and when the hold begins. A copy that is there, and held as long, is used again.
    """
    entry, kept = project.clips[clip], project.stance(stance)
    assert entry.motion is not None and course.held is not None and kept is not None
    source = get_source_clip(entry)
    assert source is not None
    seconds = round(course.last - course.first, 3) + 2 * RAMP
    held = Retime(holds=(Hold(round(course.held, 3), seconds),)).kept(source.duration)
    for other in project.clips.values():
        same = (other.path, other.take, other.turned, other.moved_x, other.moved_z, other.in_place) == (
            *(entry.path, entry.take, entry.turned, entry.moved_x, entry.moved_z),
            entry.in_place,
        )
        if same and other.retime == held:
            copy = other
            break
    else:
        made = ids.make_id(project, "c", entry.path, entry.take, "held", stance)
        copy = with_source(replace(entry, id=made, name=f"{kept.name}, held", retime=held), source)
        project = replace(project, clips={**project.clips, made: copy})
    found = get_clip_course(copy)
    assert found is not None
    first, last = found.stays[0]
    return project, copy.id, (first + last - (course.last - course.first)) / 2
