"""Find the problems of a project: where they are, what they are, what to do about them. The project does not
change.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import isfinite
from typing import Any

from numpy.typing import NDArray

from metagraph.common.network_paths import ANOTHER, explain_refusal, recover_original_path
from metagraph.common.wording import phrase
from metagraph.graph import anatomy
from metagraph.graph.checks import end_gaps
from metagraph.graph.checks.base import check_base, get_stance_name
from metagraph.graph.checks.parameters import check_parameters
from metagraph.graph.editing.one_sided import check_limbs
from metagraph.graph.expand import find_reachable
from metagraph.graph.manual.check import check_manual
from metagraph.graph.model import KINDS, LAYERS, Action, ClipEntry, MetaGraph, Project
from metagraph.graph.problem import Problem, Severity
from metagraph.graph.repeating import LEAST_CYCLE, LONGEST_REPEAT, cycle_of, seconds_played
from metagraph.motion.in_place import measure_travel

Array = NDArray[Any]

# Metres over the ground, of a figure `end_gaps.TALL` high, that an action may end from where it begins: a
# step within a transition is made good while it blends.
TRAVELS = {"stance": 0.1, "gesture": 0.3, "fidget": 0.3, "transition": 0.6}
SEEN = 0.2  # of an action, that is to play without a blend


def check_project(project: Project) -> list[Problem]:
    """Return every problem, errors first, otherwise in the order of the project."""
    found = [*_clips(project), *check_base(project), *_character(project)]
    for layer in LAYERS:
        found += _graph(project, project.graphs[layer])
    found += check_limbs(project)
    found += check_parameters(project)
    if project.manual:
        found += check_manual(project)
    elif project.clips and not any(project.graphs[layer].stances for layer in LAYERS):
        found.append(
            Problem(
                "hint",
                "no-stance",
                phrase("nothing plays yet"),
                phrase("Drop a resting clip in the middle of a layer to make its first stance."),
            )
        )
    order = {"error": 0, "warning": 1, "hint": 2}
    return sorted(found, key=lambda p: order[p.severity])


def list_grave_problems(problems: Iterable[Problem], strict: bool = False) -> list[Problem]:
    """Return the problems for which a command fails: errors and unreachable stances; also warnings if
    `strict`.
    """
    return [
        p
        for p in problems
        if p.severity == "error" or p.code == "unreachable" or (strict and p.severity == "warning")
    ]


def _why_missing(entry: ClipEntry) -> tuple[str, str]:
    """Return the reason why a clip has no motion, and the remedy."""
    path = recover_original_path(entry.path)
    if path != entry.path:
        return (
            phrase("the file of clip '{name}' was not opened: {why} ({path})",
                 name=entry.name, why=explain_refusal(path) or ANOTHER, path=path),
            phrase("If you trust the project, choose 'Files on other computers', or use --network on the "
                   "command line."),
        )  # fmt: skip
    return (
        phrase("the file of clip '{name}' is missing ({path})", name=entry.name, path=path),
        phrase("Put the file back, or choose 'Find missing files' and select its new location."),
    )


def _clips(project: Project) -> Iterator[Problem]:
    for entry in project.clips.values():
        if entry.motion is None:
            used = entry.id in project.uses or entry.id in project.drawn
            yield Problem(
                "error" if used else "warning",
                "file-missing",
                *_why_missing(entry),
                clip=entry.id,
            )
        elif project.skeleton is not None and entry.motion.skeleton != project.skeleton:
            yield Problem(
                "error" if project.uses.get(entry.id) else "warning",
                "other-skeleton",
                phrase(
                    "clip '{name}' has a different skeleton (it has {count} joints, the project has {own})",
                    name=entry.name,
                    count=len(entry.motion.skeleton),
                    own=len(project.skeleton),
                ),
                phrase("Import its file again to retarget it, or remove the clip."),
                clip=entry.id,
            )


def _character(project: Project) -> Iterator[Problem]:
    if project.skeleton is None or not any(project.graphs[layer].actions for layer in LAYERS):
        return
    found = anatomy.project_parts(project)
    for part in ("arms", "head", "legs", "spine"):
        if part not in found:
            yield Problem(
                "warning",
                "no-part",
                phrase("no joint of the skeleton is recognised as {part}", part=phrase(part)),
                phrase("Open 'Skeleton' and assign the joints."),
            )


def _graph(project: Project, graph: MetaGraph) -> Iterator[Problem]:
    layer = graph.layer
    led_to = find_reachable(graph, graph.start or "")
    for stance in graph.stances.values():

        def at(
            severity: Severity, code: str, message: str, remedy: str, stance_id: str = stance.id
        ) -> Problem:
            return Problem(severity, code, message, remedy, layer, stance_id)

        if not graph.of(stance.id, "stance"):
            yield at(
                "error",
                "no-loop",
                phrase("stance '{name}' has no loop", name=stance.name),
                phrase("Drop a resting clip on the middle node."),
            )
        for kind in KINDS[1:3]:
            if not graph.of(stance.id, kind):
                yield at(
                    "hint",
                    f"no-{kind}s",
                    phrase("stance '{name}' has no gestures", name=stance.name)
                    if kind == "gesture"
                    else phrase("stance '{name}' has no fidgets", name=stance.name),
                    phrase("Drop clips on its Gesture node.")
                    if kind == "gesture"
                    else phrase("Drop clips on its Fidget node."),
                )
        if len(graph.stances) > 1 and not any(
            a.end_stance in graph.stances for a in graph.of(stance.id, "transition")
        ):
            yield at(
                "warning",
                "dead-end",
                phrase("stance '{name}' has no transition out of it", name=stance.name),
                phrase("Drop a clip on its Transition node."),
            )
        if graph.start in graph.stances and stance.id not in led_to:
            yield at(
                "warning",
                "unreachable",
                phrase("stance '{name}' cannot be reached", name=stance.name),
                phrase("Add a transition from another stance that ends in it."),
            )
    if graph.actions and graph.start not in graph.stances:
        yield Problem(
            "error",
            "no-start",
            phrase("the {layer} layer has no start stance", layer=phrase(layer)),
            phrase("Right-click a stance and choose 'Start here'."),
            layer,
        )
    for part, weight in graph.weights.items():
        if not 0 <= weight <= 2:
            yield Problem(
                "error",
                "weight",
                phrase(
                    "the {layer} layer's weight for {part} is {weight:g}",
                    layer=phrase(layer),
                    part=part,
                    weight=weight,
                ),
                phrase("Set it between 0 and 2."),
                layer,
            )
    for action in graph.actions.values():
        yield from _ActionCheck(project, graph, action).problems()


class _ActionCheck:
    """Finds what is wrong with one action."""

    def __init__(self, project: Project, graph: MetaGraph, action: Action) -> None:
        self.project, self.graph, self.action = project, graph, action
        self.timing = action.timing

    def at(self, severity: Severity, code: str, message: str, remedy: str) -> Problem:
        action = self.action
        words = phrase("'{name}' {message}", name=action.name, message=message)
        return Problem(severity, code, words, remedy, self.graph.layer, action.stance, action.id, action.clip)

    def problems(self) -> Iterator[Problem]:
        """Yield all problems. Without its clip, its times are not checked."""
        yield from self.places()
        yield from self.choice()
        entry = self.project.clips.get(self.action.clip)
        if entry is None:
            yield self.at(
                "error",
                "lost-clip",
                phrase("uses a clip that is not in the project"),
                phrase("Remove it, or import the clip again."),
            )
            return
        if self.action.clip_name:
            yield self.at(
                "error",
                "swapped-clip",
                phrase(
                    "was made from clip '{was}' but now plays '{name}'",
                    was=self.action.clip_name,
                    name=entry.name,
                ),
                phrase(
                    "In Problems, choose which of the two clips it plays, with the button or in the row's "
                    "menu."
                ),
            )
        end = entry.duration if self.timing.end is None else self.timing.end
        yield from self.played(entry, end)
        yield from self.repeats(end)
        yield from self.blends()
        yield from self.exit(end)
        yield from self.length(entry)
        yield from self.moments(end)
        yield from self.travel()
        yield from self.ends()

    def places(self) -> Iterator[Problem]:
        """Yield what is wrong with the stances that it leaves and enters."""
        action, graph = self.action, self.graph
        if action.stance not in graph.stances:
            yield self.at(
                "error",
                "lost-stance",
                phrase("belongs to a stance that no longer exists"),
                phrase("Move it to a stance, or remove it."),
            )
        if action.kind != "transition":
            return
        if action.end_stance is None:
            yield self.at(
                "error",
                "no-end",
                phrase("is a transition without an end stance"),
                phrase("Choose the stance that it ends in."),
            )
        elif action.end_stance not in graph.stances:
            yield self.at(
                "error",
                "lost-end",
                phrase("ends in a stance that no longer exists"),
                phrase("Choose another end stance."),
            )
        elif action.end_stance == action.stance:
            yield self.at(
                "warning",
                "circle",
                phrase("ends in the stance that it starts from"),
                phrase("Choose another end stance, or turn it into a gesture."),
            )

    def choice(self) -> Iterator[Problem]:
        """Yield what is wrong with its likelihood and with the joints it moves."""
        action = self.action
        if not (isfinite(action.likelihood) and action.likelihood > 0):
            yield self.at(
                "error",
                "likelihood",
                phrase("has likelihood {likelihood:g} and never plays", likelihood=action.likelihood),
                phrase("Set it to more than 0."),
            )
        if unknown := anatomy.list_unknown_joints(self.project.skeleton, action):
            yield self.at(
                "error",
                "mask",
                phrase("moves joint '{unknown}', which the skeleton does not have", unknown=unknown[0]),
                phrase("Choose its joints again."),
            )

    def played(self, entry: ClipEntry, end: float) -> Iterator[Problem]:
        """Yield what is wrong with the part of its clip that plays, up to `end` seconds."""
        timing = self.timing
        tolerance = 0.5 / entry.fps
        latest = entry.duration + tolerance
        blends = timing.blend_in + timing.blend_out
        length = seconds_played(self.action.kind, timing, timing.start, end)
        repeats = cycle_of(self.action.kind, timing, timing.start, end) > 0
        held = self.action.kind == "stance"  # in a single frame
        if not (0 <= timing.start <= latest and end <= latest):  # also true if one of them is NaN
            yield self.at(
                "error",
                "trim",
                phrase(
                    "plays {start:.2f} to {end:.2f} s, but its clip is {duration:.2f} s long",
                    start=timing.start,
                    end=end,
                    duration=entry.duration,
                ),
                phrase("Move start and end inside the clip."),
            )
        elif end <= timing.start and entry.frames > 1 and not (held and end == timing.start):
            yield self.at(
                "error",
                "empty",
                phrase(
                    "ends at {end:.2f} s, which is not after its start at {start:.2f} s",
                    end=end,
                    start=timing.start,
                ),
                phrase("Move its end after its start."),
            )
        elif self.action.kind != "stance" and _sound(blends) and blends > length + tolerance:
            yield self.at(
                "warning",
                "blend",
                phrase(
                    "blends for {blends:.2f} s but is only {length:.2f} s long",
                    blends=blends,
                    length=length,
                ),
                phrase("Shorten its blends."),
            )
        elif self.action.kind in ("gesture", "fidget") and entry.frames > 1 and blends > (1 - SEEN) * length:
            yield self.at(
                "warning",
                "hardly-seen",
                phrase(
                    "is hardly seen: {blends:.2f} of its {length:.2f} s are blends",
                    blends=blends,
                    length=length,
                ),
                phrase("Shorten its blends, or let it repeat for longer.")
                if repeats
                else phrase("Let it repeat, shorten its blends, or use a clip that plays it several times."),
            )

    def repeats(self, end: float) -> Iterator[Problem]:
        """Yield a hint if it does not repeat as it is set to."""
        timing, length = self.timing, end - self.timing.start
        if self.action.kind not in ("gesture", "fidget") or timing.repeat <= 0:
            return
        if 0 < length < LEAST_CYCLE:
            yield self.at(
                "hint",
                "short-cycle",
                phrase("plays once: a part of {length:.2f} s is too short to repeat", length=length),
                phrase("Move its start and end farther apart, or turn off Repeats."),
            )
        elif length >= LEAST_CYCLE and timing.repeat > LONGEST_REPEAT:
            yield self.at(
                "hint",
                "long-repeat",
                phrase(
                    "is set to repeat for {wanted:.0f} s, and plays {most:.0f} s of them",
                    wanted=timing.repeat,
                    most=LONGEST_REPEAT,
                ),
                phrase("Set a shorter time. A request can still ask for a longer duration."),
            )

    def blends(self) -> Iterator[Problem]:
        """Yield a problem for each blend with an impossible length."""
        blend_in, blend_out = self.timing.blend_in, self.timing.blend_out
        if not _sound(blend_in):
            yield self.at(
                _severity(blend_in),
                "blend",
                phrase("has a blend in of {blend:g} s", blend=blend_in),
                phrase("Set its blend in to 0 s or more."),
            )
        if not _sound(blend_out):
            yield self.at(
                _severity(blend_out),
                "blend",
                phrase("has a blend out of {blend:g} s", blend=blend_out),
                phrase("Set its blend out to 0 s or more."),
            )

    def exit(self, end: float) -> Iterator[Problem]:
        """Yield a problem if it may be left at a time that does not play."""
        earliest = self.timing.earliest_exit
        if earliest is not None and not self.timing.start <= earliest <= end:
            yield self.at(
                "warning",
                "exit",
                phrase(
                    "has its earliest exit at {earliest_exit:.2f} s, outside the part that plays",
                    earliest_exit=earliest,
                ),
                phrase("Move the earliest exit between start and end."),
            )

    def length(self, entry: ClipEntry) -> Iterator[Problem]:
        """Yield a problem if it was timed on a clip of another length."""
        if entry.timed_on:
            yield self.at(
                "warning",
                "other-length",
                phrase(
                    "was timed on a clip of {before:.2f} s; its file has {after:.2f} s since it changed",
                    before=entry.timed_on,
                    after=entry.duration,
                ),
                phrase("Scale its times, or keep them."),
            )

    def moments(self, end: float) -> Iterator[Problem]:
        """Yield a problem if its stroke, or another of its phases, does not play."""
        timing = self.timing
        for seconds in (timing.stroke, timing.ready, timing.stroke_end, timing.relax):
            if seconds is not None and not timing.start <= seconds <= end:
                yield self.at(
                    "error",
                    "moment",
                    phrase(
                        "has its stroke at {stroke:.2f} s, but plays {start:.2f} to {end:.2f} s",
                        stroke=seconds,
                        start=timing.start,
                        end=end,
                    )
                    if seconds == timing.stroke
                    else phrase(
                        "has a phase of its stroke at {seconds:.2f} s, but plays {start:.2f} to {end:.2f} s",
                        seconds=seconds,
                        start=timing.start,
                        end=end,
                    ),
                    phrase("Move the stroke inside, or clear it."),
                )
                return

    def travel(self) -> Iterator[Problem]:
        """Yield a problem if its hips end elsewhere over the ground, so that the character slides back."""
        motion = end_gaps.get_action_motion(self.project, self.action)
        if motion is None or self.project.skeleton is None or self.graph.weight("legs") <= 0:
            return
        hips = anatomy.project_roles(self.project).get("hips", 0)
        start, end = self.project.span(self.action)
        far = measure_travel(motion, hips, start, end)
        size = max(self.project.skeleton.height, 1e-6) / end_gaps.TALL
        if far > TRAVELS[self.action.kind] * size:
            yield self.at(
                "warning",
                "travels",
                phrase("moves {length:.1f} m in each loop, and jumps back at its end", length=far)
                if self.action.kind == "stance"
                else phrase("ends {length:.1f} m from where it begins, and slides back", length=far),
                phrase("Move its start and end to where its hips are over the same spot.")
                if self.project.clips[self.action.clip].in_place
                else phrase("Keep the clip in place."),
            )

    def ends(self) -> Iterator[Problem]:
        """Compare its clip's ends with the stances that it leaves and enters, on the joints its
        layer moves.
        """
        project, graph, action = self.project, self.graph, self.action
        if action.kind == "stance":
            gap = end_gaps.measure_seam(project, graph, action)
            if gap is not None and gap.far and action.timing.blend_in <= 0:
                yield self.at(
                    "warning",
                    "open-loop",
                    phrase(
                        "does not loop smoothly: its start and end are {far:.0f} cm apart",
                        far=gap.metres * 100,
                    ),
                    phrase("Blend the loop seam (blend in), or trim the clip so that it loops."),
                )
            return
        for gap in end_gaps.find_end_gaps(project, graph, action):
            if gap.far:
                yield self.at(
                    "warning",
                    "far-start" if gap.edge == "begins" else "far-end",
                    end_gaps.describe_gap(gap, get_stance_name(project, gap.stance)),
                    phrase("Trim it, lengthen its blend, or move it to a stance that it fits."),
                )


def _sound(seconds: float) -> bool:
    return isfinite(seconds) and seconds >= 0


def _severity(blend: float) -> Severity:
    return "warning" if isfinite(blend) else "error"  # a negative blend plays as none
