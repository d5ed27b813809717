"""Define what can be requested of a character at any level of abstraction, and lines and performances, which
hold requests.

Agents send requests, performances save them and the timeline edits them, with the same fields everywhere. In
JSON, `do` names the kind: {"do": "gesture", "layer": "arms", "tags": ["positive"], "at": 2.1, "priority": 3}.
Times are seconds of the performance, lengths are seconds, points are metres in the character's space (Y up,
the character looks along +Z).
"""

from __future__ import annotations

from typing import Annotated, Any, Literal, Union, get_args

import msgspec
from msgspec import Meta, Struct

from metagraph.graph.words import Feeling, Layer, Limb, Mode

LONGEST_NAME = 200  # letters of a performance's name
LONGEST_PERFORMANCE = 36000  # seconds; an integer, because schemas show it
Id = Annotated[str, Meta(min_length=1, max_length=200)]
Seconds = Annotated[float, Meta(ge=0, le=1e6, description="seconds")]
# The type allows any length: msgspec mistakes a text of limited length beside a tuple of fixed length, and
# crashes.
Point = Annotated[
    tuple[Annotated[float, Meta(ge=-1e6, le=1e6)], ...],
    Meta(min_length=3, max_length=3, description="x, y, z; metres"),
]
Timed = tuple[Any, ...] | dict[str, Any]  # checked where lines are read; synthesisers differ
Late = Annotated[float, Meta(ge=0, le=600, description="seconds")] | None
# A named mood, or valence and arousal, -1..1.
MoodPoint = (
    Feeling
    | Annotated[
        tuple[Annotated[float, Meta(ge=-1, le=1)], ...],
        Meta(min_length=2, max_length=2, description="valence, arousal; -1 to 1"),
    ]
    | None
)
Intensity = Annotated[float, Meta(ge=0, le=2, description="1 as made")] | None
Tags = tuple[Annotated[str, Meta(max_length=200)], ...]


class Request(
    Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True, tag_field="do"
):
    """What all requests have in common. id: made up if empty; the same id again replaces the earlier request.
    at: when it should begin, null for as soon as possible. told: when it became known, null for from the
    start; a planner that acts before then does not know of it. priority: a higher number wins over a lower
    one; what a model writes gives way to every request.
    """

    id: Annotated[str, Meta(max_length=200)] = ""
    at: Seconds | None = None
    told: Seconds | None = None
    priority: Annotated[int, Meta(ge=-1000, le=1000)] = 1


class Gesture(Request, frozen=True, tag="gesture"):
    """A gesture of the stance that the layer is in. tags: all of them must fit. limb: a wish; if the stance
    has no such gesture, another one plays and the report says so. duration: how long the activity should
    last. stroke: when its most telling moment should come, instead of `at`. hold: seconds that its hold
    should last. prepare: whether the preparation plays. resume: whether the rest of it continues after
    something more important has cut it. late: by how much its stroke may come late, or its start if no stroke
    is given: 0 for on time or not at all, null for as late as the planner's settings allow. mood, intensity:
    how it is played, null for as the character is then.
    """

    layer: Layer = "arms"
    tags: Tags = ()
    limb: Limb | None = None
    duration: Seconds | None = None
    stroke: Seconds | None = None
    hold: Annotated[float, Meta(ge=0, le=600)] | None = None
    prepare: bool = True
    resume: bool = False
    late: Late = None
    mood: MoodPoint = None
    intensity: Intensity = None


class Fidget(Request, frozen=True, tag="fidget"):
    """A fidget of the stance that the layer is in. late, mood, intensity: as for a gesture."""

    layer: Layer = "arms"
    tags: Tags = ()
    limb: Limb | None = None
    duration: Seconds | None = None
    resume: bool = False
    late: Late = None
    mood: MoodPoint = None
    intensity: Intensity = None


class Play(Request, frozen=True, tag="action"):
    """One action, by id or name; the layer goes to its stance first. duration: for how long it goes on if it
    repeats, null for as long as it is set to; others take their own time. stroke, hold, prepare, late, mood,
    intensity: as for a gesture.
    """

    action: Id
    layer: Layer | None = None
    duration: Seconds | None = None
    stroke: Seconds | None = None
    hold: Annotated[float, Meta(ge=0, le=600)] | None = None
    prepare: bool = True
    late: Late = None
    mood: MoodPoint = None
    intensity: Intensity = None


class Go(Request, frozen=True, tag="stance"):
    """Go to a stance, by id or name, by the shortest chain of transitions. stay: the models do not leave it
    until another stance is requested or this request is withdrawn. late: by how much it may set off late.
    """

    stance: Id
    layer: Layer | None = None
    stay: bool = False
    late: Late = None


class Change(Request, frozen=True, tag="change"):
    """Change to any other stance: a transition is drawn from those of the stance that the layer is in. limb,
    duration: which arm was seen to move, and for how long; any transition may be drawn, with its own length.
    late: as for a stance.
    """

    layer: Layer = "arms"
    limb: Limb | None = None
    duration: Seconds | None = None
    late: Late = None


class Nod(Request, frozen=True, tag="nod"):
    """Nod: a gesture of the head with this tag or name. late, mood, intensity: as for a gesture."""

    tags: Tags = ()
    late: Late = None
    mood: MoodPoint = None
    intensity: Intensity = None


class Shake(Request, frozen=True, tag="shake"):
    """Shake the head. late, mood, intensity: as for a gesture."""

    tags: Tags = ()
    late: Late = None
    mood: MoodPoint = None
    intensity: Intensity = None


class Look(Request, frozen=True, tag="look"):
    """Look at a point, a named point ("user", another character), or "ahead". duration: null until the next
    look. amount: 0 turns nothing, 1 all the way. strict: the gaze is never averted while it lasts.
    """

    to: Annotated[str, Meta(min_length=1, max_length=200)] | Point = "user"
    duration: Seconds | None = None
    amount: Annotated[float, Meta(ge=0, le=1)] = 1.0
    strict: bool = False


class Blink(Request, frozen=True, tag="blink"):
    """Blink once."""


class Say(Request, frozen=True, tag="say"):
    """Say a line of the project with its audio, lip sync and requests, or say other words with `text`, whose
    length is `duration` or guessed from the words. gestures: whether the line's own requests are made. words:
    [word, start, end], seconds from the line's start, as a synthesiser gives them: the lips follow them and
    are shut between them; `text` may then be left out. visemes: [seconds, name] and, if known, how fully it
    is made, 0..1; each lasts until the next. Both may be objects, as in Amazon Polly's speech marks and
    Azure's events. set: the naming of the visemes; null to detect it. characters: [letter, start, end]
    instead of words, as some synthesisers give them; blanks part words. While a line is said, a later request
    with its id adds to it what comes after now; text alone is said behind text alone. more: whether more of
    it comes under its id; it is then not over when it falls silent, and text may come in pieces of words.
    audio: only in a live session, the next samples of the line's sound, 16-bit little-endian numbers in
    base64, one channel, `rate` a second: the lips follow its loudness if there are neither words nor visemes.
    mood, intensity: while it is said, null for the line's own, else as the character is then.
    """

    line: Annotated[str, Meta(min_length=1, max_length=200)] | int | None = None
    text: Annotated[str, Meta(max_length=20000)] = ""
    duration: Seconds | None = None
    gestures: bool = True
    words: Annotated[tuple[Timed, ...], Meta(max_length=4000)] = ()
    visemes: Annotated[tuple[Timed, ...], Meta(max_length=20000)] = ()
    characters: Annotated[tuple[Timed, ...], Meta(max_length=20000)] = ()
    more: bool = False
    set: Literal["oculus", "azure", "sapi", "polly", "arkit"] | None = None
    audio: Annotated[str, Meta(max_length=60000)] | None = None
    rate: Annotated[int, Meta(ge=8000, le=48000)] = 16000
    mood: MoodPoint = None
    intensity: Intensity = None


class Behave(Request, frozen=True, tag="mode"):
    """Idle, listen or talk from now on; null talks while something is said and idles otherwise."""

    mode: Mode | None = None


class Feel(Request, frozen=True, tag="mood"):
    """Be in a mood from now on: it decides which actions are likely, how large and fast they are played,
    breath, blinks, gaze, posture and face. mood: a name, or valence and arousal; null leaves it. intensity:
    how large gestures are played and how much posture and face show; null leaves it. duration: null until the
    next; afterwards the earlier mood comes back.
    """

    mood: MoodPoint = None
    intensity: Intensity = None
    duration: Seconds | None = None


class Place(Request, frozen=True, tag="place"):
    """Put a named point somewhere, so that the character can look at it; the gaze follows it."""

    name: Id
    point: Point


class Withdraw(Request, frozen=True, tag="withdraw"):
    """Withdraw the request with an id and what was made for what it says (`<id>/1`), or all requests if
    `what` is empty. What has begun is left, except for changes of stance and a look at the user.
    """

    what: Annotated[str, Meta(max_length=200)] = ""


class Interrupt(Request, frozen=True, tag="interrupt"):
    """Break off what is said under an id, or all that is said if `what` is empty, because the partner speaks:
    the voice stops at its next sound, gestures made for it go back to their stance within 0.4 s, and the gaze
    goes to the partner. The answer has what was spoken until then.
    """

    what: Annotated[str, Meta(max_length=200)] = ""


class Pause(Request, frozen=True, tag="pause"):
    """Hold what is said under an id, or all that is said if `what` is empty, at its next sound. What comes
    for it waits, and so do its gestures that have not begun.
    """

    what: Annotated[str, Meta(max_length=200)] = ""


class Resume(Request, frozen=True, tag="resume"):
    """Go on with what was paused under an id, or with all that was if `what` is empty, where it stopped."""

    what: Annotated[str, Meta(max_length=200)] = ""


class Finish(Request, frozen=True, tag="finish"):
    """Say that no more comes of what is said under an id with `more`, or of all that is if `what` is empty:
    it is over when it falls silent.
    """

    what: Annotated[str, Meta(max_length=200)] = ""


class Bml(Request, frozen=True, tag="bml"):
    """A block of Behaviour Markup Language; the parts that are understood become requests."""

    bml: Annotated[str, Meta(max_length=200000)]


AnyRequest = Union[  # noqa: UP007 - msgspec reads it at run time
    Gesture, Fidget, Play, Go, Change, Nod, Shake, Look, Blink, Say, Behave, Feel, Place, Withdraw,
    Interrupt, Pause, Resume, Finish, Bml,
]  # fmt: skip


class Line(Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True):
    """A line of dialogue, which an agent calls by its id. audio, phones: paths, relative to the project file,
    of a sound file and of a Praat TextGrid with phones or words. channel: the line's channel in the sound,
    from 0; null for all mixed. duration: seconds, if there is no audio. asks: requests, with times from the
    line's start. mood, intensity: in which it is said, null for as the character is then.
    """

    text: Annotated[str, Meta(max_length=20000)] = ""
    audio: str | None = None
    channel: Annotated[int, Meta(ge=0, le=63)] | None = None
    phones: str | None = None
    duration: Seconds | None = None
    asks: tuple[AnyRequest, ...] = ()
    mood: MoodPoint = None
    intensity: Intensity = None


class Performance(Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True):
    """A kept performance: its requests and the seed it was played with. seed: null for the project's. length:
    seconds. idle: whether the models fill the time without requests. mode: what the character does while
    they do, until a request says otherwise. stances: layer -> the stance it begins in. mood, intensity: for
    all of it, null for the character's own.
    """

    name: Annotated[str, Meta(max_length=LONGEST_NAME)]
    asks: tuple[AnyRequest, ...] = ()
    seed: Annotated[int, Meta(ge=0, le=0xFFFFFFFF)] | None = None
    length: Annotated[float, Meta(gt=0, le=LONGEST_PERFORMANCE)] = 60.0
    idle: bool = True
    mode: Mode = "talking"
    stances: dict[Layer, str] = {}
    mood: MoodPoint = None
    intensity: Intensity = None


class RequestError(ValueError):
    """Raised for a request that cannot be read or understood; the message says what is wrong and what is
    allowed.
    """


_decoder: msgspec.json.Decoder[AnyRequest] = msgspec.json.Decoder(AnyRequest)


def read_request(text: bytes | str) -> AnyRequest:
    """Read a request from JSON text. Raises RequestError naming the field."""
    try:
        return _decoder.decode(text)
    except (msgspec.ValidationError, msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise RequestError(explain_invalid_ask(error)) from None


def make_request(data: Any) -> AnyRequest:
    """Make a request from plain data. Raises RequestError naming the field."""
    try:
        out: AnyRequest = msgspec.convert(data, AnyRequest)
        return out
    except (msgspec.ValidationError, RecursionError) as error:
        raise RequestError(explain_invalid_ask(error)) from None


def explain_invalid_ask(error: Exception) -> str:
    """Return the error of a reader as text for people: the field, then what is wrong."""
    text = str(error)
    if isinstance(error, msgspec.ValidationError):
        message, _, where = text.partition(" - at ")
        field = where.strip("`").removeprefix("$").lstrip(".")
        if "Invalid value" in message and field == "do":
            message += f"; known are {', '.join(WORDS)}"
        elif message.startswith("Invalid enum value"):
            message += f"; it is one of {', '.join(_choices(field))}"
        return f"{field}: {message}" if field else message
    return f"not JSON: {text}"


def _choices(field: str) -> tuple[str, ...]:
    """Return the words that may stand in a field of requests."""
    found: dict[str, None] = {}
    for kind in ask_schema()["$defs"].values():
        value = kind.get("properties", {}).get(field.rpartition(".")[2], {})
        for one in (value, *value.get("anyOf", ())):
            found.update(dict.fromkeys(str(word) for word in one.get("enum", ()) if word is not None))
    return tuple(found)


WORDS: tuple[str, ...] = tuple(str(kind.__struct_config__.tag) for kind in get_args(AnyRequest))


def ask_schema() -> dict[str, Any]:
    """Return the JSON Schema (draft 2020-12) of a request."""
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Metagraph request",
        "description": "What can be asked of a character, at any level. Times are seconds, points metres, Y "
        "up.",
        **msgspec.json.schema(AnyRequest),
    }
