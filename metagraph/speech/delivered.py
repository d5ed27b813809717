"""Count how many movements a side's rates request, how many were chosen, and how many play."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from metagraph.common.wording import phrase
from metagraph.graph.conversation.model import SPOKEN, Conversation, Segment, Spoken, list_segments_heard_by
from metagraph.graph.model import Project
from metagraph.playback.plan import Cue, Plan
from metagraph.playback.timing.phases import find_phases
from metagraph.speech.drive import TOLERANCE, draw_segments, find_clause_peak, key_segments

NAMES = {
    "clause": phrase("clauses with a gesture"),
    "response": phrase("responses with a nod"),
    "hesitation": phrase("partner's hesitations with a nod"),
}
NEAR = 1.0  # seconds after a segment within which a nod is its


@dataclass(frozen=True, slots=True)
class Delivered:
    """One kind of segment that a side moves with. count: number of segments. asked: the rate, 0..1. drawn:
    number of segments that were chosen to get a movement. performed: number that have one: a clause if its
    peak is between a gesture's stroke and the end of its hold, the others if a nod begins in time. strokes:
    number of clauses with a stroke within `TOLERANCE` of the peak.
    """

    kind: Spoken
    count: int
    asked: float
    drawn: int
    performed: int
    strokes: int

    def words(self) -> str:
        """Return a sentence, such as "clauses with a gesture: 75 % requested, 10 of 13 chosen (77 %), 9
        performed (69 %), 6 of them with a stroke on the stress".
        """
        name = NAMES[self.kind]
        if not self.count:
            return phrase("{name}: none", name=name)
        asked, chosen = 100 * self.asked, 100 * self.drawn / self.count
        played = 100 * self.performed / self.count
        if self.kind != "clause":
            return phrase(
                "{name}: {asked:.0f} % requested, {drawn} of {count} chosen ({chosen:.0f} %), {performed} "
                "performed ({played:.0f} %)",
                name=name,
                asked=asked,
                drawn=self.drawn,
                count=self.count,
                chosen=chosen,
                performed=self.performed,
                played=played,
            )
        return phrase(
            "{name}: {asked:.0f} % requested, {drawn} of {count} chosen ({chosen:.0f} %), {performed} "
            "performed ({played:.0f} %), {strokes} of them with a stroke on the stress",
            strokes=self.strokes,
            name=name,
            asked=asked,
            drawn=self.drawn,
            count=self.count,
            chosen=chosen,
            performed=self.performed,
            played=played,
        )


def count_delivered(
    conversation: Conversation, side: int, project: Project, plan: Plan
) -> tuple[Delivered, ...]:
    """Return what a side's plan does with each kind of segments, of those its rates are about. project: whose
    graph moves it.
    """
    every = key_segments(list_segments_heard_by(conversation, side))
    drawn = draw_segments(conversation, side)
    told = [_told(cue, project) for cue in plan.layers["arms"].cues if cue.action.kind == "gesture"]
    nods = [cue for cue in plan.layers["head"].cues if cue.action.kind == "gesture"]
    out = []
    for kind in SPOKEN:
        of = [(key, s) for key, s in every if s.kind == kind]
        own = sum(_strikes(s, told) for _, s in of) if kind == "clause" else 0
        done = sum(_covered(s, told) if kind == "clause" else _nodded(key, s, nods) for key, s in of)
        rate = getattr(conversation.sides[side].rates, kind)
        out.append(Delivered(kind, len(of), rate, sum(key in drawn for key, _ in of), done, own))
    return tuple(out)


def _told(cue: Cue, project: Project) -> tuple[float, float]:
    """Return when a gesture's stroke is, and when its hold ends."""
    found = find_phases(project, cue.action)
    stroke = cue.start + (found.stroke - cue.entry) / cue.tempo
    if cue.repeats:
        return stroke, cue.end - cue.blend_out
    longer = cue.hold - (cue.hold_to - cue.hold_from) if cue.hold > 0 else 0.0
    return stroke, min(cue.end, stroke + (found.relax - found.stroke) / cue.tempo + longer)


def _strikes(segment: Segment, told: Sequence[tuple[float, float]]) -> bool:
    return any(abs(stroke - find_clause_peak(segment)) <= TOLERANCE for stroke, _ in told)


def _covered(segment: Segment, told: Sequence[tuple[float, float]]) -> bool:
    peak = find_clause_peak(segment)
    return any(stroke - TOLERANCE <= peak <= end + TOLERANCE for stroke, end in told)


def _nodded(key: str, segment: Segment, nods: Sequence[Cue]) -> bool:
    return any(
        cue.meta.partition("+")[0] == key and segment.start - NEAR <= cue.start <= segment.end + NEAR
        for cue in nods
    )
