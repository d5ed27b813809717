"""Motion that is laid over the arms' and the head's layers of a live session while it lasts: it comes and
goes without a jump, gives way to what clients ask of these layers by name, and takes over from other such
motion.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.model import Project
from metagraph.live.ledger import is_asked_by_client
from metagraph.live.messages import Generate, Hear
from metagraph.motion import rotation
from metagraph.playback.plan import LayerPlan, Plan
from metagraph.playback.posing.layers import ease_blend
from metagraph.playback.posing.overlay import BLEND, Overlay, find_overlaid_joints

Array = NDArray[Any]

GIVES_WAY = 0.25  # seconds in which laid motion gives way to what is asked by name, and comes back


class LaidMotion(ABC):
    """One such motion, made for one client. name: of what makes it. begun: seconds. delay: seconds from what
    is heard to the movement that goes with it; shows: seconds after it begun from which on it is to be seen.
    """

    def __init__(self, client: int, name: str, wish: Generate, project: Project, now: float) -> None:
        self.client, self.name, self.wish = client, name, wish
        self.begun = self.last = now
        self.delay = self.shows = 0.0
        self.project, self.joints = project, find_overlaid_joints(project)
        self._shown: float | None = None  # since when
        self._ends: float | None = None
        self._before: Array | None = None
        self._place(project)

    # --- what each does its own way

    @property
    @abstractmethod
    def note(self) -> str:
        """How soon it answers to what is heard, in words."""

    @property
    @abstractmethod
    def waiting(self) -> float:
        """Seconds of sound that wait to be heard."""

    @abstractmethod
    def fits(self, project: Project) -> bool:
        """Whether it can move a project's character."""

    @abstractmethod
    def hear(self, message: Hear, now: float) -> str:
        """Take in what is heard; return why not, "" when it is."""

    @abstractmethod
    def reach(self, now: float, plan: Plan) -> None:
        """Make what is due at `now`, seconds that never decrease."""

    @abstractmethod
    def offsets(self, now: float) -> Array | None:
        """Return how `joints` are turned from the base pose at a time `[n, 4]`, None before it is known."""

    def _place(self, project: Project) -> None:
        """Take note of another project, whose character is moved from now on."""
        self.project, self.joints = project, find_overlaid_joints(project)

    # --- coming and going

    @property
    def ended(self) -> bool:
        """Whether it was asked to end."""
        return self._ends is not None

    def end(self, now: float) -> None:
        """Give way to the plan from now on."""
        self._ends = now if self._ends is None else self._ends

    def over(self, now: float) -> bool:
        """Whether nothing of it is to be seen any more."""
        return self._ends is not None and now >= self._ends + BLEND

    def follow(self, other: LaidMotion) -> None:
        """Take over from other motion, without a jump."""
        self._before, self._shown = other.seen(other.last), other._shown

    def seen(self, now: float) -> Array | None:
        """Return `offsets`, faded from those of the motion that it follows."""
        own = self.offsets(now)
        if self._before is None or own is None:
            return self._before if own is None else own
        back = float(ease_blend(np.array([(now - self.begun - self.shows) / BLEND]))[0])
        return np.asarray(rotation.nlerp(self._before, own, np.full(len(own), back)))

    def overlay(self, plan: Plan, project: Project, now: float) -> Overlay | None:
        """Return what it lays over a plan at a time, None while there is nothing."""
        if self.project is not project:
            self._place(project)
        offsets = self.seen(now)
        early = now < self.begun + self.shows and self._before is None
        if offsets is None or early or self.over(now):
            return None
        if self._shown is None:
            self._shown = now
        weight = float(ease_blend(np.array([(now - self._shown) / BLEND]))[0])
        if self._ends is not None:
            weight *= 1 - float(ease_blend(np.array([(now - self._ends) / BLEND]))[0])
        shown = (np.array([compute_asked_weight(plan.layers[layer], now)]) for layer in ("arms", "head"))
        return Overlay(self.joints, offsets[None].astype(np.float32), np.array([weight]), *shown)

    def status(self) -> dict[str, Any]:
        """Return what is reported about it to clients."""
        return {
            "model": self.name,
            "side": self.wish.side,
            "delay": round(self.delay, 3),
            "waits": round(self.waiting, 3),
        }


def compute_asked_weight(lane: LayerPlan, now: float) -> float:
    """Return how much of what clients asked of a layer shows at a time, 0..1; between two actions that follow
    each other it does not dip.
    """
    if not lane.cues:
        return 0.0
    near = int(lane.starts.searchsorted(now, "right"))
    spans: list[list[float]] = []
    for cue in lane.cues[max(0, near - 6) : near + 4]:
        if not is_asked_by_client(cue.meta):
            continue
        if spans and cue.start - spans[-1][1] <= 2 * GIVES_WAY:
            spans[-1][1] = cue.end
        else:
            spans.append([cue.start, cue.end])
    edges = np.array([min(now - start, end - now) / GIVES_WAY for start, end in spans])
    return float(ease_blend(edges).max()) if len(edges) else 0.0


def read_voice_samples(message: Hear, side: str) -> list[Array] | str:
    """Return the samples of the character's own voice and the partner's, as long as each other, -1..1; or why
    they cannot be read. side: the character's.
    """
    if len(message.audio) % 2 or len(message.other) % 2:
        return "audio: a sample has two bytes, but an odd number of bytes arrived"
    voices = [np.frombuffer(x, "<i2").astype(np.float32) / 32768 for x in (message.audio, message.other)]
    size = max(len(v) for v in voices)
    voices = [np.pad(v, (0, size - len(v))) for v in voices]
    return voices[::-1] if side == "listener" else voices  # a listener hears the partner
