"""Play a project and report what a viewer would see: joints that jump, blends that slide the body over the
floor, feet under it or in the air, arms inside the body, stances that are never reached.

The character plays some minutes untouched, as the window's performance does, and then each action once. All
of it is measured on the poses that are drawn, and compared with what the clips themselves do.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from math import ceil, floor
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import Phrase, join_phrases, phrase, plural_phrase
from metagraph.graph import anatomy
from metagraph.graph.model import LAYERS, Layer, Project
from metagraph.graph.problem import Problem, Severity
from metagraph.graph.repeating import seconds_played
from metagraph.graph.requests import Play
from metagraph.motion.in_place import measure_travel
from metagraph.playback.continuity import find_blends
from metagraph.playback.evaluator import CONTACTS, LIFE, WEIGHT
from metagraph.playback.own_moves import RATE, SHIFTS, measure_own_moves, play_clips
from metagraph.playback.plan import Plan
from metagraph.playback.planning.running_plan import improvise, plan_performance
from metagraph.playback.played_poses import PARTS, PlayedPoses, count_chunks, watch_plans
from metagraph.playback.posing.composer import find_playable_motion
from metagraph.playback.posing.foot_slides import RATE as FEET_RATE
from metagraph.playback.posing.foot_slides import FeetWatch
from metagraph.playback.posing.weight import has_planted_feet
from metagraph.playback.quiet_layers import find_quiet_layers

Array = NDArray[Any]

MINUTES = 10.0
LEAST_MINUTES = 5.0  # below which a stance that was not reached means nothing
GAP = 0.5  # seconds between the actions that are each played once
TALL = 1.75  # metres: the lengths and speeds below are of a figure of that height
USUAL = 1.5  # times the clips' own 99th percentile, up to which nothing is reported
JUMP = 100.0  # m/s2: 2.8 cm from one sixtieth of a second to the next
FAST = 3.0  # m/s that a hand may go in a blend
OWN = 0.8  # share of what is seen that a clip must do by itself to be the reason
GLIDE, GLIDES = 0.6, 0.15  # m/s that the hips may go over the floor in a blend; metres that are seen
SHIFTED = 0.06  # metres that they go at more than SHIFTS, and a viewer sees that nothing carries them
SETTLES = 0.5  # seconds between blends that are looked at as one
SKATE, SKATES = 0.1, 0.03  # m/s that a standing foot may slide in a blend; metres that are seen
UNDER = 0.05  # metres below the floor
ABOVE = 0.20  # metres of the lowest joint above it
INSIDE = 0.03  # metres of an arm within the body
LONG = 0.5  # seconds that a foot is under the floor, or an arm within the body, before it is reported
LASTING = 0.1  # of the time, from which on a figure off the floor is an error
_LAYER_OF: dict[str, Layer] = {"left_hand": "arms", "right_hand": "arms", "head": "head"}
_ADDED = {  # by stage: what it is called, whose causes are looked at, what helps
    WEIGHT: (
        phrase("planted feet and weight"),
        "hips",
        phrase("Turn *Planted feet* and *Follow-through* down under Life."),
    ),
    LIFE: (phrase("gaze, breath and posture"), "head", phrase("Turn *Gaze* down under Life.")),
    CONTACTS: (
        phrase("hand contacts and the guard"),
        "left_hand",
        phrase("Turn off *Keep hands out of the body* under Life, or skip the gesture in this stance."),
    ),
}
_NAMES = {
    "left_hand": phrase("the left hand"),
    "right_hand": phrase("the right hand"),
    "head": phrase("the head"),
    "hips": phrase("the body"),
    "left_foot": phrase("the left foot"),
    "right_foot": phrase("the right foot"),
}


@dataclass(frozen=True)
class _Cause:
    """What plays at a time on a layer. key: by which findings are counted together. blending: whether two
    poses blend then.
    """

    key: tuple[str, str]
    words: Phrase
    layer: Layer
    blending: bool
    action: str | None = None
    stance: str | None = None


def rehearse(
    project: Project,
    seconds: float = 60 * MINUTES,
    progress: Callable[[int, int], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> list[Problem]:
    """Return what a viewer would see go wrong in so many seconds of the performance that plays by itself,
    and where each action plays once; nothing for a project without a skeleton or a stance that plays.

    `Problem.moment` is the second of the untouched performance, None for what only an action's own turn
    shows. progress: called with how many parts of the work are done, and of how many. cancelled: asked
    between them; then what was found by then is returned.
    """
    playing = [g for g in project.graphs.values() if any(a.kind == "stance" for a in g.actions.values())]
    if project.skeleton is None or not playing:
        return []
    untouched = improvise(project, seconds)
    asked, length = _ask_for_each(project)
    plans = [(untouched, seconds, True)]
    if length > 0:
        plans.append((plan_performance(project, asked, length, idle=False), length, False))
    total = sum(count_chunks(length) for _, length, _ in plans)
    done = 0

    def step() -> bool:
        nonlocal done
        done += 1
        if progress is not None:
            progress(done, total)
        return cancelled is not None and cancelled()

    limits = _own_limits(project)
    out: list[Problem] = []
    played = watch_plans(project, [(plan, length) for plan, length, _ in plans], step)
    for (plan, _, free), seen in zip(plans, played, strict=False):  # fewer, if it was cancelled
        out += _Findings(project, plan, seen, limits, free).problems()
    if cancelled is not None and cancelled():
        return _merged(out)
    return _merged([*out, *find_quiet_layers(project)])


def _ask_for_each(project: Project) -> tuple[list[Play], float]:
    """Return requests for every gesture, fidget and transition, one after another on each layer, and how
    long all of it takes.
    """
    asks: list[Play] = []
    longest = 0.0
    for layer in LAYERS:
        at = 1.0
        for action in project.graphs[layer].actions.values():
            if action.kind == "stance" or find_playable_motion(project, action) is None:
                continue
            asks.append(Play(id=f"rehearse {action.id}", action=action.id, layer=layer, at=at))
            start, end = project.span(action)
            at += seconds_played(action.kind, action.timing, start, end) + GAP
        longest = max(longest, at)
    return asks, longest + 2.0 if asks else 0.0


def _own_limits(project: Project) -> tuple[Array, Array]:
    """Return how fast each part goes in the clips, `[P]` m/s, and how its speed changes, `[P]` m/s2: the 99th
    percentile over all that plays.
    """
    roles = anatomy.project_roles(project)
    joints = [roles[part] for part in PARTS if part in roles]
    speeds, changes = [], []
    for _, at in play_clips(project):
        speeds.append(np.linalg.norm(np.diff(at[:, joints], axis=0), axis=-1) * RATE)
        changes.append(np.linalg.norm(np.diff(at[:, joints], 2, axis=0), axis=-1) * RATE**2)
    if not speeds:
        return np.zeros(len(joints)), np.zeros(len(joints))
    return np.percentile(np.concatenate(speeds), 99, axis=0), np.percentile(
        np.concatenate(changes), 99, axis=0
    )


class _Findings:
    """What is wrong with what was seen of one plan."""

    def __init__(
        self, project: Project, plan: Plan, seen: PlayedPoses, limits: tuple[Array, Array], free: bool
    ) -> None:
        """free: whether nobody asked for anything, so that a moment can be opened in the window."""
        self.project, self.plan, self.seen, self.free = project, plan, seen, free
        self.size = max(1e-6, project.skeleton.height / TALL) if project.skeleton is not None else 1.0
        self.speeds, self.changes = limits

    def problems(self) -> list[Problem]:
        found = [*self._jumps(), *self._added(), *self._fast(), *self._glides(), *self._skates()]
        found += [*self._floor(), *self._arms_inside()]
        return [*found, *self._never_seen()] if self.free else found

    def _cause(self, layer: Layer, time: float) -> _Cause:
        """Return what plays on a layer at a time."""
        of = self.plan.layers[layer]
        cue = of.cue_at(time)
        names = self.project.graphs[layer].stances
        if cue is not None:
            ident, name = cue.action.id, cue.action.name
            if time < cue.start + cue.blend_in:
                return _Cause((ident, "in"), phrase("'{name}' blends in", name=name), layer, True, ident)
            if time > cue.end - cue.blend_out:
                return _Cause((ident, "out"), phrase("'{name}' blends out", name=name), layer, True, ident)
            return _Cause((ident, "plays"), phrase("'{name}' plays", name=name), layer, False, ident)
        place = int(of.fade_starts.searchsorted(time, "right")) - 1
        if place < 0 or not of.rests:
            return _Cause(("", ""), phrase("the layer is at rest"), layer, False)
        rest = of.rests[place]
        stance = names[rest.stance].name if rest.stance in names else rest.action.name
        if place and time < rest.fade_start + rest.fade:
            words = phrase('the loop of "{stance}" takes over', stance=stance)
            return _Cause((rest.stance, "fade"), words, layer, True, rest.action.id, rest.stance)
        words = phrase('the loop of "{stance}" plays', stance=stance)
        return _Cause((rest.stance, "loop"), words, layer, False, rest.action.id, rest.stance)

    def _likely_cause(self, part: str, time: float, value: float = 0.0, rank: int = 0) -> _Cause:
        """Return the cause of what a part does, among the layers that move it: the clip that does nearly as
        much by itself, else what blends on the part's own layer, else on another, else what plays on its own.

        value: the part's speed, m/s, or with rank 1 how it changes, m/s2; 0 where that says nothing.
        """
        own = _LAYER_OF.get(part, "body")
        every = (own, *(x for x in LAYERS if x != own))
        layers = [x for x in every if self._moves(x, part)] or [own]
        causes = [self._cause(layer, time) for layer in layers]
        playing = [c for c in causes if c.key[0]]
        if value > 0 and len(playing) > 1:
            alone = [c for c in playing if OWN * value <= self._own_moves(part, time, c)[rank]]
            if alone:
                return alone[0]
        return next((c for c in causes if c.blending), next(iter(playing), causes[0]))

    def _moves(self, layer: Layer, part: str) -> bool:
        """Return whether a layer moves a part: the hips and what stands on them only with the legs."""
        return (
            part not in ("hips", "left_foot", "right_foot") or self.project.graphs[layer].weight("legs") > 0
        )

    def _worst(
        self, values: Array, limits: Array, part: int, rank: int = 0
    ) -> Iterator[tuple[int, float, _Cause, int]]:
        """Yield, for each cause, the frame where values `[F]` are largest of those above a limit, the value,
        and how often it happens. The values are speeds, or with rank 1 how they change by the next frame.
        """
        over = np.flatnonzero(values > limits[part])
        events = np.split(over, np.flatnonzero(np.diff(over) > 0.3 * RATE) + 1) if len(over) else []
        best: dict[tuple[str, str], tuple[int, float, _Cause, int]] = {}
        for event in events:
            n = int(event[np.argmax(values[event])])
            time = float(self.seen.times[n + rank])
            cause = self._likely_cause(self.seen.parts[part], time, float(values[n]), rank)
            known = best.get(cause.key)
            count = known[3] + 1 if known else 1
            if known is None or values[n] > known[1]:
                best[cause.key] = n, float(values[n]), cause, count
            else:
                best[cause.key] = (*known[:3], count)
        yield from best.values()

    def _problem(
        self,
        code: str,
        words: Phrase,
        remedy: Phrase,
        frame: int,
        cause: _Cause,
        severity: Severity = "warning",
    ) -> Problem:
        time = float(self.seen.times[frame])
        return Problem(
            severity,
            code,
            phrase("at {moment}, while {cause}: {what}", what=words, moment=_clock(time), cause=cause.words)
            if self.free
            else phrase("while {cause}: {what}", what=words, cause=cause.words),
            remedy,
            cause.layer,
            cause.stance,
            cause.action,
            moment=time if self.free else None,
        )

    def _jumps(self) -> Iterator[Problem]:
        places = self.seen.places
        changes = np.linalg.norm(np.diff(places, 2, axis=0), axis=-1) * RATE**2
        limits = np.maximum(USUAL * self.changes, JUMP * self.size)
        if "hips" in self.seen.parts:  # what the hips take along is not reported once more for each part
            part = self.seen.parts.index("hips")
            hips = changes[:, [part]]
            taken = (hips > limits[part]) & (hips >= OWN * changes)
            taken[:, part] = False
            changes = np.where(taken, 0.0, changes)
        for part, name in enumerate(self.seen.parts):
            for frame, value, cause, count in self._worst(changes[:, part], limits, part, 1):
                near = places[frame : frame + 3, part]
                far = 100 * float(np.linalg.norm(np.diff(near, axis=0), axis=-1).max())
                if OWN * value <= self._own_moves(name, float(self.seen.times[frame + 1]), cause)[1]:
                    ways = np.linalg.norm(
                        np.diff(places[max(0, frame - 3) : frame + 6, part], axis=0), axis=-1
                    )
                    yield self._own_jump(name, far, frame + 1, cause, bool(np.median(ways) < ways.max() / 4))
                    continue
                words = plural_phrase(
                    "{part} jumps {length:.0f} cm in a sixtieth of a second",
                    "{part} jumps {length:.0f} cm in a sixtieth of a second, {count:,} times",
                    count,
                    part=_NAMES[name],
                    length=far,
                )
                remedy = (
                    phrase("Lengthen the blend in the timing editor, or start the action nearer its stance.")
                    if cause.blending
                    else phrase("Look at the clip there: trim it, or smooth it in the program that made it.")
                )
                if name == "hips" and self._can_stay(cause.action):  # it walks, and begins again where it was
                    remedy = phrase("Keep the clip in place.")
                    yield self._problem("play-slide", words, remedy, frame + 1, cause, "error")
                    continue
                yield self._problem("play-jump", words, remedy, frame + 1, cause)

    def _own_moves(self, part: str, time: float, cause: _Cause) -> tuple[float, float]:
        """Return what a part does at a time in the clip that the cause plays, as `measure_own_moves`."""
        joint = anatomy.project_roles(self.project)[part]
        return measure_own_moves(self.project, self.plan, cause.layer, joint, time)

    def _own_jump(self, part: str, far: float, frame: int, cause: _Cause, alone: bool) -> Problem:
        """Return that a clip itself moves so fast. alone: whether it lasts a single moment, which no limb can
        do.
        """
        words = phrase(
            "{part} moves {length:.0f} cm in a sixtieth of a second, in the clip itself",
            part=_NAMES[part],
            length=far,
        )
        remedy = phrase("If that is a fault, trim the clip or smooth it in the program that made it.")
        return self._problem("clip-jump", words, remedy, frame, cause, "warning" if alone else "hint")

    def _added(self) -> Iterator[Problem]:
        """Yield where what is added to clips breaks the law of continuity."""
        skeleton = self.project.skeleton
        assert skeleton is not None
        for name, (ways, turns, breaks, joints) in self.seen.added.items():
            what, part, remedy = _ADDED[name]
            if not len(breaks) or breaks.max() <= 1:
                continue
            frame = int(np.argmax(breaks))
            words = phrase(
                "{what} move '{joint}' {length:.0f} cm and {angle:.0f} degrees in a sixtieth of a second "
                "beyond what the clips do",
                what=what,
                joint=skeleton.names[int(joints[frame])],
                length=100 * float(ways[frame]),
                angle=float(np.degrees(turns[frame])),
            )
            cause = self._likely_cause(part, float(self.seen.times[frame]))
            yield self._problem("play-added", words, remedy, frame, cause)

    def _fast(self) -> Iterator[Problem]:
        speeds = np.linalg.norm(np.diff(self.seen.places, axis=0), axis=-1) * RATE
        limits = np.maximum(USUAL * self.speeds, FAST * self.size)
        for part, name in enumerate(self.seen.parts):
            if name == "hips":
                continue
            for frame, value, cause, _ in self._worst(speeds[:, part], limits, part):
                own = self._own_moves(name, float(self.seen.times[frame]), cause)[0]
                if not cause.blending or OWN * value <= own:
                    continue
                words = phrase(
                    "{part} moves at {speed:.1f} m/s, but at most at {usual:.1f} m/s in the clips",
                    part=_NAMES[name],
                    speed=value,
                    usual=float(self.speeds[part]),
                )
                remedy = phrase("Lengthen the blend in the timing editor, or add a clip that leads there.")
                yield self._problem("play-fast", words, remedy, frame, cause)

    def _glides(self) -> Iterator[Problem]:
        if "hips" not in self.seen.parts:
            return
        part = self.seen.parts.index("hips")
        level = self.seen.places[:, part][:, (0, 2)]
        speeds = np.linalg.norm(np.diff(level, axis=0), axis=-1) * RATE
        limits = np.maximum(USUAL * self.speeds, SHIFTS * self.size)
        for frame, value, cause, _ in self._worst(speeds, limits, part):
            some = level[max(0, frame - round(RATE)) : frame + round(RATE)]
            far = float(np.linalg.norm(np.ptp(some, axis=0)))
            own = self._own_moves("hips", float(self.seen.times[frame]), cause)[0]
            if not cause.blending or far < SHIFTED * self.size or OWN * value <= own:
                continue
            if value < GLIDE * self.size or far < GLIDES * self.size:
                words = phrase(
                    "the body slides {length:.0f} cm at {speed:.1f} m/s", length=100 * far, speed=value
                )
                remedy = phrase("Lengthen the blend in the timing editor, or add a clip that leads there.")
                yield self._problem("play-sway", words, remedy, frame, cause)
                continue
            words = phrase("the body slides {length:.1f} m at {speed:.1f} m/s", length=far, speed=value)
            if self._can_stay(cause.action):
                remedy = phrase("Keep the clip in place, or add a clip that walks there.")
                yield self._problem("play-slide", words, remedy, frame, cause, "error")
            else:
                remedy = phrase(
                    "In the timing editor, end the action where its hips are back, or lengthen its blend."
                )
                yield self._problem("play-sway", words, remedy, frame, cause, "error")

    def _skates(self) -> Iterator[Problem]:
        """Yield where a foot that stands slides while poses blend, as the window marks it."""
        skeleton = self.project.skeleton
        if skeleton is None or not self.seen.feet_joints or not len(self.seen.times):
            return
        times, joints = self.seen.times, list(self.seen.feet_joints)

        def places_at(wanted: Array) -> Array:
            at = np.clip((wanted - times[0]) * RATE, 0, len(times) - 1)
            low = np.minimum(at.astype(int), max(0, len(times) - 2))
            high, part = np.minimum(low + 1, len(times) - 1), (at - low)[:, None, None]
            out = np.zeros((len(wanted), len(skeleton), 3))
            out[:, joints] = self.seen.feet[low] * (1 - part) + self.seen.feet[high] * part
            return out

        watch = FeetWatch(self.project, places_at, float(times[-1]), self.plan)
        layer = watch.layer
        best: dict[tuple[str, str], tuple[float, float, int, float, _Cause]] = {}
        for first, last in _join_spans(find_blends(self.plan.layers[layer]), SETTLES):
            numbers = range(max(0, floor(first * FEET_RATE)), ceil(min(last, times[-1]) * FEET_RATE) + 1)
            found = watch.at(numbers)
            for side in range(found.slides.shape[1] if len(found.times) else 0):
                slides = found.slides[:, side]
                over = slides > SKATE * self.size
                if not over.any():
                    continue
                n = int(np.argmax(slides))
                here = found.places[over, side][:, (0, 2)]
                far = float(np.linalg.norm(np.ptp(here, axis=0))) if over.sum() > 1 else float(slides[n]) / 4
                cause = self._cause(layer, float(found.times[n]))
                if far < SKATES * self.size or not cause.blending:
                    continue
                if cause.key not in best or best[cause.key][1] < slides[n]:
                    best[cause.key] = far, float(slides[n]), side, float(found.times[n]), cause
        for far, speed, side, time, cause in best.values():
            words = phrase(
                "{part} slides {length:.0f} cm at {speed:.2f} m/s while it stands",
                part=_NAMES[("left_foot", "right_foot")[side]],
                length=100 * far,
                speed=speed,
            )
            remedy = (
                phrase("Lengthen the blend in the timing editor, or add a clip that leads there.")
                if has_planted_feet(self.project)
                else phrase("Turn *Planted feet* up under Life.")
            )
            frame = int(np.clip(round((time - times[0]) * RATE), 0, len(times) - 1))
            yield self._problem("play-skate", words, remedy, frame, cause)

    def _can_stay(self, ident: str | None) -> bool:
        """Return whether keeping an action's clip in place takes out a way that it makes."""
        action = self.project.action(ident or "")
        clip = find_playable_motion(self.project, action) if action is not None else None
        if action is None or clip is None or self.project.skeleton is None:
            return False
        hips = anatomy.project_roles(self.project).get("hips", 0)
        far = measure_travel(clip, hips, *self.project.span(action))
        return not self.project.clips[action.clip].in_place and far > GLIDES * self.size

    def _floor(self) -> Iterator[Problem]:
        if not {"left_foot", "right_foot"} & set(self.seen.parts):
            return  # a figure without legs stands on nothing
        under, above = self.seen.lowest < -UNDER * self.size, self.seen.lowest > ABOVE * self.size
        sits = self.seen.sits
        for code, over in (
            ("play-under-floor", under),
            ("play-in-air", above & ~sits),
            ("play-no-seat", above & sits),
        ):
            frames = np.flatnonzero(over)
            if len(frames) < LONG * RATE:
                continue
            by: dict[tuple[str, str], list[int]] = {}
            causes: dict[tuple[str, str], _Cause] = {}
            for n in frames[:: round(RATE / 4)].tolist():
                cause = self._likely_cause("hips", float(self.seen.times[n]))
                by.setdefault(cause.key, []).append(n)
                causes[cause.key] = cause
            key = max(by, key=lambda k: len(by[k]))
            worst = max(by[key], key=lambda n: abs(float(self.seen.lowest[n])))
            far, share = 100 * abs(float(self.seen.lowest[worst])), len(frames) / len(self.seen.times)
            words = (
                phrase(
                    "the character is {length:.0f} cm under the floor for {share:.0f} % of the time",
                    length=far,
                    share=100 * share,
                )
                if code == "play-under-floor"
                else phrase(
                    "the character floats {length:.0f} cm above the floor for {share:.0f} % of the time",
                    length=far,
                    share=100 * share,
                )
            )
            remedy = phrase("Set the height of the clip in the program that made it, or skip the clip.")
            severity: Severity = "error" if share > LASTING else "warning"
            if code == "play-no-seat":
                words = phrase("the character sits with its feet {length:.0f} cm above the floor", length=far)
                remedy = phrase(
                    "Put a seat under it in your scene, or lower the clip in the program that made it."
                )
                severity = "hint"
            yield self._problem(code, words, remedy, worst, causes[key], severity)

    def _arms_inside(self) -> Iterator[Problem]:
        over = self.seen.inside > INSIDE * self.size
        if over.sum() < LONG * RATE:
            return
        frame = int(np.argmax(self.seen.inside))
        deep, share = 100 * float(self.seen.inside[frame]), 100 * float(over.mean())
        words = phrase(
            "an arm is {length:.0f} cm inside the body; arms are inside it for {share:.0f} % of the time",
            length=deep,
            share=share,
        )
        if share < 0.5:
            words = phrase("an arm is {length:.0f} cm inside the body for a moment", length=deep)
        remedy = (
            phrase("Skip the action in this stance, or move the arm away in its clip.")
            if self.project.touch.guard
            else phrase(
                "Turn on *Keep hands out of the body* under Life, or skip the gesture in this stance."
            )
        )
        yield self._problem(
            "play-arm-inside",
            words,
            remedy,
            frame,
            self._likely_cause("left_hand", float(self.seen.times[frame])),
        )

    def _never_seen(self) -> Iterator[Problem]:
        if len(self.seen.times) < 60 * LEAST_MINUTES * RATE:
            return
        for layer, plan in self.plan.layers.items():
            graph = self.project.graphs[layer]
            shown = {rest.stance for rest in plan.rests} | {cue.then for cue in plan.cues}
            missing = [s for s in graph.stances.values() if s.id not in shown]
            if not missing or len(graph.stances) < 2 or not plan.rests:
                continue
            names = join_phrases([phrase('"{name}"', name=s.name) for s in missing[:3]], ", ")
            more = len(missing) - 3
            if more > 0:
                names = plural_phrase(
                    "{names} and {count:,} more", "{names} and {count:,} more", more, names=names
                )
            words = phrase(
                "{names}: never reached in {minutes:.0f} minutes",
                names=names,
                minutes=float(self.seen.times[-1]) / 60,
            )
            yield Problem(
                "hint",
                "play-never",
                words,
                phrase("Raise the likelihood of a transition that leads there, or request the stance."),
                layer,
                missing[0].id,
            )


def _merged(problems: Sequence[Problem]) -> list[Problem]:
    """Return problems, errors first; of those with one code at one place only the first, which is of the
    untouched performance where both show it.
    """
    first: dict[Any, Problem] = {}
    for p in problems:
        first.setdefault((p.code, p.layer, p.action or p.stance), p)
    order = {"error": 0, "warning": 1, "hint": 2}
    return sorted(first.values(), key=lambda p: order[p.severity])


def _join_spans(spans: Iterable[tuple[float, float]], apart: float) -> list[tuple[float, float]]:
    """Return spans in order, with those that are less than some seconds apart as one."""
    out: list[tuple[float, float]] = []
    for first, last in sorted(spans):
        if last <= first:
            continue
        if out and first - out[-1][1] < apart:
            out[-1] = out[-1][0], max(out[-1][1], last)
        else:
            out.append((first, last))
    return out


def _clock(seconds: float) -> str:
    return f"{int(seconds // 60)}:{seconds % 60:04.1f}"
