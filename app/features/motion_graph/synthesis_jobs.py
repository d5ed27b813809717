"""What the motion graph's window works with: takes of a project with what was heard during them, new motion,
clips kept as files.

Pure functions and values; whoever calls them does so on a job's thread.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from app.features.motion_graph.soft_wishes import read_side_prosody
from app.translation import tr, tr_phrase, tr_plural
from metagraph.graph.conversation.model import SOUNDS, Segment, Side, Sound, list_segments_heard_by
from metagraph.graph.model import Project
from metagraph.motion.clip import Clip

if TYPE_CHECKING:
    from metagraph.synthesis.search.path_quality import PathQuality
    from metagraph.synthesis.soft_constraints import SoftWish

FOLDER = "motion-graph"  # beside the project file, where new clips are kept
LONG = 6.0  # seconds from which a clip is a take; shorter ones are chosen by hand
LEAST, MOST = 1.0, 8.0  # seconds of clips cut from takes


@dataclass(frozen=True, eq=False)
class ChosenTakes:
    """clips: those with motion, of one skeleton. ids: theirs. speech: what was heard during each, none if
    nobody knows. sides: of the conversation each was recorded along with.
    """

    ids: tuple[str, ...]
    clips: tuple[Clip, ...]
    speech: tuple[tuple[Segment, ...], ...]
    sides: tuple[Side | None, ...] = ()

    @property
    def frames(self) -> int:
        return sum(clip.frames for clip in self.clips)

    @property
    def told(self) -> bool:
        """Whether anything was heard during any of them."""
        return any(self.speech)


def list_usable_clips(project: Project) -> list[str]:
    """Return the clips that can be takes: with motion, of the project's skeleton, more than one frame; the
    longest first.
    """
    fitting = [
        e
        for e in project.clips.values()
        if e.motion is not None and e.motion.skeleton == project.skeleton and e.frames > 1
    ]
    return [e.id for e in sorted(fitting, key=lambda e: (-e.duration, e.name))]


def find_recorded_side(project: Project, clip: str) -> tuple[str, int] | None:
    """Return the conversation and side that were recorded along with a clip."""
    return next(
        ((i, n) for i, c in project.conversations.items() for n, s in enumerate(c.sides) if s.take == clip),
        None,
    )


def describe_unusable_clips(project: Project) -> str:
    """Return which clips cannot be takes, and why, in words; "" if all can."""
    moving = [e for e in project.clips.values() if e.motion is not None]
    alike = [e for e in moving if e.motion is not None and e.motion.skeleton == project.skeleton]
    still = sum(e.frames <= 1 for e in alike)
    reasons = (
        (still, tr("with only one frame")),
        (len(moving) - len(alike), tr("with another skeleton")),
        (len(project.clips) - len(moving), tr("with a missing file")),
    )
    told = [
        f"{tr_plural('{count:,} clip', '{count:,} clips', count)} {why}" for count, why in reasons if count
    ]
    return tr("Skipped: {told}.", told=", ".join(told)) if told else ""


def cut_to_take(heard: Sequence[Segment], seconds: float) -> tuple[Segment, ...]:
    """Return what was heard while a take lasted: what goes on after its end is cut there."""
    out = []
    for s in heard:
        if s.start < seconds:
            peak = s.peak if s.peak is not None and s.peak < seconds else None
            out.append(s if s.end <= seconds else msgspec.structs.replace(s, end=seconds, peak=peak))
    return tuple(out)


def choose_takes(project: Project, ids: Collection[str]) -> ChosenTakes:
    """Return the chosen clips as takes; those without motion are left out."""
    found = [i for i in list_usable_clips(project) if i in ids]
    speech, sides = [], []
    for ident in found:
        recorded = find_recorded_side(project, ident)
        heard = (
            list_segments_heard_by(project.conversations[recorded[0]], recorded[1])
            if recorded is not None
            else ()
        )
        speech.append(cut_to_take(heard, project.clips[ident].duration))
        sides.append(project.conversations[recorded[0]].sides[recorded[1]] if recorded is not None else None)
    return ChosenTakes(
        tuple(found),
        tuple(m for i in found if (m := project.clips[i].motion) is not None),
        tuple(speech),
        tuple(sides),
    )


@dataclass(frozen=True, slots=True)
class Wish:
    """What new motion is to go with. segments: what is heard. exact: the best path there is, else the paper's
    greedy search. use: the kinds of segment that constrain; peaks: whether stresses have to be met;
    tolerance: seconds. seed: of the greedy search. soft: what it should have beside that, for which side is
    who speaks, whole all it moves with, and start the second of it at which the segments begin.
    """

    seconds: float
    segments: tuple[Segment, ...] = ()
    exact: bool = True
    use: tuple[Sound, ...] = SOUNDS
    peaks: bool = True
    tolerance: float = 0.1
    seed: int = 1
    edges: bool = True
    soft: SoftWish | None = None
    side: Side | None = None
    whole: tuple[Segment, ...] = ()
    start: float = 0.0


@dataclass(frozen=True, eq=False)
class FoundMotion:
    """A new motion. took: seconds of search. beside: how well it meets the preferences, in words."""

    clip: Clip
    cost: float
    jumps: int
    took: float
    looks: PathQuality
    given_up: str = ""
    beside: str = ""

    def words(self) -> str:
        rate = self.jumps / max(self.clip.duration, 1e-9)
        jumps = (
            tr("no transition")
            if not self.jumps
            else tr("{jumps} transitions, {rate:.2f} a second", jumps=self.jumps, rate=rate)
            if self.jumps > 1
            else tr_plural("{count:,} transition", "{count:,} transitions", 1)
        )
        again = tr(
            "{repeated:.0f} % of it repeats within 3 s, {rest}",
            repeated=100 * self.looks.repeated,
            rest=tr_phrase(self.looks.rest_words()),
        )
        found = tr("found in {took:.2f} s", took=self.took)
        given_up = _as_sentence(self.given_up)
        beside = _as_sentence(self.beside)
        return tr(
            "{duration:.1f} s with {jumps}, cost {cost:.3g} m, {found}; {again}.{given_up}{beside}",
            duration=self.clip.duration,
            jumps=jumps,
            cost=self.cost,
            found=found,
            again=again,
            given_up=given_up,
            beside=beside,
        )


def _as_sentence(words: str) -> str:
    """Return words of the domain in the window's language, as a sentence after a blank; "" for none."""
    shown = tr_phrase(words)
    return f" {shown[0].upper()}{shown[1:]}." if shown else ""


def synthesise(
    graph: Any,
    takes: ChosenTakes,
    wish: Wish,
    name: str,
    cancelled: Callable[[], bool] | None = None,
    folder: Path | None = None,
) -> FoundMotion:
    """Return motion of the takes that goes with what is wished. folder: of the project, where sounds are
    looked for. Raises SynthesisError when there is none, saying what would help, or when it was cancelled;
    FileError where a sound that is needed cannot be read.
    """
    from metagraph.synthesis.assemble import assemble
    from metagraph.synthesis.constraints import find_heard_at
    from metagraph.synthesis.search.path_quality import measure_quality
    from metagraph.synthesis.search.relaxing import Constraints, Searching, answer_speech
    from metagraph.synthesis.soft_constraints import NOTHING, SoftMaterial, make_soft_report

    said = find_heard_at(graph.states, takes.speech)
    # Takes nobody annotated went with anything.
    use = wish.use if takes.told else ()
    asked = Constraints(wish.tolerance, use, wish.peaks and takes.told, wish.edges)
    searching = Searching("exact" if wish.exact else "greedy", wish.seed)
    began = time.perf_counter()
    soft = NOTHING
    if wish.soft is not None and wish.soft.asks and wish.side is not None:
        theirs = [
            read_side_prosody(side, speech, folder, wish.soft)
            for side, speech in zip(takes.sides, takes.speech, strict=True)
        ]
        material = SoftMaterial(wish.soft, graph.states, takes.clips, theirs, graph.threshold.limit)
        new = read_side_prosody(wish.side, wish.whole, folder, wish.soft)
        soft = material.constraints(new, wish.start, wish.seconds, wish.tolerance)
    found = answer_speech(graph, said, wish.segments, wish.seconds, asked, searching, cancelled, soft)
    took, path = time.perf_counter() - began, found.path
    made = assemble(graph.states, takes.clips, path, name, retiming=found.retiming)
    beside = make_soft_report(soft, graph.states, path, found.retiming).told()
    looks = measure_quality(graph.states, path)
    return FoundMotion(made, path.cost, len(path.jumps), took, looks, found.words(), beside)


def count_graph_states(
    takes: ChosenTakes,
    ks: Sequence[int],
    level: float,
    progress: Callable[[int, int], None],
    cancelled: Callable[[], bool],
) -> Mapping[int, tuple[int, int, int, int]]:
    """Return for each k: states, transitions, then both after the states were removed that lead nowhere (the
    paper's table 2).
    """
    from metagraph.synthesis.constraints import find_change_states
    from metagraph.synthesis.graph import build_graph, find_threshold
    from metagraph.synthesis.states import key_states, read_states

    states = read_states(takes.clips)
    keys = key_states(states, changes=find_change_states(states, takes.speech))
    out = {}
    for n, k in enumerate(ks):
        progress(n, len(ks))
        limit = find_threshold(states, k, level)
        whole = build_graph(states, limit, keys, connected=False, cancelled=cancelled)
        try:
            kept = build_graph(states, limit, keys, cancelled=cancelled).size
        except ValueError:  # nothing is left of it
            kept = (0, 0)
        out[k] = (*whole.size, *kept)
    return out
