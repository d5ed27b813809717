"""Motion that a learned model makes live of what a client hears: it takes the place of the arms' and the
head's layers, until something is asked of these by name.

Frames are made 25 times a second of session time, a bit at every tick: the work of a model that makes several
frames at once is spread over the ticks before they are shown.
"""

from __future__ import annotations

from collections import deque
from math import floor
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from metagraph.errors import FileError
from metagraph.graph import anatomy
from metagraph.graph.model import Project
from metagraph.live.ledger import asked_by_client
from metagraph.live.messages import Generate, Hear, Reply, rounded
from metagraph.live.voice_detector import VoiceDetector
from metagraph.motion import rotation
from metagraph.playback.overlay import BLEND, Overlay, reached
from metagraph.playback.plan import LayerPlan, Plan
from metagraph.playback.player import ease

if TYPE_CHECKING:
    from metagraph.generation.stored import Model

Array = NDArray[Any]

GIVES_WAY = 0.25  # seconds in which generated motion gives way to what is asked by name, and comes back
MOST = 4_000_000  # numbers of a model: larger ones do not keep up
WAITS = 3.0  # seconds of sound that may wait to be heard
BEHIND = 12  # frames it may be late before some are left out
SIDES = {"self": (True, False), "partner": (False, True), "both": (True, True), "none": (False, False)}


class GeneratedMotion:
    """One model at work for one client. name: the model's. delay: seconds from a sound to the movement that
    goes with it. Raises ValueError, in words, for a model that cannot be played live.
    """

    def __init__(self, client: int, name: str, model: Model, wish: Generate, project: Project, now: float):
        from metagraph.generation.features import HOP, RATE
        from metagraph.generation.networks import FPS, parameters
        from metagraph.generation.performing import first_of, fits
        from metagraph.generation.sampler import Sampler

        if not fits(model, project):
            raise ValueError(
                f"the model '{name}' moves another skeleton than this character's; live it can only be used "
                "with its own. Train one from this character's clips"
            )
        if (size := parameters(model.card.sizes)) > MOST:
            raise ValueError(
                f"the model '{name}' has {size / 1e6:.1f} million numbers, too many to keep up live (at most "
                f"{MOST / 1e6:g} million): train a small one"
            )
        self.client, self.name, self.model, self.wish = client, name, model, wish
        self._fps, self._hop = FPS, HOP
        self.sampler = Sampler(
            model,
            wish.seed,
            wish.temperature,
            lookahead=round(wish.ahead * FPS),
            channels=2,
            gains=(1.0, 1.0),
            first=first_of(model, project),
        )
        # Frames that are made at once come together, and those that take many ticks come later still.
        self._slack = self.sampler.made * (1 if self.sampler.pieces == 1 else 2)
        self._work = 0.0  # pieces of work that are due
        self.delay = (self.sampler.delay + self._slack) / FPS
        self._most = round(WAITS * RATE)
        self._sound = np.zeros((2, 0), np.float32)  # own voice, the partner's
        self._voices = VoiceDetector(), VoiceDetector()
        self._speaks: tuple[bool, bool] | None = None
        self._begun = self._last = now
        self._fed = self._made = 0  # frames
        self._poses: deque[Array] = deque(maxlen=8 + 2 * self.sampler.made)  # rotations of the rig's joints
        self._shown: float | None = None  # since when
        self._ends: float | None = None
        self._before: Array | None = None
        self._project: Project | None = None

    # --- what comes in

    @property
    def waiting(self) -> float:
        """Seconds of sound that wait to be heard."""
        return self._sound.shape[1] / (self._hop * self._fps)

    def hear(self, message: Hear) -> str:
        """Take in what is heard; return why not, "" when it is."""
        if len(message.audio) % 2 or len(message.other) % 2:
            return "audio: samples have two bytes each; an odd number of them came"
        voices = [np.frombuffer(x, "<i2").astype(np.float32) / 32768 for x in (message.audio, message.other)]
        size = max(len(v) for v in voices)
        if self._sound.shape[1] + size > self._most:
            return f"more than {WAITS:g} s of sound would wait: send it as it is heard, not faster"
        if self.wish.side == "listener":
            voices = voices[::-1]  # it hears the partner
        self._sound = np.concatenate(
            [self._sound, np.stack([np.pad(v, (0, size - len(v))) for v in voices])], 1
        )
        if message.speaks is not None:
            self._speaks = None if message.speaks == "sound" else SIDES[message.speaks]
        return ""

    def end(self, now: float) -> None:
        """Give way to the plan from now on."""
        self._ends = now if self._ends is None else self._ends

    def over(self, now: float) -> bool:
        """Whether nothing of it is to be seen any more."""
        return self._ends is not None and now >= self._ends + BLEND

    def follow(self, other: GeneratedMotion) -> None:
        """Take over from another model, without a jump."""
        self._before, self._shown = other.turns(other._last), other._shown

    # --- what is made

    def reach(self, now: float, plan: Plan) -> None:
        """Make what is due at `now`, seconds that never decrease."""
        due = floor((now - self._begun) * self._fps) + 1 - self._fed
        if due > BEHIND:  # nobody looked for a while: what is missed is not made up for
            self._begun += (due - 1) / self._fps
            due = 1
        self._work += (now - self._last) * self._fps * self.sampler.pieces / self.sampler.made
        self._last = now
        for _ in range(due):
            self._feed(plan, self._begun + self._fed / self._fps)
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
        from metagraph.generation.features import one_hot

        heard, self._sound = self._sound[:, : self._hop], self._sound[:, self._hop :]
        heard = np.pad(heard, ((0, 0), (0, self._hop - heard.shape[1])))
        found = [voice.hear(row) for voice, row in zip(self._voices, heard, strict=True)]
        own, partner = self._speaks if self._speaks is not None else found
        if self._speaks is None:  # what the character says itself nobody need tell it
            own = own or any(s.start <= seconds < s.end for s in plan.track.speeches)
        self.sampler.feed(heard, one_hot(np.array([own]), np.array([partner])))
        self._fed += 1

    # --- what is to be seen

    def turns(self, now: float) -> Array | None:
        """Return the rotations of the model's joints `[n, 4]` at a time, None before there are any."""
        if not self._poses:
            return self._before
        place = (now - self._begun) * self._fps - self.sampler.delay - self._slack
        place = min(max(place - (self._made - len(self._poses)), 0.0), len(self._poses) - 1.0)
        low = floor(place)
        high = min(low + 1, len(self._poses) - 1)
        part = np.full(len(self._poses[low]), place - low)
        turns = rotation.nlerp(self._poses[low], self._poses[high], part)
        if self._before is not None:
            back = float(ease(np.array([(now - self._started) / BLEND]))[0])
            turns = rotation.nlerp(self._before, turns, np.full(len(turns), back))
        return np.asarray(turns)

    @property
    def _started(self) -> float:
        """When its first movement is due."""
        return self._begun + self.delay

    def overlay(self, plan: Plan, project: Project, now: float) -> Overlay | None:
        """Return what it lays over a plan at a time, None while there is nothing."""
        turns = self.turns(now)
        if turns is None or (now < self._started and self._before is None) or self.over(now):
            return None
        if self._shown is None:
            self._shown = now
        if self._project is not project:
            self._place(project)
        whole = np.array(self._held)
        whole[self._joints] = turns
        offsets = rotation.multiply(self._back, whole)[self._reach][None]
        weight = float(ease(np.array([(now - self._shown) / BLEND]))[0])
        if self._ends is not None:
            weight *= 1 - float(ease(np.array([(now - self._ends) / BLEND]))[0])
        shown = (np.array([asked(plan.layers[layer], now)]) for layer in ("arms", "head"))
        return Overlay(self._reach, offsets.astype(np.float32), np.array([weight]), *shown)

    def _place(self, project: Project) -> None:
        """Find out where the model's joints are on a project's figure, and what they are relative to."""
        self._project = project
        rig, base = self.model.rig, anatomy.base_pose(project).rotations.astype(np.float64)
        self._joints, self._reach = list(rig.joints), reached(project)
        self._held = np.array(base)
        between = sorted({joint for line in rig.lines for joint in line[:-1]})
        self._held[between] = rig.base[between]
        self._back = rotation.conjugate(base)


def asked(lane: LayerPlan, now: float) -> float:
    """Return how much of what clients asked of a layer shows at a time, 0..1; between two actions that follow
    each other it does not dip.
    """
    if not lane.cues:
        return 0.0
    near = int(lane.starts.searchsorted(now, "right"))
    spans: list[list[float]] = []
    for cue in lane.cues[max(0, near - 6) : near + 4]:
        if not asked_by_client(cue.meta):
            continue
        if spans and cue.start - spans[-1][1] <= 2 * GIVES_WAY:
            spans[-1][1] = cue.end
        else:
            spans.append([cue.start, cue.end])
    edges = np.array([min(now - start, end - now) / GIVES_WAY for start, end in spans])
    return float(ease(edges).max()) if len(edges) else 0.0


class Generating:
    """What of a session is generated. models: names to files, those that clients may choose from."""

    def __init__(self, models: dict[str, Path] | None = None) -> None:
        self.models = dict(models or {})
        self.motion: GeneratedMotion | None = None
        self._read: dict[tuple[str, int], Model] = {}

    def generate(self, client: int, message: Generate, project: Project, now: float) -> Reply:
        """Begin, change or end generated motion; return the reply."""
        ident = message.id or None
        if message.model is None:
            before = self.motion
            if before is not None:
                before.end(now)
            return Reply(id=ident, state="done", why="" if before else "nothing was generated")
        try:
            model = self._model(message.model)
            motion = GeneratedMotion(client, message.model, model, message, project, now)
        except (FileError, ValueError) as error:
            return Reply(id=ident, state="refused", why=str(error))
        if self.motion is not None and not self.motion.over(now):
            motion.follow(self.motion)
        self.motion = motion
        notes = (f"movements come {motion.delay:.2f} s after the sound",)
        return Reply(id=ident, state="planned", at=rounded(now + motion.delay), layer="arms", notes=notes)

    def hear(self, client: int, message: Hear) -> Reply:
        """Take in what a client hears; return the reply."""
        ident, motion = message.id or None, self.motion
        if motion is None or motion._ends is not None:
            why = "nothing is generated: ask to `generate` first"
        elif motion.client != client:
            why = "another client asked to `generate`: it says what is heard"
        else:
            why = motion.hear(message)
        return Reply(id=ident, state="refused" if why else "done", why=why)

    def reach(self, now: float, plan: Plan, project: Project, clients: Any) -> None:
        """Make what is due. clients: numbers of those that are there; without who asked for it, it ends."""
        motion = self.motion
        if motion is None:
            return
        if motion.client not in clients or project.skeleton != motion.model.rig.skeleton:
            motion.end(now)
        if motion.over(now) or project.skeleton != motion.model.rig.skeleton:
            self.motion = None
            return
        motion.reach(now, plan)

    def overlay(self, plan: Plan, project: Project, now: float) -> Overlay | None:
        """Return what is laid over a plan at a time, None for nothing."""
        return None if self.motion is None else self.motion.overlay(plan, project, now)

    def status(self) -> dict[str, Any] | None:
        """Return what is generated now, as it is told to clients."""
        motion = self.motion
        if motion is None or motion._ends is not None:
            return None
        return {
            "model": motion.name,
            "side": motion.wish.side,
            "delay": round(motion.delay, 3),
            "waits": round(motion.waiting, 3),
        }

    def _model(self, name: str) -> Model:
        """Return a model, read once. Raises FileError and ValueError."""
        from metagraph.generation.stored import read_model

        path = self.models.get(name)
        if path is None:
            known = ", ".join(list(self.models)[:6])
            there = (
                f"there are {known}"
                if known
                else f"put files of models beside the project, or into '{_folder()}'"
            )
            raise ValueError(f"there is no model '{name[:60]}'; {there}")
        try:
            key = (name, path.stat().st_mtime_ns)
        except OSError:
            key = (name, 0)
        if key not in self._read:
            self._read = {key: read_model(path)}
        return self._read[key]


def _folder() -> str:
    from metagraph.generation.offered import FOLDER

    return FOLDER
