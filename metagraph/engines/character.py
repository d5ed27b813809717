"""Play an export in Python programs: ask, update, pose. This needs neither Qt nor OpenGL.

    character = Character("talk.json")
    character.ask({"do": "gesture", "tags": ["greeting"]})
    while running:
        pose = character.update(seconds)

It uses the desktop app's planner and composer; the runtimes for engines have their own. All give the same
result for the same input.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf, isfinite
from pathlib import Path
from typing import Any, Literal

import msgspec

from metagraph.engines.reading import read_export
from metagraph.graph import requests as a
from metagraph.graph.model import LAYERS, Layer, Project
from metagraph.graph.offered import list_offered_requests, list_tools
from metagraph.graph.parameter import ParameterValues
from metagraph.motion.skeleton import Pose
from metagraph.playback.evaluator import Evaluator
from metagraph.playback.life.alphabet import ALPHABET
from metagraph.playback.life.items import find_line_start
from metagraph.playback.life.line_timing import VisemeMark
from metagraph.playback.life.speech_watch import SpeechWatch
from metagraph.playback.life.streamed_voice import StreamedVoice
from metagraph.playback.life.utterances import find_forgotten, find_soon
from metagraph.playback.plan import Plan
from metagraph.playback.planning.extend_performance import AskAnswer, answer_ask, answer_asks
from metagraph.playback.planning.running_plan import CUT, RunningPlan
from metagraph.speech.spoken_so_far import spoken_until

LEAP = 3600.0  # seconds by which an update may advance, because everything in between is planned
SOUNDS = 16  # lines whose sound is kept
REMEMBERED = 1000  # final answers that are kept, and events that have not been fetched


@dataclass(frozen=True, slots=True)
class Happening:
    """Something that began or ended.

    `at` is in seconds. `layer` is "speech" for speech. `action` is the action's name, or for speech the
    line's id, else the text. `meta` is the id of the request, or the model's. `reason` is "finished",
    "interrupted" or "replaced" where all that is said under an id is over, else "".
    """

    kind: Literal["begin", "end"]
    at: float
    layer: Layer | Literal["speech"]
    action: str
    meta: str
    reason: str = ""


class Character:
    """One character, played live.

    `export` is the path of an exported JSON with its GLB beside it, or a project. `seed` has 32 bits; None
    takes the project's. With `idle`, the models fill the time without requests. `stances` says where layers
    begin. `ahead` and `recent` are the seconds of plan and of past that are kept. Raises FileError if the
    export cannot be read.
    """

    def __init__(
        self,
        export: str | Path | Project,
        seed: int | None = None,
        idle: bool = True,
        stances: Mapping[Layer, str] | None = None,
        ahead: float = 20.0,
        recent: float = 30.0,
    ) -> None:
        self.project = export if isinstance(export, Project) else read_export(export, resolved=True)
        self.now = 0.0
        self._recent = recent
        self._queue: list[a.AnyRequest] = []
        self._asked: set[str] = set()  # ids that the plan knows
        self._settled: dict[str, AskAnswer] = {}  # answers for those it has forgotten or never knew
        self._happened: list[Happening] = []
        self._sounds: dict[str, StreamedVoice] = {}  # the sounds of lines that stream in
        self._speech = SpeechWatch()
        self._values = ParameterValues()
        self._count = 0
        self._cut = 0.0
        self._seen = -inf  # the time of the previous update
        self._running = RunningPlan(
            self.project, None if seed is None else seed & 0xFFFFFFFF, stances, idle, ahead
        )
        self._evaluator = Evaluator(self.plan, self.project)

    @property
    def plan(self) -> Plan:
        """Return the current plan."""
        return self._running.plan

    @property
    def problems(self) -> tuple[str, ...]:
        """Return what the export lacks, in words; actions without a clip show their stance."""
        return tuple(
            f"clip '{clip.name}' is missing" for clip in self.project.clips.values() if clip.motion is None
        )

    def describe(self) -> dict[str, Any]:
        """Return the possible requests as plain data, see `metagraph.graph.offered.offered`."""
        return list_offered_requests(self.project, a.WORDS)

    def tools(self) -> list[dict[str, Any]]:
        """Return the possible requests as tools that a language model can call, see
        `metagraph.graph.offered.list_tools`.
        """
        return list_tools(self.project)

    def ask(self, request: Mapping[str, Any] | a.AnyRequest) -> str:
        """Send a request; return its id, which is made if it has none. It is planned at the next update.

        `after`, in seconds from now, replaces `at`. A request that cannot be read is refused, as `answer`
        reports; nothing is raised.
        """
        self._count += 1
        made = f"#{self._count}"
        if isinstance(request, a.Request):
            ask: a.AnyRequest = request if request.id else msgspec.structs.replace(request, id=made)
            return self._take(ask)
        data = dict(request) if isinstance(request, Mapping) else {}  # an empty request, which is refused
        ident = data.get("id")
        data["id"] = ident = ident if isinstance(ident, str) and ident else made
        try:
            if "after" in data:
                after = _seconds(data.pop("after"))
                if after is None or after < 0:
                    return self._refuse(ident, "after: should be a number of seconds from now")
                data["at"] = self.now + after
            return self._take(a.make_request(data))
        except a.RequestError as error:
            return self._refuse(ident, str(error))

    def set_parameter(self, name: str, value: Any = None) -> str:
        """Set a parameter of the project; return the id of the request that this makes. A number outside of
        its range becomes the nearest inside, a trigger has no value, and to set a value again that is already
        set changes nothing. What cannot be set is refused, as `answer` reports; nothing is raised.
        """
        parameters = self.project.parameters
        if self._values.has(parameters, name, value):
            return self._values.made[name]
        try:
            request = self._values.take(parameters, name, value)
        except a.RequestError as error:
            self._count += 1
            return self._refuse(f"#{self._count}", str(error))
        self._values.made[name] = ident = self.ask(request)
        return ident

    def get_parameter(self, name: str) -> Any:
        """Return the value that a parameter was set to, else its first one; None for a trigger and for a name
        that is not known.
        """
        return self._values.get(self.project.parameters, name)

    def say_sound(self, ident: str, samples: Sequence[float], rate: float) -> str:
        """Say a line whose sound streams in while it is said. Each call gives its next samples, -1..1, and
        the lips follow what is heard in them. One id is one line's; it is returned, as by `ask`. `rate` is in
        samples a second, 8000 to 48000.
        """
        if not 8000 <= rate <= 48000:
            return self._refuse(ident, "rate: should be a number from 8000 to 48000")
        begun = self.plan.track.last_speech(ident)
        waiting = next((x for x in self._queue if isinstance(x, a.Say) and x.id == ident), None)
        voice = self._sounds.pop(ident, None)
        if voice is None or voice.rate != rate or (begun is None and waiting is None):
            voice = StreamedVoice(float(rate))
        if begun is not None:
            voice.follow(find_soon(self.now, self.project.settings.lookahead) - find_line_start(begun))
        self._sounds[ident] = voice
        if len(self._sounds) > SOUNDS:
            del self._sounds[next(iter(self._sounds))]
        before = waiting.visemes if waiting is not None else ()
        self._queue = [x for x in self._queue if x is not waiting]
        start = voice.seconds
        # If no shape begins here, the previous one continues.
        marks = voice.hear(samples) or [VisemeMark(start, voice.shape, voice.weight)]
        told = [[mark.at, mark.viseme, mark.weight] for mark in marks]
        return self.ask({"do": "say", "id": ident, "visemes": [*before, *told], "set": "oculus"})

    def _take(self, ask: a.AnyRequest) -> str:
        self._settled.pop(ask.id, None)
        self._asked.add(ask.id)
        self._queue.append(ask)
        return ask.id

    def _refuse(self, ident: str, why: str) -> str:
        self._settle(AskAnswer(ident, "refused", None, None, (), why))
        return ident

    def _settle(self, final: AskAnswer) -> None:
        """Keep an answer that will not change any more."""
        self._asked.discard(final.id)
        self._settled.pop(final.id, None)
        self._settled[final.id] = final
        if len(self._settled) > REMEMBERED:
            del self._settled[next(iter(self._settled))]

    def update(self, now: float) -> Pose:
        """Advance to `now` and return the pose there (rotations `[J, 4]`, translations `[J, 3]`).

        `now` is in seconds of the character's own time, which begins at 0, never goes backwards, and advances
        by at most an hour.
        """
        seconds = _seconds(now)
        if seconds is not None and seconds > self.now:
            self.now = min(seconds, self.now + LEAP)
        try:
            self._plan_on()
        except (
            Exception
        ) as error:  # a fault of our own must not stop the game: the character goes on with the plan it has
            for ask in self._queue:
                self._refuse(ask.id, f"the planner failed: {error}")
            self._queue = []
        self._listen()
        return self.pose()

    def _plan_on(self) -> None:
        for ident in find_forgotten(self.plan.track, self.now):
            self._queue.append(a.Finish(id=f"{ident}.0", what=ident))
        self._running.reach(self.now)
        self._running.hear(self.now, self._queue)
        for ask in self._queue:
            if isinstance(ask, a.Withdraw | a.Interrupt | a.Pause | a.Resume | a.Finish):
                self._settle(AskAnswer(ask.id, "done", None, None, (), ""))
        self._queue = []
        if self._seen - self._cut >= CUT:  # what has begun and ended since then is still to be reported
            self._cut = self._seen
            self._forget(self._seen - self._recent)

    def _forget(self, over: float) -> None:
        """Forget what is over, and settle the answers of its requests."""
        known = answer_asks(self.plan, self._asked)
        self._running.forget(over)
        left = answer_asks(self.plan, self._asked)
        for ident, told in known.items():
            # What the plan no longer knows was played; so was a look without an end that another one
            # replaced.
            if told.until is not None and (told.until < over or left[ident].until is None):
                self._settle(replace(told, state="done"))
            elif told.state in ("refused", "done"):
                self._settle(told)

    def _listen(self) -> None:
        """Note what has begun or ended since the previous update."""
        found: list[Happening] = []

        for layer in LAYERS:
            for cue in self.plan.layers[layer].cues:
                meta = cue.meta.partition("+")[0]  # what goes on after a cut is the same
                if self._seen < cue.start <= self.now:
                    found.append(Happening("begin", cue.start, layer, cue.action.name, meta))
                if self._seen < cue.end <= self.now:
                    found.append(Happening("end", cue.end, layer, cue.action.name, meta))
        for e in self._speech.watch(self.plan.track.speeches, self._seen, self.now):
            kind: Literal["begin", "end"] = "begin" if e.kind == "begin" else "end"
            found.append(Happening(kind, e.at, "speech", e.said, e.id, e.reason))
        self._seen = self.now
        if found:
            self._happened = [*self._happened, *sorted(found, key=lambda event: event.at)][-REMEMBERED:]

    def events(self) -> tuple[Happening, ...]:
        """Return what began and ended since the last call, in order of time; at most the latest 1000."""
        happened, self._happened = self._happened, []
        return tuple(happened)

    def answer(self, ident: str) -> AskAnswer:
        """Return what became of a request: when it plays, or why it does not."""
        if ident in self._settled:
            return self._settled[ident]
        if ident not in self._asked:
            return AskAnswer(ident, "refused", None, None, (), f"nothing was asked for as '{ident}'")
        if any(ask.id == ident for ask in self._queue):
            return AskAnswer(ident, "planned", None, None, (), "taken up at the next update")
        return answer_ask(self.plan, ident)

    def spoken(self, ident: str) -> tuple[str, str]:
        """Return what of something said was spoken until now, up to the word that was begun, and that word;
        "" if nothing was.
        """
        return spoken_until(ALPHABET, self.plan.track.speeches, ident, self.now)

    def pose(self, alive: bool = True) -> Pose:
        """Return the pose at the time of the last update. With `alive`, it has the life layers."""
        self._evaluator = self._evaluator.follow(self.plan, self.project)
        return self._evaluator.at(self.now, alive)

    def morphs(self, alive: bool = True) -> dict[str, float]:
        """Return the morph target weights, 0..1, at the time of the last update."""
        self._evaluator = self._evaluator.follow(self.plan, self.project)
        return self._evaluator.morphs_at(self.now, alive)


def _seconds(value: Any) -> float | None:
    """Return a finite number, or None for anything else."""
    try:
        number = inf if isinstance(value, bool | str | bytes) else float(value)
    except (TypeError, ValueError, OverflowError):
        return None
    return number if isfinite(number) else None
