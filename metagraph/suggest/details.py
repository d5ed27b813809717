"""Propose what an action has besides its labels: timing, the joints it moves, its stroke, its likelihood;
each with a reason.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import phrase, plural_phrase
from metagraph.graph import anatomy
from metagraph.graph.model import LAYERS, Action, Kind, Layer, Project, Timing
from metagraph.graph.repeating import usual_repeat
from metagraph.motion.clip import Clip
from metagraph.playback.timing.phase_times import LEAST_BLEND
from metagraph.playback.timing.phases import find_phases
from metagraph.suggest.estimate import Belief
from metagraph.suggest.jumps import compatibility
from metagraph.suggest.motion_guess import MotionGuess
from metagraph.suggest.proposal import Proposal, RestMoment, StancePlace, name_words
from metagraph.suggest.stances.pose_words import is_lying
from metagraph.suggest.traits import Traits

Array = NDArray[Any]

LEAST_LOOP = 1.0  # seconds of a still moment that can repeat; of a shorter one, a single frame is held
STILL = np.radians(2.0)  # the most that a joint turns in a moment that is still enough to stand in
STAYS = 0.01  # heights that the hips move in it, at most
LONGEST = 2.0  # seconds: the longest such moment
MANY = 12  # clips that are searched for one
LATE = 2 / 3  # of a cycle: its stroke is sought from there on
RARE = 0.02  # likelihood of lying down, beside the usual 1 of sitting down


def with_timing(
    project: Project, proposals: Mapping[str, Proposal], cancelled: Callable[[], bool] | None = None
) -> dict[str, Proposal]:
    """Return proposals with timing from the statistics of the user's own clips, if there are loops of stances
    to compare with.
    """
    roles = anatomy.project_roles(project)
    out = dict(proposals)
    for layer in LAYERS:
        mine = [p for p in proposals.values() if p.layer.value == layer]
        motions = [m for p in mine if (m := project.clips[p.clip].motion) is not None]
        if not motions:
            continue
        stats = compatibility.compute_statistics(motions, layer, roles)
        loops: dict[str, list[tuple[Clip, float, float]]] = {
            k: list(v) for k, v in compatibility.list_stance_loops(project, layer).items()
        }
        for p in mine:
            motion = project.clips[p.clip].motion
            if p.kind.value == "stance" and p.stance is not None and motion is not None:
                loops.setdefault(p.stance.value, []).append((motion, 0.0, motion.duration))
        frames = {key: compatibility.find_stance_frames(stats, rows, roles) for key, rows in loops.items()}
        for p in mine:
            if cancelled is not None and cancelled():
                return out
            motion = project.clips[p.clip].motion
            if motion is None or motion.frames < 2:
                continue
            if p.kind.value == "stance":
                times = compatibility.find_loop_times(stats, motion, roles)
            elif _repeats(p):
                times = _whole_cycle(motion)
            else:
                start = frames.get(p.stance.value if p.stance is not None else "")
                if start is None:
                    continue
                into = compatibility.measure_transition_costs(stats, motion, start, roles)
                last = frames.get(p.end_stance.value) if p.end_stance is not None else None
                times = compatibility.propose_times(
                    stats,
                    motion,
                    into,
                    None
                    if last is None
                    else compatibility.measure_transition_costs(stats, motion, last, roles),
                    None,
                    roles,
                )
            out[p.clip] = _with_times(p, motion, times)
    return out


def _repeats(p: Proposal) -> bool:
    return p.cycle and p.kind.value in ("gesture", "fidget")


def _whole_cycle(motion: Clip) -> compatibility.ProposedTimes:
    """Return the timing of a clip that is one cycle: all of it, blended in and out over any distance."""
    blend, reason = min(LEAST_BLEND, motion.duration), phrase("is one cycle, which ends as it begins")
    return compatibility.ProposedTimes(0.0, motion.duration, blend, blend, None, True, reason)


def _with_times(p: Proposal, motion: Clip, times: compatibility.ProposedTimes) -> Proposal:
    loop = p.kind.value == "stance"
    timing: dict[str, Any] = {
        "start": round(times.start, 3),
        "end": None if times.end >= motion.duration - 1e-3 else round(times.end, 3),
        "blend_in": round(times.blend_in, 3),
        "blend_out": round(times.blend_out, 3),
        "earliest_exit": None if times.earliest_exit is None else round(times.earliest_exit, 3),
        "loop": loop,
    }
    reasons = dict.fromkeys(timing, times.reason)
    reasons["loop"] = _plays(p.kind.value)
    if _repeats(p):
        timing["repeat"] = usual_repeat(motion.duration)
        reasons["repeat"] = phrase(
            "one cycle of {seconds:.2f} s, played {count} times, or for as long as a request asks",
            seconds=motion.duration,
            count=round(timing["repeat"] / motion.duration),
        )
        reasons["earliest_exit"] = reasons["loop"] = phrase("it may be left after its first cycle")
    elif times.earliest_exit is None:
        reasons["earliest_exit"] = (
            phrase("a stance can exit at any time")
            if loop
            else phrase("it plays to its end, where it looks like a stance again")
        )
    else:
        reasons["earliest_exit"] = phrase(
            "looks like the stance it ends in from {seconds:.2f} s on", seconds=times.earliest_exit
        )
    sure = 0.9 if times.good else 0.5
    details = {
        key: Belief(value, p.kind.confidence if key == "loop" else sure, reasons[key])
        for key, value in timing.items()
    }
    return replace(
        p, timing=timing, timing_reason=times.reason, good=times.good, details={**p.details, **details}
    )


def _plays(kind: Kind) -> str:
    if kind == "stance":
        return phrase("a stance plays until it is left")
    if kind == "transition":
        return phrase("a transition plays once")
    return phrase("a gesture plays once") if kind == "gesture" else phrase("a fidget plays once")


def with_moved_joints(project: Project, p: Proposal, traits: Traits | None) -> Proposal:
    """Return a proposal with the joints its clip moves: all that its layer reaches, or for a clip of only the
    face, those of the face.
    """
    motion = project.clips[p.clip].motion
    if motion is None or traits is None:
        return p
    mask: Belief[tuple[str, ...]] = Belief((), 0.9, phrase("moves all joints of its layer"))
    if traits.face > 0 and p.layer.value == "head":
        moving = np.flatnonzero(np.ptp(motion.rotations, axis=0).max(-1) > 1e-3)
        apart = np.ptp(motion.translations, axis=0).max(-1) if len(motion.translated) else np.zeros(0)
        joints = {int(j) for j in moving} | {
            int(j) for j, x in zip(motion.translated, apart, strict=True) if x > 1e-5
        }
        if joints:
            names = tuple(motion.skeleton.names[j] for j in sorted(joints))
            mask = Belief(
                names,
                0.9,
                plural_phrase(
                    "only {count:,} joint of the face moves",
                    "only {count:,} joints of the face move",
                    len(names),
                ),
            )
    return replace(p, details={**p.details, "mask": mask})


def with_stroke(project: Project, p: Proposal, motion: MotionGuess | None) -> Proposal:
    """Return a gesture's proposal with its stroke, found by `playback.timing.phases` within the proposed
    timing.
    """
    if p.kind.value != "gesture" or motion is None or project.clips[p.clip].motion is None:
        return p
    timing = Timing(**p.timing)
    if _repeats(p):  # of the first cycle late, when it has mostly come in
        timing = replace(timing, start=LATE * project.clips[p.clip].duration)
    action = Action("", p.clip, "gesture", p.layer.value, "", "", timing=timing, limb=p.limb.value)
    found = find_phases(project, action)
    near = motion.stroke is not None and abs(motion.stroke.value - found.stroke) < 0.1
    reason = _fastest(p.layer.value, found.stroke)
    if near:
        reason = phrase(
            "{fastest}, on the way out; held until {seconds:.2f} s", fastest=reason, seconds=found.relax
        )
    return replace(
        p,
        timing={**p.timing, "stroke": round(found.stroke, 3)},
        details={**p.details, "stroke": Belief(round(found.stroke, 3), 0.85 if near else 0.6, reason)},
    )


def _fastest(layer: Layer, seconds: float) -> str:
    if layer == "arms":
        return phrase("the hands are fastest at {seconds:.2f} s", seconds=seconds)
    if layer == "head":
        return phrase("the head is fastest at {seconds:.2f} s", seconds=seconds)
    return phrase("the trunk is fastest at {seconds:.2f} s", seconds=seconds)


def with_likelihoods(project: Project, proposals: Mapping[str, Proposal]) -> dict[str, Proposal]:
    """Return proposals with likelihoods. Numbered variants of one action share one weight, so that many takes
    of it do not crowd out the rest; those placed before are counted, too.
    """
    groups: dict[Any, list[str]] = defaultdict(list)
    placed: dict[Any, int] = defaultdict(int)
    for p in proposals.values():
        groups[
            _alike(project, p.clip, p.kind.value, p.layer.value, p.stance.value if p.stance else "")
        ].append(p.clip)
    for action in project.actions():
        if action.clip in project.clips and action.clip not in proposals:
            placed[_alike(project, action.clip, action.kind, action.layer, action.stance)] += 1
    out = {}
    for key, clips in groups.items():
        count = len(clips) + placed[key]
        words = key[-1]
        if count > 1 and words:
            belief = Belief(
                round(1 / count, 3),
                0.8,
                phrase(
                    "one of {count} clips named '{words}', which share the weight of one",
                    count=count,
                    words=words,
                ),
            )
        else:
            belief = Belief(1.0, 0.8, phrase("the only clip with this name, so it has full weight"))
        for clip in clips:
            p = proposals[clip]
            out[clip] = replace(p, details={**p.details, "likelihood": belief})
    return {clip: out[clip] for clip in proposals}


def with_rare_lying(proposals: Mapping[str, Proposal], traits: Mapping[str, Traits]) -> dict[str, Proposal]:
    """Return proposals in which a character that stands or sits hardly ever lies down: nobody does while
    talking, unless it is requested.
    """
    out = dict(proposals)
    for c, p in proposals.items():
        body = traits[c].layers["body"] if c in traits else None
        if p.kind.value != "transition" or body is None:
            continue
        if is_lying(body.names, body.last) and not is_lying(body.names, body.first):
            why = phrase("ends on the ground; nobody lies down while talking, so it is rare unless requested")
            out[c] = replace(p, details={**p.details, "likelihood": Belief(RARE, 0.8, why)})
    return out


def _alike(project: Project, clip: str, kind: str, layer: str, stance: str) -> tuple[str, str, str, str]:
    words = name_words(project.clips[clip].name)
    while words and words[-1].isdigit():
        words = words[:-1]
    return kind, layer, stance, " ".join(words)


# --- where to stand when nothing rests

_FIRST = phrase("no clip rests there; '{name}' holds still for its first {seconds:.2f} s")
_LAST = phrase("no clip rests there; '{name}' holds still for its last {seconds:.2f} s")
_FIRST_FRAME = phrase("no clip rests there; the first frame of '{name}' is held")
_LAST_FRAME = phrase("no clip rests there; the last frame of '{name}' is held")


def find_rest_moment(
    project: Project, place: StancePlace, proposals: Mapping[str, Proposal]
) -> RestMoment | None:
    """Return the stillest moment in which clips show a stance that no clip rests in: the beginning of one
    that starts there, or the end of one that ends there; None if no clip has motion.
    """
    ends: list[tuple[float, str, bool]] = []
    for p in proposals.values():
        if p.layer.value == place.layer:
            ends += [
                (b.confidence, p.clip, b is p.stance)
                for b in (p.stance, p.end_stance)
                if b is not None and b.value == place.key
            ]
    best: RestMoment | None = None
    longest = 0.0
    for _, clip, first in sorted(ends, key=lambda x: (-x[0], x[1], not x[2]))[:MANY]:
        motion = project.clips[clip].motion
        if motion is None:
            continue
        long = _still(motion, first)
        if best is None or long > longest + 1e-6:
            longest = long
            if long < LEAST_LOOP:  # repeated so fast, it would tremble
                start = end = 0.0 if first else motion.duration
            else:
                start, end = (0.0, long) if first else (motion.duration - long, motion.duration)
            name = project.clips[clip].name
            if first:
                words = _FIRST_FRAME if start == end else _FIRST
            else:
                words = _LAST_FRAME if start == end else _LAST
            reason = phrase(words, name=name, seconds=long)
            best = RestMoment(clip, round(start, 3), round(end, 3), reason)
    return best


def _still(motion: Clip, first: bool) -> float:
    """Return for how many seconds a clip stays as it is at its beginning or end; at least one frame."""
    if motion.frames < 2:
        return motion.duration
    count = min(motion.frames, int(LONGEST * motion.fps) + 1)
    rows = (
        slice(0, count)
        if first
        else slice(motion.frames - 1, motion.frames - 1 - count if count < motion.frames else None, -1)
    )
    turns = motion.rotations[rows]
    angle = 2 * np.arccos(np.clip(np.abs(np.sum(turns * turns[0], axis=-1)), 0, 1)).max(-1)
    moved = np.zeros(len(turns))
    if len(motion.translated):
        places = motion.translations[rows]
        moved = np.linalg.norm(places - places[0], axis=-1).max(-1) / max(motion.skeleton.height, 1e-6)
    away = np.flatnonzero((angle > STILL) | (moved > STAYS))
    frames = max(1, (int(away[0]) if len(away) else len(turns)) - 1)
    return float(frames / motion.fps)
