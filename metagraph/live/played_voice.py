"""A voice from a file that a session hears as it plays, and whose clauses it may be told beforehand."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.conversation.model import Segment
from metagraph.live.heard_voice import RATE
from metagraph.live.messages import Comes, Generate, Hear, Reply

if TYPE_CHECKING:
    from metagraph.live.live_session import LiveSession

Array = NDArray[Any]

CLIENT = 0  # the program itself: others count from 1
PIECE = 0.1  # seconds of sound at a time
SHORTEST = 0.04  # seconds a clause lasts at least


class PlayedVoice:
    """samples `[N]` float32: RATE a second. segments: what is said in them. announce: seconds before a
    segment begins at which it is reported; None if it is only heard. graph: the name of what moves with it.
    """

    def __init__(
        self, samples: Array, segments: Sequence[Segment], graph: str, announce: float | None = None
    ) -> None:
        self.samples, self.segments, self.graph, self.announce = samples, list(segments), graph, announce
        self._begun: float | None = None
        self._heard = self._told = 0

    @property
    def over(self) -> bool:
        """Whether all of it was heard."""
        return self._heard >= len(self.samples)

    def play(self, session: LiveSession, now: float) -> Reply | None:
        """Let a session hear what is due at `now`; return the reply to what began it, None later."""
        first: Reply | None = None
        if self._begun is None:
            self._begun = now
            session.join(CLIENT)
            wish = Generate(model=self.graph, side="speaker")
            first = session.generating.generate(CLIENT, wish, session.project, now)
        since = now - self._begun
        if self.announce is not None:
            while self._told < len(self.segments):
                s = self.segments[self._told]
                if s.start - self.announce > since:
                    break
                self._tell(session, s, now)
                self._told += 1
        step = round(PIECE * RATE)
        while not self.over and self._heard + step <= since * RATE:
            piece = np.clip(self.samples[self._heard : self._heard + step] * 32768, -32768, 32767)
            session.generating.hear(CLIENT, Hear(audio=piece.astype("<i2").tobytes()), now)
            self._heard += step
        return first

    def _tell(self, session: LiveSession, s: Segment, now: float) -> None:
        """Announce a segment."""
        kind = "clause" if s.kind == "idle" else s.kind
        stress = None if s.peak is None else s.peak - s.start
        begins = (self._begun or 0.0) + s.start
        clause = Comes(kind=kind, at=begins, duration=max(SHORTEST, s.end - s.start), stress=stress)
        session.generating.hear(CLIENT, Hear(comes=(clause,)), now)


def read_played_voice(path: Path, graph: str, announce: float | None = None) -> PlayedVoice:
    """Read a voice from a sound file, all channels mixed; where it is announced, its clauses are given by
    sound. Raises FileError.
    """
    from metagraph.speech.clauses import find_segments_by_sound
    from metagraph.speech.pitch import measure_pitch
    from metagraph.speech.sound import analyse_sound, read_sound
    from metagraph.speech.soundtrack import resample_sound

    samples, rate = read_sound(path)
    found: tuple[Segment, ...] = ()
    if announce is not None:
        found = find_segments_by_sound((), measure_pitch(samples, rate), analyse_sound(samples, rate), None)
    return PlayedVoice(resample_sound(samples, rate, RATE), found, graph, announce)
