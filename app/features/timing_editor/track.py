"""What the editor shows of one action: all that is computed, made again only when what it rests on has
changed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from numpy.typing import NDArray

from app.look.names import make_readable_name
from app.translation import format_number, tr, tr_phrase
from app.widgets.memo import Once
from app.widgets.vocabulary import get_vocabulary_word
from metagraph.graph import anatomy
from metagraph.graph.checks import end_gaps
from metagraph.graph.clip_source import get_clip_course
from metagraph.graph.model import Action, ClipEntry, Project, Timing
from metagraph.motion.retime import Hold
from metagraph.playback.timing.handles import WORDS, Handle, PhaseBlock, find_blocks, list_handles
from metagraph.playback.timing.speed_curves import SpeedCurve, find_curves, measure_action_speed
from metagraph.suggest.jumps.found import Curves
from metagraph.suggest.jumps.seen_jumps import SeenJumps, describe_ends, find_far_ends
from metagraph.suggest.stances.stance_distance import (
    StanceDistance,
    measure_stance_distance,
    measure_stance_distances,
)

Array = NDArray[Any]


@dataclass(frozen=True)
class Stay:
    """A hold of the clip. hold: as it is kept. first, last: seconds of the clip as it plays."""

    hold: Hold
    first: float
    last: float


@dataclass(frozen=True)
class KeptHand:
    """A hand that is kept on the body. place: among the clip's. hand: whose row it is in, in words. to: the
    joint it stays at. first, last: seconds of the clip as it plays.
    """

    place: int
    hand: str
    to: str
    first: float
    last: float

    def with_end(self, end: str, seconds: float) -> KeptHand:
        """Return it with its "first" or its "last" somewhere else."""
        return replace(self, first=seconds) if end == "first" else replace(self, last=seconds)


@dataclass(frozen=True, eq=False)
class Facts:
    """An action as it is now. name: what it is called where its stance is clear. speeds `[F]`: of what it
    moves, which snapping goes by. curves: those that are drawn. seen: what is known of its jumps. verdict: in
    words; fine: whether nothing shows. stays: where the clip is held. kept: where a hand is kept on the body.
    """

    action: Action
    name: str
    entry: ClipEntry
    span: tuple[float, float]
    handles: tuple[Handle, ...]
    blocks: tuple[PhaseBlock, ...]
    speeds: Array
    curves: tuple[SpeedCurve, ...]
    seen: SeenJumps | None
    distance: StanceDistance
    verdict: str
    fine: bool
    stays: tuple[Stay, ...] = ()
    kept: tuple[KeptHand, ...] = ()

    @property
    def hands(self) -> tuple[str, ...]:
        """The hands that are kept somewhere; each has a row."""
        return tuple(dict.fromkeys(kept.hand for kept in self.kept))

    def handle(self, name: str) -> Handle | None:
        return next((h for h in self.handles if h.name == name), None)

    def speed_at(self, seconds: float) -> float:
        """Return the speed at a moment, metres a second."""
        frame = round(seconds * self.entry.fps)
        return float(self.speeds[min(max(frame, 0), len(self.speeds) - 1)]) if len(self.speeds) else 0.0

    @property
    def top(self) -> float:
        """Metres a second that the curves reach up to."""
        return max([0.2, *(float(c.speeds.max()) for c in self.curves if len(c.speeds))])


class TimingTrack:
    """ident: of the action. The slow parts - speeds, distances - rest on its clip and its stances, not on its
    times, so that a drag makes nothing of them again.
    """

    def __init__(self, ident: str) -> None:
        self.ident = ident
        self._curves: Once[tuple[tuple[SpeedCurve, ...], Array]] = Once()
        self._far: Once[tuple[Array, Array, Array]] = Once()
        self._facts: Once[Facts | None] = Once()

    def facts(self, project: Project, joint: str, curves: Callable[[Action], Curves | None]) -> Facts | None:
        """Return what is shown of its action; None if that or its clip is gone. joint: whose curve is drawn,
        "" for what the action moves. curves: gives what is known of its jumps.
        """
        action = project.action(self.ident)
        entry = project.clips.get(action.clip) if action is not None else None
        if action is None or entry is None:
            return None
        known = curves(action)
        return self._facts.of(
            (action, joint), (project, known), lambda: self._make(project, action, entry, joint, known)
        )

    def _make(
        self, project: Project, action: Action, entry: ClipEntry, joint: str, known: Curves | None
    ) -> Facts:
        timeless = (
            replace(action, timing=Timing(start=project.span(action)[0]))
            if action.kind == "stance"
            else replace(action, timing=Timing())
        )
        curves, speeds = self._curves.of(
            (action.clip, action.layer, action.limb, joint, tuple(project.roles.items())),
            (entry.motion, project.skeleton),
            lambda: (find_curves(project, action, joint), measure_action_speed(project, action)[0]),
        )
        graph = project.graphs[action.layer]
        loops = tuple(a for s in (action.stance, action.end_stance) if s for a in graph.of(s, "stance")[:1])
        both = self._far.of(
            (timeless, loops, tuple(graph.weights.items())),
            (entry.motion, *(end_gaps.get_action_motion(project, a) for a in loops)),
            lambda: measure_stance_distance(project, action),
        )
        seen = SeenJumps(action, known) if known is not None else None
        words, fine = _verdict(project, action, seen)
        stance = project.stance(action.stance)
        limb = action.limb if action.layer == "arms" else None
        return Facts(
            action,
            make_readable_name(action.name, stance.name if stance is not None else "", limb),
            entry,
            project.span(action),
            list_handles(project, action),
            find_blocks(project, action),
            speeds,
            curves,
            seen,
            measure_stance_distances(project, action, seen, both),
            words,
            fine,
            list_stays(entry),
            list_kept_hands(project, entry),
        )


def list_kept_hands(project: Project, entry: ClipEntry) -> tuple[KeptHand, ...]:
    """Return where hands are kept on the body."""
    course = get_clip_course(entry) if entry.retime.contacts else None
    if course is None:
        return ()
    roles, names = (
        anatomy.project_roles(project),
        project.skeleton.names if project.skeleton is not None else (),
    )
    words = (("left_hand", tr("left hand")), ("right_hand", tr("right hand")))
    sides = {names[roles[role]]: said for role, said in words if role in roles}
    return tuple(
        KeptHand(n, sides.get(c.hand, c.hand), c.to, course.time(c.first), course.time(c.last, late=True))
        for n, c in enumerate(entry.retime.contacts)
    )


def list_stays(entry: ClipEntry) -> tuple[Stay, ...]:
    """Return where a clip is held."""
    course = get_clip_course(entry) if entry.retime.holds else None
    if course is None:
        return ()
    return tuple(Stay(hold, *ends) for hold, ends in zip(entry.retime.holds, course.stays, strict=True))


def describe_handle(handle: Handle) -> str:
    """Return a handle's name and number: "blend in 0.20"."""
    return f"{get_vocabulary_word(WORDS[handle.name])} {format_number(handle.number, '.2f')}"


def _verdict(project: Project, action: Action, seen: SeenJumps | None) -> tuple[str, bool]:
    """Return what is said of beginning and ending, and whether that is nothing to mend."""
    if seen is None:
        return "", True
    start, end = project.span(action)
    first, last = seen.cost("start", start), seen.cost("end", end)
    costs = {"Repeats": last} if seen.loops else {"Begins": first, "ends": last}
    far = find_far_ends(project, action)
    return tr_phrase(describe_ends(costs, far)), max(costs.values()) <= 1 and not far
