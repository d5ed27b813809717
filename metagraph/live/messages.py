"""Define what a client may send and what it gets: JSON objects, one or a list of them in a message.

A request is one for the character (`metagraph.graph.requests`), which may say `in` seconds from now instead
of `at`, or one for the session itself, such as hello, status and describe. Every request gets exactly one
reply; what happens later is sent as events to clients that want them.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal, Union, get_args, overload

import msgspec
from msgspec import UNSET, Meta, Struct, UnsetType

from metagraph.common.field_errors import explain_validation
from metagraph.graph import requests as a
from metagraph.graph.words import LAYERS, Layer

LONGEST = 64 * 1024  # bytes of one request
LONGEST_BML = 256 * 1024  # bytes of a request with a block of BML
LONGEST_MESSAGE = 1024 * 1024  # bytes of one message, a list of requests
MOST = 1000  # requests in one list
FASTEST = 120.0  # poses a second, at most

Space = Literal["local", "model"]


class Poses(Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True):
    """How poses are streamed. rate: frames a second. format: "osc" for clients that speak it, "vmc" where the
    server sends to a program that receives VMC. joints: their names, in order; all if null. space: rotations
    relative to the parent joint, or positions and rotations in the character's space. translations: of all
    joints, not only the root's.
    """

    rate: Annotated[float, Meta(gt=0, le=FASTEST)] = 30.0
    format: Literal["json", "binary", "osc", "vmc"] = "json"
    joints: Annotated[tuple[str, ...], Meta(max_length=1000)] | None = None
    space: Space = "local"
    translations: bool = False


class _Own(Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True, tag_field="do"):
    id: Annotated[str, Meta(max_length=200)] = ""


class Hello(_Own, frozen=True, tag="hello"):
    """Says who the client is and what it wants to receive; may be sent again to change that. token: if the
    server asks for one. poses: null for none. events: whether to report when this client's requests change,
    start and end; "all" also reports what plays on its own and what others requested.
    """

    name: Annotated[str, Meta(max_length=200)] = ""
    token: Annotated[str, Meta(max_length=1000)] = ""
    poses: Poses | UnsetType | None = UNSET
    events: bool | Literal["all"] | UnsetType = UNSET


class Status(_Own, frozen=True, tag="status"):
    """What is playing, and how much waits."""


class Describe(_Own, frozen=True, tag="describe"):
    """What can be requested of this character: its joints, stances, actions, tags, lines, points and
    parameters.
    """


class SetParameter(_Own, frozen=True, tag="set"):
    """Set a parameter of the character, a named value that its author declared, such as its mood or where it
    looks. describe lists them. value: a number, true or false, a word, a list of words, three numbers
    (metres), or nothing for a trigger. It is answered as the request that it makes.
    """

    name: a.Id
    value: bool | float | str | tuple[float | str, ...] | None = None


Place = Annotated[tuple[Annotated[float, Meta(ge=-1e7, le=1e7)], ...], Meta(min_length=2, max_length=3)]
Share = Annotated[float, Meta(ge=0, le=1)]


class Keypoints(_Own, frozen=True, tag="keypoints"):
    """A person before a camera at this moment, whom the character mimics. points: `[x, y]` of a picture or
    `[x, y, z]` of space, 17 (COCO), 18, 25 (OpenPose) or 33 (MediaPipe) of them, y downwards, z away from the
    camera. confidence: of each point; 0 if it was not found. mirror: the character moves its right if the
    person moves the left. gaze: it looks where the head is turned, too. layers: those that mimic. priority:
    of the requests that follow.
    """

    points: Annotated[tuple[Place, ...], Meta(min_length=17, max_length=33)]
    confidence: Annotated[tuple[Share, ...], Meta(max_length=33)] | None = None
    mirror: bool = True
    gaze: bool = False
    layers: tuple[Layer, ...] = LAYERS
    priority: Annotated[int, Meta(ge=-1000, le=1000)] = 1


Sound = Annotated[bytes, Meta(max_length=48 * 1024)]


class Generate(_Own, frozen=True, tag="generate"):
    """Motion generated live by a learned model or a motion graph from what is heard; it replaces the layers
    of the arms and the head, except where a client requests something of these by name. model: its name, as
    describe lists models and graphs; null ends it. side: whether the character listens to the voice, or
    speaks with it. seed: another seed gives other motion. temperature, ahead, only for models: how much is
    random, and by how many seconds it may lag behind the sound, to know what follows.
    """

    model: Annotated[str, Meta(max_length=200)] | None
    side: Literal["listener", "speaker"] = "listener"
    seed: Annotated[int, Meta(ge=0, le=2**32 - 1)] = 1
    temperature: Annotated[float, Meta(ge=0, le=1.2)] = 1.0
    ahead: Annotated[float, Meta(ge=0, le=1)] = 0.2


class Comes(Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True):
    """What is going to be said, for a motion graph. kind: a clause or a response of the character, a
    hesitation of its partner. at: seconds of the session; in: seconds from now, instead. duration: seconds.
    stress: seconds from its beginning to its stress; null if unknown.
    """

    kind: Literal["clause", "response", "hesitation"] = "clause"
    at: Annotated[float, Meta(ge=0, le=1e7)] | None = None
    after: Annotated[float, Meta(ge=0, le=60)] | None = msgspec.field(default=None, name="in")
    duration: Annotated[float, Meta(ge=0.04, le=60)]
    stress: Annotated[float, Meta(ge=0, le=60)] | None = None


class Hear(_Own, frozen=True, tag="hear"):
    """What is heard from now on, for motion that is generated. audio: the next samples of a listener's
    partner, or of the speaker itself; other: those of the other one at the same time, silence without. 16-bit
    little-endian numbers, 16,000 a second, one channel, in base64. speaks: who speaks from now on, as the
    character sees it; "sound" decides by loudness, as at first; null changes nothing. comes: what is going to
    be said, for motion graphs; "partner" and "none" take it back.
    """

    audio: Sound = b""
    other: Sound = b""
    speaks: Literal["self", "partner", "both", "none", "sound"] | None = None
    comes: Annotated[tuple[Comes, ...], Meta(max_length=16)] = ()


class Partner(_Own, frozen=True, tag="partner"):
    """How the partner in the talk feels from now on: the character's face and posture take that up weakly and
    a moment later, until the next message; null, or a neutral mood, restores its own. laughs: the partner
    laughs now, for so many seconds, and the character may join in. share: how far, or how often; null for
    0.35 of a mood and 0.6 of the laughs.
    """

    mood: a.MoodPoint = None
    laughs: Annotated[float, Meta(ge=0, le=60, description="seconds")] | None = None
    share: Share | None = None


OwnMessage = Hello | Status | Describe | SetParameter | Keypoints | Generate | Hear | Partner
Message = Union[  # noqa: UP007 - msgspec reads it at run time
    a.AnyRequest, Hello, Status, Describe, SetParameter, Keypoints, Generate, Hear, Partner
]
WORDS: tuple[str, ...] = (*a.WORDS, *(str(kind.__struct_config__.tag) for kind in get_args(OwnMessage)))


class HeardMessage(Struct, frozen=True, array_like=True):
    """A request as it was understood. after: seconds from now at which it should begin, if it said `in`."""

    message: Message
    after: float | None = None


State = Literal["planned", "late", "refused", "done"]
Reason = Literal["finished", "withdrawn", "replaced", "interrupted", "dropped"]


class Part(Struct, frozen=True, kw_only=True, omit_defaults=True):
    """What became of one behaviour of a block of BML. do: the kind of request it became."""

    id: str
    do: str
    state: State
    at: float | None = None
    until: float | None = None
    actions: tuple[str, ...] = ()
    why: str = ""


class Reply(Struct, frozen=True, kw_only=True, omit_defaults=True):
    """What becomes of a request. at, until: seconds of the session at which it plays. since: when the line
    began that it adds to, where it does. actions: what plays. notes: what was left out of it. spoken,
    last_word: of something said that is withdrawn, interrupted or paused, what was spoken until then. skip:
    where in its line it is paused, or goes on, seconds. seen: for keypoints, layer ->
    the stance the person is in. error: what is wrong with it if it could not be understood; then there is
    nothing else.
    """

    id: str | None = None
    state: State | None = None
    layer: str | None = None
    at: float | None = None
    until: float | None = None
    since: float | None = None
    actions: tuple[str, ...] = ()
    why: str = ""
    notes: tuple[str, ...] = ()
    spoken: str | None = None
    last_word: str | None = None
    skip: float | None = None
    parts: tuple[Part, ...] = ()
    seen: dict[Layer, str] = {}
    error: str | None = None


class Event(Struct, frozen=True, kw_only=True, omit_defaults=True):
    """Something that happened. changed: the plan for a request changed; state and times are as in a reply.
    started, ended: an action, or speech, with its words. skip: of speech that goes on after a pause, where in
    its line, seconds. reason: why it ended; of speech that did not end by itself, spoken and last_word tell
    what was spoken.
    """

    event: Literal["changed", "started", "ended", "closed"]
    t: float
    id: str | None = None
    state: State | None = None
    layer: str | None = None
    at: float | None = None
    until: float | None = None
    actions: tuple[str, ...] = ()
    action: str | None = None
    line: str | None = None
    text: str | None = None
    skip: float | None = None
    reason: Reason | None = None
    spoken: str | None = None
    last_word: str | None = None
    why: str = ""


_message: msgspec.json.Decoder[Message] = msgspec.json.Decoder(Message)
_several: msgspec.json.Decoder[list[msgspec.Raw]] = msgspec.json.Decoder(list[msgspec.Raw])
_seconds: msgspec.json.Decoder[Any] = msgspec.json.Decoder()
encode = msgspec.json.Encoder().encode


@overload
def round_seconds(seconds: float) -> float: ...
@overload
def round_seconds(seconds: None) -> None: ...
def round_seconds(seconds: float | None) -> float | None:
    """Return seconds as they are sent, rounded to a tenth of a millisecond."""
    return None if seconds is None else round(seconds, 4)


def split_message(data: bytes | str) -> tuple[list[bytes | str | msgspec.Raw], bool]:
    """Return the requests in a message, and whether it was a list. Raises RequestError for one that is too
    long or not a list.
    """
    if len(data) > LONGEST_MESSAGE:
        raise a.RequestError(
            f"a message has at most {LONGEST_MESSAGE // 1024} KiB, not {len(data) // 1024}; send several"
        )
    if data.lstrip()[:1] not in ("[", b"["):
        return [data], False
    try:
        several = _several.decode(data)
    except (msgspec.DecodeError, UnicodeError, RecursionError) as error:
        raise a.RequestError(a.explain_invalid_ask(error)) from None
    if len(several) > MOST:
        raise a.RequestError(f"a list has at most {MOST} requests, not {len(several)}; send several lists")
    return list(several), True


def read_live_request(data: bytes | str | msgspec.Raw) -> HeardMessage | Reply:
    """Return one request, or the reply that says what is wrong with it."""
    size = len(memoryview(data)) if isinstance(data, msgspec.Raw) else len(data)
    if size > LONGEST and not (size <= LONGEST_BML and _holds_bml(data)):
        return Reply(
            error=f"a request has at most {LONGEST // 1024} KiB, a block of BML {LONGEST_BML // 1024}, not "
            f"{size // 1024}"
        )
    try:
        message = _message.decode(data)
    except msgspec.ValidationError as error:
        return _otherwise(data, error, None)
    except (msgspec.DecodeError, UnicodeError, RecursionError) as error:
        return Reply(error=a.explain_invalid_ask(error))
    if isinstance(message, a.Say) and (message.visemes or any(isinstance(x, dict) for x in message.words)):
        return _otherwise(data, msgspec.ValidationError(), message)
    return HeardMessage(message)


def _holds_bml(data: bytes | str | msgspec.Raw) -> bool:
    return '"bml"' in data if isinstance(data, str) else b'"bml"' in bytes(data)


def _otherwise(
    data: bytes | str | msgspec.Raw, error: msgspec.ValidationError, message: Message | None
) -> HeardMessage | Reply:
    """Read a request that is not valid as it is: one that says `in`, one with the times of a synthesiser's
    service, or one with an error. message: what it says if nothing has to be changed, None if it is not
    valid.
    """
    try:
        fields = _seconds.decode(data)
    except (msgspec.DecodeError, UnicodeError, RecursionError) as broken:
        return Reply(error=a.explain_invalid_ask(broken))
    if not isinstance(fields, dict):
        return Reply(error='a request is an object such as {"do": "nod"}')
    ident = fields["id"] if isinstance(fields.get("id"), str) and len(fields["id"]) <= 200 else None
    changed = False
    if fields.get("do") == "say":  # what knows phones and mouth shapes is loaded when somebody sends some
        from metagraph.live.engine_timings import adopt_engine_timing

        changed = adopt_engine_timing(fields)
    later = "in" in fields
    after = fields.pop("in", 0.0)
    if isinstance(after, bool) or not isinstance(after, int | float) or not 0 <= after <= 1e6:
        return Reply(id=ident, error="in: give seconds from now, 0 or more")
    if later and fields.get("at") is not None:
        return Reply(
            id=ident, error=("give `at` (seconds of the session) or `in` (seconds from now), not both")
        )
    if not (changed or later):
        return HeardMessage(message) if message is not None else Reply(id=ident, error=_words(error, fields))
    try:
        message = msgspec.convert(fields, Message)
    except (msgspec.ValidationError, RecursionError) as wrong:
        return Reply(id=ident, error=_words(wrong, fields))
    if later and isinstance(message, OwnMessage):
        return Reply(id=ident, error="in: only what the character does can be put off")
    return HeardMessage(message, float(after) if later else None)


def _words(error: Exception, fields: dict[str, Any]) -> str:
    """Return what is wrong with a request. fields: all that it says."""
    kind = next((one for one in get_args(Message) if one.__struct_config__.tag == fields.get("do")), None)
    if kind is not None and isinstance(error, msgspec.ValidationError):
        return explain_validation(error, kind)
    text = a.explain_invalid_ask(error).removeprefix("[...]: ")
    if text.startswith("do: Invalid value"):
        text = text.partition("; known are")[0] + f"; known are {', '.join(WORDS)}"
    elif text.endswith("required field `do`"):
        text += f"; it is one of {', '.join(WORDS)}"
    return text


def make_live_schema() -> dict[str, Any]:
    """Return the JSON Schema (draft 2020-12) of the live session: requests, lists of them, replies and
    events.
    """
    asks = msgspec.json.schema_components([Message, Reply, Event], ref_template="#/$defs/{name}")
    (requests, reply, event), parts = asks
    for name, part in parts.items():
        if name in {kind.__name__ for kind in get_args(a.AnyRequest)}:
            part["properties"]["in"] = {
                "type": "number",
                "minimum": 0,
                "maximum": 1e6,
                "description": "seconds from now, instead of `at`",
            }
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Metagraph live session",
        "description": "What a client sends: a request, or a list of requests. It receives what the "
        "definitions Reply and Event describe.",
        "anyOf": [
            {"$ref": "#/$defs/Request"},
            {"type": "array", "maxItems": MOST, "items": {"$ref": "#/$defs/Request"}},
        ],
        "$defs": {
            "Request": requests,
            **parts,
            "Reply": parts.get("Reply", reply),
            "Event": parts.get("Event", event),
        },
    }
