"""Motion that a motion graph makes live: a path through long takes, extended while it plays to go with what
clients hear and with what they say is going to be said.

It goes by in frames, 30 a second. What became known is noted with its frame, so that the same motion can be
made again of it (`metagraph.synthesis.extending.path.replay_path`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from math import floor
from typing import Any

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from metagraph.graph.conversation.model import Segment, list_segments_heard_by
from metagraph.graph.model import Project
from metagraph.live.heard_voice import RATE as SAMPLES
from metagraph.live.heard_voice import SIZE, HeardVoice
from metagraph.live.laid_motion import LaidMotion, read_voice_samples
from metagraph.live.messages import Comes, Generate, Hear
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.playback.life.track import Speech
from metagraph.playback.life.voice import choose_voice
from metagraph.playback.plan import Plan
from metagraph.playback.posing.composer import Reach, find_composer
from metagraph.playback.posing.layers import sample_offsets
from metagraph.playback.posing.overlay import find_overlaid_joints
from metagraph.suggest.tracks import RATE, track_seconds
from metagraph.synthesis.extending.path import FADE, DriverGraph, PathExtender, Told, make_driver_graph
from metagraph.synthesis.extending.speech_so_far import SpeechNews

Array = NDArray[Any]

WAITS = 3.0  # seconds of sound that may wait to be heard
AT_ONCE = (
    0.15  # seconds: a piece so short has been recorded when it comes, of a longer one the rest is to come
)
GONE = 0.3  # seconds without sound after which there is none any more
BEHIND = 15  # frames it may be late before some are left out
NEWS = 64  # that may wait for the next frame
FARTHEST = 60.0  # seconds ahead that a clause may be announced
MOST_TOLD = 100_000  # of what became known, that is kept to make the motion again
AHEAD = 1.0  # seconds by which the character knows what it is going to say itself
MUTE = ("partner", "none")  # who may speak while it does not


class KeptMotion(Struct, frozen=True, kw_only=True, omit_defaults=True):
    """What a session's motion can be made again of. graph: its name; size: of its graph, states and
    transitions. begun: when it began, seconds of the session. frames: how many it had. told: what became
    known before which of them.
    """

    graph: str
    size: tuple[int, int]
    seed: int
    begun: float
    frames: int
    told: tuple[Told, ...]


@dataclass(eq=False)
class LiveGraph:
    """A motion graph that may drive characters of its takes' skeleton. takes: those its states are of, of
    more than one frame.
    """

    takes: tuple[Clip, ...]
    driver: DriverGraph
    _turns: tuple[Array, Array, Array] | None = field(default=None, repr=False)

    @property
    def size(self) -> tuple[int, int]:
        """How many states and transitions its graph has."""
        return self.driver.graph.size

    def fits(self, project: Project) -> bool:
        """Whether it can move a project's character."""
        return project.skeleton == self.takes[0].skeleton

    def warm(self, project: Project) -> None:
        """Work out, and compile, beforehand what the first motion would wait for."""
        self.turns(project)
        PathExtender(self.driver).step()

    def turns(self, project: Project) -> Array:
        """Return how the joints that are laid over are turned from the base pose at each state `[F, n, 4]`
        float32; worked out once.
        """
        frame = find_composer(project)
        joints = find_overlaid_joints(project)
        ground = frame.ground.base.rotations
        known = self._turns
        if known is None or not (np.array_equal(known[0], joints) and np.array_equal(known[1], ground)):
            reach = Reach(joints, None)
            parts = [sample_offsets(frame.ground, reach, clip, track_seconds(clip))[0] for clip in self.takes]
            known = self._turns = joints, ground, np.concatenate(parts).astype(np.float32)
        return known[2]


def make_live_graph(
    takes: Sequence[Clip],
    speech: Sequence[Sequence[Segment]],
    k: int | None = None,
    level: float | None = None,
    keys: float | None = None,
    most: int | None = None,
) -> LiveGraph:
    """Return the graph of takes, made ready to drive. Arguments as for `graph.find_threshold`,
    `states.key_states` and `graph.build`. Raises SynthesisError.
    """
    from metagraph.synthesis.constraints import find_change_states, find_heard_at
    from metagraph.synthesis.graph import build_graph, find_threshold
    from metagraph.synthesis.states import KEYS, LEVEL, STEP, key_states, read_states

    states = read_states(takes)
    pairs = [(c, s) for c, s in zip(takes, speech, strict=True) if c.frames >= 2]
    told = [s for _, s in pairs]
    limit = find_threshold(states, STEP if k is None else k, LEVEL if level is None else level)
    places = key_states(states, KEYS if keys is None else keys, find_change_states(states, told))
    graph = build_graph(states, limit, places, most)
    return LiveGraph(tuple(c for c, _ in pairs), make_driver_graph(graph, find_heard_at(states, told)))


def list_recorded_takes(project: Project) -> tuple[list[Clip], list[tuple[Segment, ...]]]:
    """Return the project's own takes, those that were recorded along with a side of a conversation, and what
    was heard during each; of the project's skeleton.
    """
    clips: list[Clip] = []
    speech: list[tuple[Segment, ...]] = []
    for conversation in project.conversations.values():
        for number, side in enumerate(conversation.sides):
            entry = project.clips.get(side.take or "")
            clip = None if entry is None else entry.motion
            if clip is None or clip.skeleton != project.skeleton or clip.frames < 2:
                continue
            said = [s for s in list_segments_heard_by(conversation, number) if s.start < clip.duration]
            if said:
                clips.append(clip)
                speech.append(tuple(said))
    return clips, speech


class GraphMotion(LaidMotion):
    """One path through a graph, for one client. Raises ValueError, in words, for a graph that cannot move the
    character.
    """

    def __init__(
        self, client: int, name: str, graph: LiveGraph, wish: Generate, project: Project, now: float
    ):
        self.graph = graph
        if not graph.fits(project):
            raise ValueError(
                f"the takes of '{name}' have another skeleton than this character's: bring them onto it with "
                "`metagraph live --retarget`, or give takes of its own"
            )
        super().__init__(client, name, wish, project, now)
        self.path = PathExtender(graph.driver, wish.seed)
        self.delay = (graph.driver.rules.lock + 1) / RATE
        self.told: list[Told] = []
        self._news: list[SpeechNews] = []
        self._voice: HeardVoice | None = None
        self._sound = np.zeros(0, np.float32)  # its own voice, what was not heard yet
        self._last_sound = now
        self._said: dict[str, float] = {}  # speeches of its own that it knows of, and when they end
        self._speaks: bool | None = None  # as it was reported; None: loudness tells
        self._poses: dict[int, Array] = {}
        self._first = now
        self._until: int | None = None  # the frame from which on no more is kept of what became known

    @property
    def note(self) -> str:
        """How soon it answers to what is heard, in words."""
        return (
            f"movements begin at least {self.delay:.2f} s after the sound; announce speech with `comes`, and "
            "strokes meet its stresses"
        )

    @property
    def waiting(self) -> float:
        """Seconds of sound that wait to be heard."""
        return len(self._sound) / SAMPLES

    def fits(self, project: Project) -> bool:
        """Whether it can move a project's character."""
        return self.graph.fits(project)

    # --- what comes in

    def hear(self, message: Hear, now: float) -> str:
        """Take in what is heard; return why not, "" when it is."""
        voices = read_voice_samples(message, self.wish.side)
        if isinstance(voices, str):
            return voices
        if len(self._sound) + len(voices[0]) > WAITS * SAMPLES:
            return f"more than {WAITS:g} s of sound would wait; send sound in real time"
        if len(self._news) + len(message.comes) + 2 * (message.speaks is not None) > NEWS:
            return "too much at once; try again in a moment"
        for clause in message.comes:
            begins = now + (clause.after or 0.0) if clause.at is None else clause.at
            if begins + clause.duration < now or begins > now + FARTHEST:
                return (
                    f"comes: the session is at {now:.1f} s; {begins:.1f} s is over, or more than "
                    f"{FARTHEST:g} s ahead"
                )
        self._tell_comes(message.comes, now)
        if len(voices[0]):
            if self._voice is None:
                self._voice = HeardVoice(now - min(AT_ONCE, len(voices[0]) / SAMPLES))
            self._sound, self._last_sound = np.concatenate([self._sound, voices[0]]), now
        if message.speaks is not None:
            self._turn(message.speaks, now)
        return ""

    def _tell_comes(self, comes: Sequence[Comes], now: float) -> None:
        for clause in comes:
            at = (now + (clause.after or 0.0) if clause.at is None else clause.at) - self.begun
            peak = None if clause.stress is None else at + min(clause.stress, clause.duration)
            self._news.append(SpeechNews("comes", at, at + clause.duration, peak, clause.kind))

    def _turn(self, speaks: str, now: float) -> None:
        """Take note of who speaks from now on: who does not speak any more, says nothing of what was
        announced.
        """
        self._speaks = None if speaks == "sound" else speaks not in MUTE
        if speaks != "sound":
            self._news.append(SpeechNews("begins" if self._speaks else "ends", now - self.begun))
        if speaks in MUTE:
            self._news.append(SpeechNews("hush", now - self.begun))

    def _listen(self, now: float) -> None:
        """Hear the sound that is due."""
        while self._voice is not None:
            due = len(self._sound) >= SIZE and self._voice.now < now - 1e-9
            if due:
                piece, self._sound = self._sound[:SIZE], self._sound[SIZE:]
            elif now - max(self._last_sound, self._voice.now) > GONE:
                piece = np.zeros(SIZE, np.float32)  # nobody sends any more: it is silent
            else:
                break
            for news in self._voice.hear(piece):
                if self._speaks is None or (self._speaks and news.what == "stress"):
                    self._news.append(SpeechNews(news.what, news.at - self.begun))
            if not due and not self._voice.speaks:
                self._voice, self._sound = None, self._sound[:0]

    def _know(self, plan: Plan, now: float) -> None:
        """Take note of what the character is about to say itself: nobody need tell it."""
        there = {s.id: s.end for s in plan.track.speeches}
        cut = [end for ident, end in self._said.items() if end > now and there.get(ident, now) < end - 1e-6]
        if cut:  # something else came between: what it would have said it does not say
            self._news.append(SpeechNews("hush", now - self.begun))
        self._said = {i: there[i] for i in self._said if i in there}
        for speech in plan.track.speeches:
            if speech.id not in self._said and now - 0.1 <= speech.start <= now + AHEAD:
                self._said[speech.id] = speech.end
                self._news += as_clauses(speech, self.project, self.begun)

    # --- what is made

    def reach(self, now: float, plan: Plan) -> None:
        """Go on to the frame of `now`, seconds that never decrease."""
        due = floor((now - self.begun) * RATE + 1e-6) - self.path.frame
        if due > BEHIND:  # nobody looked for a while: what is missed is not made up for
            self.begun += (due - 1) / RATE
            due = 1
        self.last = now
        self._listen(now)
        self._know(plan, now)
        for _ in range(due):
            news, self._news = self._news, []
            if len(self.told) + len(news) > MOST_TOLD and self._until is None:
                self._until = self.path.frame + 1
            if self._until is None:
                self.told += [(self.path.frame + 1, one) for one in news]
            self.path.step(news)
        for frame in [f for f in self._poses if f < self.path.frame - 1]:
            del self._poses[frame]

    def kept(self) -> KeptMotion:
        """Return what the motion so far can be made again of; up to where more became known than is kept."""
        return KeptMotion(
            graph=self.name,
            size=self.graph.size,
            seed=self.wish.seed,
            begun=self._first,
            frames=self.path.frame + 1 if self._until is None else self._until,
            told=tuple(self.told),
        )

    # --- what is to be seen

    def offsets(self, now: float) -> Array | None:
        """Return how `joints` are turned from the base pose at a time `[n, 4]`, None before it is known."""
        if self.path.frame < 0:
            return None
        place = min(max(0.0, (now - self.begun) * RATE), self.path.frame + self.path.rules.lock - 1.0)
        low = floor(place)
        one, two = self._pose(low), self._pose(low + 1)
        return np.asarray(rotation.nlerp(one, two, np.full(len(one), place - low)))

    def _pose(self, frame: int) -> Array:
        if frame not in self._poses:
            states = self.path.states(frame - FADE - 1, frame + 1)
            self._poses[frame] = fade_turns(self.graph.turns(self.project), states, self.graph.driver)
        return self._poses[frame]

    def _place(self, project: Project) -> None:
        super()._place(project)
        if self.fits(project):
            self.graph.turns(project)
        self._poses = {}


def as_clauses(speech: Speech, project: Project, begun: float) -> list[SpeechNews]:
    """Return a speech of the character as clauses that come, one round each of its accents."""
    accents = [speech.start + float(x) for x in choose_voice(project.voices, speech).accents]
    accents = [x for x in accents if speech.start < x < speech.end]
    edges = [speech.start, *((a + b) / 2 for a, b in pairwise(accents)), speech.end]
    peaks: list[float | None] = [*accents] or [None]
    return [
        SpeechNews("comes", a - begun, b - begun, None if peak is None else peak - begun)
        for (a, b), peak in zip(pairwise(edges), peaks, strict=True)
        if b > a
    ]


def fade_turns(turns: Array, states: Sequence[int], graph: DriverGraph) -> Array:
    """Return the last of these states' turns `[n, 4]`, as what was shown before a transition fades into what
    comes after it. states: those of the frames before it, FADE of them at least where there were as many.
    """
    takes, last = graph.states.starts, len(states) - 1
    jumps = [n for n in range(1, len(states)) if states[n] != states[n - 1] + 1]

    def going_on(state: int, frames: int) -> Array:
        end = int(takes[np.searchsorted(takes, state, "right")]) - 1
        return np.asarray(turns[min(state + frames, end)])

    out = going_on(states[0], last)
    for jump in jumps:
        share = 0.5 - 0.5 * np.cos(np.pi * (last - jump + 1) / (FADE + 1)) if last - jump < FADE else 1.0
        new = going_on(states[jump], last - jump)
        out = np.asarray(rotation.slerp(out, new, np.full(len(out), share)))
    return out
