"""Motion that a learned model makes live of what a client hears: it takes the place of the arms' and the
head's layers, until something is asked of these by name.

Frames are made 25 times a second of session time, a bit at every tick: the work of a model that makes several
frames at once is spread over the ticks before they are shown.
"""

from __future__ import annotations

from collections import deque
from math import floor
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.model import Project
from metagraph.live.laid_motion import LaidMotion, read_voice_samples
from metagraph.live.messages import Generate, Hear
from metagraph.live.voice_detector import VoiceDetector
from metagraph.motion import rotation
from metagraph.playback.plan import Plan

if TYPE_CHECKING:
    from metagraph.generation.stored import Model

Array = NDArray[Any]

MOST = 4_000_000  # numbers of a model: larger ones do not keep up
WAITS = 3.0  # seconds of sound that may wait to be heard
BEHIND = 12  # frames it may be late before some are left out
SIDES = {"self": (True, False), "partner": (False, True), "both": (True, True), "none": (False, False)}


class GeneratedMotion(LaidMotion):
    """One model at work for one client. Raises ValueError, in words, for a model that cannot be played
    live.
    """

    def __init__(self, client: int, name: str, model: Model, wish: Generate, project: Project, now: float):
        from metagraph.generation.features import HOP, RATE
        from metagraph.generation.networks import FPS, count_parameters
        from metagraph.generation.performing import find_first_pose, moves_skeleton
        from metagraph.generation.sampler import TakeSampler

        if not moves_skeleton(model, project):
            raise ValueError(
                f"the model '{name}' was trained for another skeleton, so it cannot move "
                "this character live. Train a model from this character's clips"
            )
        if (size := count_parameters(model.card.sizes)) > MOST:
            raise ValueError(
                f"the model '{name}' has {size / 1e6:.1f} million parameters, too many for live use (at most "
                f"{MOST / 1e6:g} million): train a small one"
            )
        self.model = model
        super().__init__(client, name, wish, project, now)
        self._fps, self._hop = FPS, HOP
        self.sampler = TakeSampler(
            model,
            wish.seed,
            wish.temperature,
            lookahead=round(wish.ahead * FPS),
            channels=2,
            gains=(1.0, 1.0),
            first=find_first_pose(model, project),
        )
        # Frames that are made at once come together, and those that take many ticks come later still.
        self._slack = self.sampler.made * (1 if self.sampler.pieces == 1 else 2)
        self._work = 0.0  # pieces of work that are due
        self.delay = self.shows = (self.sampler.delay + self._slack) / FPS
        self._most = round(WAITS * RATE)
        self._sound = np.zeros((2, 0), np.float32)  # own voice, the partner's
        self._voices = VoiceDetector(), VoiceDetector()
        self._speaks: tuple[bool, bool] | None = None
        self._fed = self._made = 0  # frames
        self._poses: deque[Array] = deque(maxlen=8 + 2 * self.sampler.made)  # rotations of the rig's joints

    # --- what comes in

    @property
    def waiting(self) -> float:
        """Seconds of sound that wait to be heard."""
        return self._sound.shape[1] / (self._hop * self._fps)

    @property
    def note(self) -> str:
        """How soon it answers to what is heard, in words."""
        return f"movements come {self.delay:.2f} s after the sound"

    def fits(self, project: Project) -> bool:
        """Whether it can move a project's character."""
        return project.skeleton == self.model.rig.skeleton

    def hear(self, message: Hear, now: float) -> str:
        """Take in what is heard; return why not, "" when it is."""
        if message.comes:
            return "comes: a learned model follows the sound; only motion graphs use announced speech"
        voices = read_voice_samples(message, self.wish.side)
        if isinstance(voices, str):
            return voices
        if self._sound.shape[1] + len(voices[0]) > self._most:
            return f"more than {WAITS:g} s of sound would wait; send sound in real time"
        self._sound = np.concatenate([self._sound, np.stack(voices)], 1)
        if message.speaks is not None:
            self._speaks = None if message.speaks == "sound" else SIDES[message.speaks]
        return ""

    # --- what is made

    def reach(self, now: float, plan: Plan) -> None:
        """Make what is due at `now`, seconds that never decrease."""
        due = floor((now - self.begun) * self._fps) + 1 - self._fed
        if due > BEHIND:  # nobody looked for a while: what is missed is not made up for
            self.begun += (due - 1) / self._fps
            due = 1
        self._work += (now - self.last) * self._fps * self.sampler.pieces / self.sampler.made
        self.last = now
        for _ in range(due):
            self._feed(plan, self.begun + self._fed / self._fps)
        self._work = min(self._work, 2.0 * BEHIND * self.sampler.pieces)
        # What comes frame by frame is made at once, what takes many pieces one after the other.
        pieces = floor(self._work + 1e-6) if self.sampler.pieces > 1 else due
        for _ in range(pieces):
            ready = self.sampler.advance()
            if ready is None:
                self._work = 0.0  # nothing has come to be worked on
                break
            self._work -= 1
            for turns in ready:
                fine = bool(np.isfinite(turns).all())
                self._poses.append(turns if fine or not self._poses else self._poses[-1])
                self._made += 1

    def _feed(self, plan: Plan, seconds: float) -> None:
        """Let the model hear one frame; silence where no sound has come."""
        from metagraph.generation.features import encode_activity

        heard, self._sound = self._sound[:, : self._hop], self._sound[:, self._hop :]
        heard = np.pad(heard, ((0, 0), (0, self._hop - heard.shape[1])))
        found = [voice.hear(row) for voice, row in zip(self._voices, heard, strict=True)]
        own, partner = self._speaks if self._speaks is not None else found
        if self._speaks is None:  # what the character says itself nobody need tell it
            own = own or any(s.start <= seconds < s.end for s in plan.track.speeches)
        self.sampler.feed(heard, encode_activity(np.array([own]), np.array([partner])))
        self._fed += 1

    # --- what is to be seen

    def offsets(self, now: float) -> Array | None:
        """Return how `joints` are turned from the base pose at a time `[n, 4]`, None before it is known."""
        if not self._poses:
            return None
        place = (now - self.begun) * self._fps - self.sampler.delay - self._slack
        place = min(max(place - (self._made - len(self._poses)), 0.0), len(self._poses) - 1.0)
        low = floor(place)
        high = min(low + 1, len(self._poses) - 1)
        part = np.full(len(self._poses[low]), place - low)
        whole = np.array(self._held)
        whole[list(self.model.rig.joints)] = rotation.nlerp(self._poses[low], self._poses[high], part)
        return np.asarray(rotation.multiply(self._back, whole)[self.joints])

    def _place(self, project: Project) -> None:
        """Find out what the joints that the model leaves alone are like, and what all are relative to."""
        super()._place(project)
        rig, base = self.model.rig, anatomy.get_base_pose(project).rotations.astype(np.float64)
        self._held = np.array(base)
        between = sorted({joint for line in rig.lines for joint in line[:-1]})
        self._held[between] = rig.base[between]
        self._back = rotation.conjugate(base)
