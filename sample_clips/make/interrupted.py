"""Films a conversation of two minutes in which a person interrupts the character four times.

    python -m sample_clips.make.interrupted FOLDER [--pictures]

Both speak with eSpeak NG. An agent drives a live session as it would over a line: it sends the times of the
words and gestures for them, hears the person for `NOTICED` seconds before it interrupts, and plays its sound
no further than the reply says. Writes `interrupted.mp4`, and a strip of pictures around each interruption.
--pictures: the strips alone. Nothing of it is kept among the samples.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from app.stage.cutting import Filmed
from app.stage.filming import make_project_figure, render_pictures
from app.stage.playback_source import ShownPlayback
from metagraph.formats.store import open_project
from metagraph.graph.model import Project
from metagraph.live.live_session import LiveSession
from metagraph.playback.planning.running_plan import list_kept_asks, plan_performance
from metagraph.speech.text_gestures import make_gesture_requests, propose_gestures, timed_words
from preview.camera import make_upper_body_camera
from preview.looks import look_of
from preview.sheet import make_contact_sheet, write_png
from preview.video import write_video
from sample_clips.make.talk import RATE, SpeakingVoice, Turn, speak

SAMPLE = Path(__file__).resolve().parents[1] / "sample.metagraph.yaml"
TICK = 1 / 60  # seconds
NOTICED = 0.2  # seconds of a voice after which an agent knows that it is one
PAUSE = 0.9  # seconds before an answer, and after one
FADE = 0.01  # seconds in which a sound that is cut ends
SEED = 4
USER = (0.35, 1.5, 1.6)  # metres, where the person's face is; the camera looks from there
FPS = 25
SIZE, SMALL = (640, 360), (240, 300)  # pixels of the video and of a strip's pictures
PERSON, CHARACTER = 0, 1
VOICES: tuple[SpeakingVoice, ...] = (("en-us+f3", 58, 170), ("en-us", 38, 160))
Array = NDArray[np.float64]


@dataclass(frozen=True)
class Exchange:
    """What the person says and the character answers, in clauses as `Turn` has them. cut: seconds of the
    answer after which the person says the next; None if it is heard whole.
    """

    says: tuple[str, ...]
    answers: tuple[str, ...]
    cut: float | None = None


TALK = (
    Exchange(
        ("hello there", "can you tell me about the *city*"),
        (
            "hello and *welcome*",
            "this is a very *old* city by the river",
            "it was built by people who sold *salt*",
            "and they carried it over the *whole* country",
            "so most of the old houses are *theirs*",
        ),
    ),
    Exchange(
        ("what should I see *first*",),
        (
            "first of all you should see the *bridge*",
            "it is the *biggest* one that was ever built of wood",
            "and from up there you see *everything*",
            "the market and the towers and the *gardens*",
            "and all of the *boats* that come in at night",
        ),
        6.1,
    ),
    Exchange(
        ("wait a moment", "is it *far* from here"),
        (
            "no it is *not* far at all",
            "you go down this street to the *end*",
            "then you turn left at the *big* clock",
            "and there it is *right* before you",
            "it takes about *ten* minutes",
        ),
    ),
    Exchange(
        ("good", "and where can I *eat* something"),
        (
            "well there are *many* places",
            "if you like fish there is a *small* house at the harbour",
            "they cook what the boats brought in the *morning*",
            "and if you do not like *fish*",
            "there is a *huge* kitchen in the market hall",
            "where everybody sits at *one* long table",
        ),
        8.8,
    ),
    Exchange(
        ("sorry I do *not* eat fish",),
        (
            "oh then *forget* the harbour",
            "go to the market hall *instead*",
            "they have bread and soup and *all* kinds of cheese",
            "and the best *cakes* that I know",
            "you *must* try the one with plums",
            "and if you come late they give you *two* for one",
        ),
        10.5,
    ),
    Exchange(
        (
            "hold on",
            "when does it *close*",
        ),
        (
            "it closes at *nine* in the evening",
            "but on Sunday it is *never* open",
            "so you should go *today* or tomorrow",
        ),
    ),
    Exchange(
        ("and is there any *music* in the evening",),
        (
            "there is music in *every* street",
            "some of it is *good* and some is only loud",
            "on Friday a *very* small band plays at the bridge",
            "three sisters and their *grandmother*",
            "she is more than *eighty* years old",
            "and she plays the *drums*",
        ),
        4.8,
    ),
    Exchange(
        (
            "no way",
            "her *grandmother* plays the drums",
        ),
        (
            "yes I *know* nobody believes it",
            "but everybody who has *heard* her comes back",
            "so *do* go there and see for yourself",
        ),
    ),
    Exchange(
        ("and where do you *live*",),
        (
            "I live on the *other* side of the river",
            "in a *tiny* house with a red door",
            "it has two rooms and a *wonderful* garden",
            "and *three* cats who think that it is theirs",
        ),
    ),
    Exchange(
        ("that sounds *nice*", "how do I get *back* in the evening"),
        (
            "the last boat goes at *eleven*",
            "and after that you *have* to walk",
            "but you *never* walk alone there",
            "for *everybody* goes home at that time",
        ),
    ),
    Exchange(
        (
            "I *will*",
            "thank you very much",
        ),
        (
            "you are *welcome*",
            "and tell me how you *liked* it",
            "have a *good* time here",
        ),
    ),
)


@dataclass(frozen=True)
class Interruption:
    """at: when it was asked for; stops: when the voice stops, seconds. spoken: what was said until then."""

    at: float
    stops: float
    spoken: str


@dataclass
class Conversation:
    """A session in the making. sound: where each piece of it begins, seconds, and its samples."""

    project: Project
    sound: list[tuple[float, Array]] = field(default_factory=list)
    interruptions: list[Interruption] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.session = LiveSession(self.project, seed=SEED)
        self.session.join(1)
        self.answers = 0
        self.events: list[dict[str, Any]] = []
        self.ask(do="hello", name="guide", events=True)
        self.ask(do="place", name="user", point=list(USER))
        self.ask(do="look", to="user")

    def tick(self) -> Any:
        """Go on by a tick."""
        out = self.session.tick(self.session.now + TICK)
        self.events += [msgspec.to_builtins(event) for _, event in out.events]
        return out

    def wait(self, until: float) -> None:
        """Let time pass."""
        while self.session.now < until:
            self.tick()

    def ask(self, **request: Any) -> dict[str, Any]:
        """Return the reply to a request."""
        self.session.receive(1, json.dumps(request))
        (reply,) = self.tick().replies
        return dict(json.loads(reply) if isinstance(reply, bytes) else msgspec.to_builtins(reply))

    def hold(self, exchange: Exchange, answer: str) -> None:
        """Let the person say something, and the character answer. answer: what is said when this begins, ""
        for nothing.
        """
        voice, _ = say(PERSON, exchange.says)
        begin = self.session.now
        if answer:
            self.wait(begin + NOTICED)
            told = self.ask(do="interrupt", what=answer)
            self.interruptions.append(Interruption(self.session.now, told["at"], told["spoken"]))
            at, samples = self.sound[-1]
            self.sound[-1] = at, cut_sound(samples, told["skip"])
        self.sound.append((begin, voice))
        self.ask(do="mode", mode="listening")
        self.wait(begin + len(voice) / RATE + PAUSE)
        self.ask(do="mode")
        self.answer(exchange)

    def answer(self, exchange: Exchange) -> None:
        """Let the character answer, until it is over or the person begins to talk in."""
        self.answers += 1
        ident = f"answer{self.answers}"
        voice, words = say(CHARACTER, exchange.answers)
        text = " ".join(word for word, *_ in words)
        start = self.ask(do="say", id=ident, words=words)["at"]
        graphs = self.project.graphs
        tags = {layer: {t for x in graphs[layer].actions.values() for t in x.tags} for layer in graphs}
        made = propose_gestures(timed_words(text, words), tags, seed=self.answers)
        for request in make_gesture_requests(made, start, ident):
            self.ask(**request)
        self.sound.append((start, voice))
        length = len(voice) / RATE + PAUSE
        self.wait(start + (length if exchange.cut is None else exchange.cut))

    def mix(self) -> Array:
        """Return the sound of all of it, `[N]`."""
        out = np.zeros(round(self.session.now * RATE))
        for at, samples in self.sound:
            first = round(at * RATE)
            kept = samples[: len(out) - first]
            out[first : first + len(kept)] += kept
        return out


def say(side: int, clauses: tuple[str, ...]) -> tuple[Array, list[tuple[str, float, float]]]:
    """Return how one says clauses: samples `[N]`, and words with their times. Raises MissingError."""
    talk = speak((Turn(side, 0.0, clauses),), noise=0.0, voices=VOICES)
    words = list(talk.words[side])
    return talk.samples[side, : round(words[-1][2] * RATE)], words


def cut_sound(samples: Array, seconds: float) -> Array:
    """Return the first seconds of a sound, which fade at their end."""
    fade = round(FADE * RATE)
    out = samples[: round(seconds * RATE) + fade].copy()
    out[-fade:] *= np.linspace(1.0, 0.0, fade)
    return out


def converse(project: Project, talk: tuple[Exchange, ...] = TALK) -> Conversation:
    """Return the conversation when it is over. Raises MissingError if eSpeak NG is not there."""
    out, before = Conversation(project), ""
    out.wait(0.8)
    for exchange in talk:
        out.hold(exchange, before)
        before = "" if exchange.cut is None else f"answer{out.answers}"
    out.wait(out.session.now + 1.0)
    return out


def main() -> None:
    folder = Path(next(word for word in sys.argv[1:] if not word.startswith("-")))
    project = open_project(SAMPLE).project
    talk = converse(project)
    kept = talk.session.performance("Interrupted")
    plan = plan_performance(
        project, list_kept_asks(kept), kept.length, kept.seed, dict(kept.stances), kept.idle
    )
    shown = ShownPlayback(project, plan, kept.length)
    figure = make_project_figure(project, SAMPLE.parent)
    head = figure.head(*figure.skeleton.globals(figure.skeleton.rest))
    turn = np.arctan2(USER[0], USER[2]) - np.radians(20.0)  # that camera turns by as much
    folder.mkdir(parents=True, exist_ok=True)

    def draw(times: Array, size: tuple[int, int]) -> Iterator[Any]:
        camera = make_upper_body_camera(head, figure.height, size[0] / size[1], turn)
        return render_pictures([(figure, shown)], times, size, look_of("light"), lambda at: Filmed(camera))

    for n, one in enumerate(talk.interruptions):
        playing = [cue.action.name for cue in plan.layers["arms"].cues if cue.start < one.at < cue.end]
        doing = ", ".join(playing) or "no gesture"
        print(f"{one.at:6.2f} s  voice stops {one.stops - one.at:+.3f} s, {doing}  '{one.spoken}'")
        times = one.at + np.arange(-3, 13) * 0.1
        words = [f"{t - one.at:+.1f} s" for t in times]
        write_png(folder / f"interruption-{n + 1}.png", make_contact_sheet([*draw(times, SMALL)], 8, words))
    if "--pictures" not in sys.argv:
        times = np.arange(round(kept.length * FPS)) / FPS
        write_video(folder / "interrupted.mp4", draw(times, SIZE), FPS, SIZE, sound=(talk.mix(), RATE))
    print(f"{kept.length:.0f} s in all")


if __name__ == "__main__":
    main()
