"""What new motion should have beside the constraints of Yang et al.: loudness, speaking rate and words of the
speech it goes with, and another speed where that brings it nearer. All of it is off unless it is asked for.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import join_phrases, phrase
from metagraph.motion.clip import Clip
from metagraph.suggest.tracks import RATE
from metagraph.synthesis.constraints import TOLERANCE, HeardStates, WantedSegment
from metagraph.synthesis.iconic_words import (
    PRICE,
    WordPlace,
    WordShown,
    WordWish,
    describe_words,
    find_unsaid_wishes,
    find_word_places,
    find_words_shown,
    measure_word_cost,
)
from metagraph.synthesis.prosody_costs import (
    MEASURES,
    Measure,
    ProsodyMatch,
    SpokenTake,
    measure_prosody_cost,
    measure_prosody_match,
    measure_speech_prosody,
    measure_state_prosody,
)
from metagraph.synthesis.retiming import Retiming, check_share, find_retimable, retime
from metagraph.synthesis.search.frame_costs import FrameCosts, join_costs
from metagraph.synthesis.search.path import Path
from metagraph.synthesis.states import States, SynthesisError

Array = NDArray[Any]
_COSTS = {
    "loudness": phrase("loudness"),
    "rate": phrase("rate"),
    "words": phrase("words"),
    "timing": phrase("timing"),
}


@dataclass(frozen=True)
class SoftWish:
    """loudness, rate: what a second costs that is off by one spread of the speaker's, of the graph's
    threshold; 0 for nothing. words: those that want motion. price: of one that is missed, of the threshold.
    hard: whether they have to be met. retime: share by which speed may change, 0 for none.
    """

    loudness: float = 0.0
    rate: float = 0.0
    words: tuple[WordWish, ...] = ()
    price: float = PRICE
    hard: bool = False
    retime: float = 0.0

    def __post_init__(self) -> None:
        for name in ("loudness", "rate", "price"):
            value = getattr(self, name)
            if not 0 <= value <= 1000:
                raise SynthesisError(f"the weight of {name} is 0 to 1000, not {value:g}")
        check_share(self.retime)

    @property
    def measures(self) -> tuple[Measure, ...]:
        """What of how it is said is compared."""
        return tuple(m for m in MEASURES if getattr(self, m) > 0)

    @property
    def asks(self) -> bool:
        """Whether anything is asked for."""
        return bool(self.measures or self.words or self.retime)


NO_WISH = SoftWish()


@dataclass(frozen=True, eq=False)
class SoftConstraints:
    """A wish for some seconds of speech. charged: what frames cost. places: the words that want motion. hard:
    whether they have to be met. free `[F]`: where speed may change, None for nowhere; most: by what share.
    known: of each measure how states and frames are said. unsaid: words that were asked for and are not said.
    """

    charged: FrameCosts | None = None
    places: tuple[WordPlace, ...] = ()
    hard: bool = False
    free: Array | None = None
    most: float = 0.0
    known: tuple[tuple[Measure, Array, Array], ...] = ()
    unsaid: tuple[str, ...] = ()

    def retimed(
        self, path: Path, heard: HeardStates, want: WantedSegment, reach: float | None, part: float = 1.0
    ) -> Retiming | None:
        """Return how a path is retimed, as `retiming.retime` does, by some part of what speed may change;
        None if it is not.
        """
        if self.free is None:
            return None
        return retime(path.states, path.jumps, heard, want, self.free, part * self.most, reach)


NOTHING = SoftConstraints()


class SoftMaterial:
    """What takes offer to a wish, made once for all speech they are searched for."""

    def __init__(
        self, wish: SoftWish, states: States, clips: Sequence[Clip], takes: Sequence[SpokenTake], limit: float
    ) -> None:
        """clips, takes: what the states are of, and what was said; limit: the graph's threshold, metres.
        Raises SynthesisError if what is to be compared is not known of any take.
        """
        self.wish, self.states, self.limit = wish, states, limit
        # Takes of one frame have no states.
        self.takes = [t for t, c in zip(takes, clips, strict=True) if c.frames >= 2]
        self.of_states = {m: measure_state_prosody(states, self.takes, m) for m in wish.measures}
        for measure, values in self.of_states.items():
            if not np.isfinite(values).any():
                raise SynthesisError(_unknown(measure, "the speech of the takes"))
        self.free = find_retimable(clips) if wish.retime else None

    def constraints(
        self, new: SpokenTake, start: float, seconds: float, tolerance: float = TOLERANCE
    ) -> SoftConstraints:
        """Return the wish for new speech, from a second of it on. Raises SynthesisError if what is to be
        compared is not known of it.
        """
        wish, kinds, known = self.wish, [], []
        for measure, of_state in self.of_states.items():
            if not np.isfinite(new.values(measure)).any() and new.segments:
                raise SynthesisError(_unknown(measure, "the new speech"))
            of_frame = measure_speech_prosody(new, start, seconds, measure)
            kinds.append(
                measure_prosody_cost(measure, getattr(wish, measure), of_state, of_frame, self.limit)
            )
            known.append((measure, of_state, of_frame))
        places = find_word_places(wish.words, self.states, self.takes, new, start, seconds, tolerance)
        frames = max(1, round(seconds * RATE))
        charged = join_costs([*kinds, measure_word_cost(places, frames, wish.price, self.limit)])
        never = find_unsaid_wishes(wish.words, new, start, seconds)
        return SoftConstraints(charged, places, wish.hard, self.free, wish.retime, tuple(known), never)


def _unknown(measure: Measure, whose: str) -> str:
    if measure == "loudness":
        return f"how loud {whose} was said is not known: give the sounds of the recordings"
    return f"how fast {whose} was said is not known: give transcripts with words, or the recordings' sounds"


@dataclass(frozen=True)
class SoftReport:
    """How well preferences are met. paid: the sum of each kind of cost, metres. matches: loudness and rate.
    words: words with motion. unsaid: given words that the speech does not have. retiming: in words, or "".
    off, was: seconds by which events are off (root mean square), after and before retiming; None
    without it.
    """

    paid: dict[str, float]
    matches: tuple[ProsodyMatch, ...]
    words: tuple[WordShown, ...]
    unsaid: tuple[str, ...] = ()
    retiming: str = ""
    off: float | None = None
    was: float | None = None

    def told(self) -> str:
        """Return it in words, or "" if there were no preferences."""
        parts = [m.words() for m in self.matches]
        if words := describe_words(self.words, self.unsaid):
            parts.append(words)
        if self.paid:
            costs = [
                phrase("{cost:.3g} m for {name}", cost=cost, name=_COSTS.get(name, name))
                for name, cost in self.paid.items()
            ]
            parts.append(phrase("added cost: {costs}", costs=join_phrases(costs, ", ")))
        if self.retiming:
            parts.append(self.retiming)
        return join_phrases(parts, "; ") if parts else ""

    def data(self) -> dict[str, Any]:
        """Return it as a program reads it."""
        return asdict(self)


def make_soft_report(
    soft: SoftConstraints, states: States, path: Path, retiming: Retiming | None = None
) -> SoftReport:
    """Return how well a path meets preferences, as it is shown."""
    way = path.states if retiming is None else path.states[retiming.frames]
    paid = soft.charged.paid(path.states) if soft.charged is not None else {}
    matches = [measure_prosody_match(measure, a, b, way) for measure, a, b in soft.known]
    return SoftReport(
        paid,
        tuple(m for m in matches if m is not None),
        find_words_shown(soft.places, states, way),
        soft.unsaid,
        retiming.words() if retiming is not None else "",
        retiming.off if retiming is not None else None,
        retiming.was if retiming is not None else None,
    )
