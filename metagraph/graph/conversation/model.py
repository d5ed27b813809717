"""A conversation of two or more: what each says and when, in segments that the body answers to (Yang et al.
2020, section 4.2).

A side keeps what its own speech is made of: phonemic clauses, listener responses and its own hesitation
pauses, one after another. What a character moves with is another thing, `list_segments_heard_by`: its own
clauses and responses, and the hesitations of those it talks with.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Annotated, Literal, get_args

import msgspec
from msgspec import Meta, Struct

from metagraph.graph.requests import Seconds

Sound = Literal["idle", "clause", "response", "hesitation"]
SOUNDS: tuple[Sound, ...] = get_args(Sound)
Spoken = Literal["clause", "response", "hesitation"]
SPOKEN: tuple[Spoken, ...] = get_args(Spoken)
SHORTEST = 0.04  # seconds a segment lasts at least
MOST_SPEAKERS = 8  # of a conversation; more than four or five part into several (Dunbar et al. 1995)
EVERYBODY = -1  # who is addressed by what is said to all
_Name = Annotated[str, Meta(max_length=200)]
_Share = Annotated[float, Meta(ge=0, le=1)]
_Metres = Annotated[float, Meta(ge=-50, le=50)]


class Word(Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True):
    """A word as it was transcribed. start, end: seconds."""

    text: Annotated[str, Meta(max_length=1000)]
    start: Seconds
    end: Seconds


class Segment(Struct, frozen=True, omit_defaults=True, forbid_unknown_fields=True):
    """A stretch of a conversation. kind: a phonemic clause, a listener response, a hesitation pause, or idle,
    which is never kept: it is what lies between. start, end: seconds. peak: of a clause, where its stress is,
    seconds; None if there is none. text: its words. to: the side it is said to, `EVERYBODY` to all; None if
    nobody said so, and it is inferred (`metagraph.speech.addressing`).
    """

    kind: Sound
    start: float
    end: float
    peak: float | None = None
    text: str = ""
    to: Annotated[int, Meta(ge=EVERYBODY, lt=MOST_SPEAKERS)] | None = None


class Rates(Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True):
    """How often a movement goes with what is said, 0..1: a gesture of the hands with a clause, a nod with a
    response, a nod with the partner's hesitation. The defaults are what the female actor of Yang et al. did
    (table 1). mirror: the partner's changes of stance that are taken up while listening. mood: how far the
    partner's mood is. laugh: how many of the others' laughs are joined. These three are ours.
    """

    clause: _Share = 0.75
    response: _Share = 0.58
    hesitation: _Share = 0.30
    mirror: _Share = 0.4
    mood: _Share = 0.35
    laugh: _Share = 0.6


class Side(Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True):
    """One who talks. audio: path of its sound, relative to the project file; channel: which of that file's
    channels is its own, from 0; None for all of them mixed. project: path of another project whose graph
    moves this side, None for this one. character: path of the GLB it is drawn with, None for the character of
    the project that moves it. take: id of the clip that was recorded along with it, from the same moment.
    motion: id of the clip it moves with from the beginning on, instead of a graph: new motion of a motion
    graph. language: the code of what it was read in ("de"); "und" if nobody knows, "" if it was never said.
    responses, hesitations: its own lists, where the two speak different languages; None for the
    conversation's. place: where it stands, metres to the right and towards the viewer; None for its place in
    the circle. words: as transcribed, by start. segments: of its own speech, by start, never overlapping,
    none idle.
    """

    name: _Name = ""
    audio: str | None = None
    channel: Annotated[int, Meta(ge=0, le=63)] | None = None
    project: str | None = None
    character: str | None = None
    take: str | None = None
    motion: str | None = None
    language: Annotated[str, Meta(max_length=40)] = ""
    responses: tuple[_Name, ...] | None = None
    hesitations: tuple[_Name, ...] | None = None
    place: tuple[_Metres, _Metres] | None = None
    words: tuple[Word, ...] = ()
    segments: tuple[Segment, ...] = ()
    rates: Rates = Rates()

    def __post_init__(self) -> None:
        end = 0.0
        for s in self.segments:
            if (
                s.kind == "idle"
                or not end <= s.start < s.end <= 1e6
                or not s.start <= (s.start if s.peak is None else s.peak) <= s.end
            ):
                raise ValueError(
                    f"segment '{s.kind}' at {s.start:g} s: segments follow each other, end after they start, "
                    "and have their peak inside"
                )
            end = s.end


AUTO = "auto"  # what the words tell
UNKNOWN = "und"  # the code of a language that nobody knows
# What short sounds mean where a project says nothing else: the English lists; compared without case and
# punctuation. "%hesitation" is what IBM's transcripts write.
RESPONSES = (
    "yes",
    "yeah",
    "yep",
    "yup",
    "mhm",
    "mm-hmm",
    "mm",
    "uh-huh",
    "um-hmm",
    "um hum",
    "ah",
    "ah ha",
    "aha",
    "oh",
    "okay",
    "ok",
    "right",
    "sure",
    "wow",
    "really",
    "exactly",
    "absolutely",
    "totally",
    "i see",
    "i know",
    "of course",
    "got it",
    "cool",
    "great",
    "nice",
    "true",
)
HESITATIONS = (
    "%hesitation",
    "uh",
    "uhh",
    "um",
    "umm",
    "er",
    "erm",
    "ehm",
    "eh",
    "hm",
    "hmm",
    "huh",
    "well",
    "you know",
    "i mean",
    "like",
    "let me see",
)


class Conversation(Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True):
    """Those who talk with each other. length: seconds. responses, hesitations: words and short phrases that
    make a segment one. distance: metres between neighbours in the circle they stand in, facing its middle;
    two face each other. seed: of which clauses get a gesture, and who looks at whom. blinks: by the
    project's life layer, or, "peaks", on clauses' peaks and where five seconds pass without (Yang et al.,
    section 7.3).
    """

    name: _Name
    length: Annotated[float, Meta(gt=0, le=36000)]
    sides: Annotated[tuple[Side, ...], Meta(min_length=2, max_length=MOST_SPEAKERS)]
    responses: tuple[_Name, ...] = RESPONSES
    hesitations: tuple[_Name, ...] = HESITATIONS
    distance: Annotated[float, Meta(ge=0.2, le=20)] = 1.3
    seed: Annotated[int, Meta(ge=0, le=0xFFFFFFFF)] = 1
    blinks: Literal["life", "peaks"] = "life"

    def __post_init__(self) -> None:
        for n, side in enumerate(self.sides):
            odd = next((s for s in side.segments if s.to is not None and s.to in (n, *self._beyond)), None)
            if odd is not None:
                whom = "its own speaker" if odd.to == n else f"side {odd.to}, which is not there"
                raise ValueError(
                    f"segment '{odd.kind}' of side {n} at {odd.start:g} s is said to {whom}; to is "
                    f"another side, from 0, or {EVERYBODY} for everybody"
                )

    @property
    def _beyond(self) -> range:
        """Numbers of sides that there are not."""
        return range(len(self.sides), MOST_SPEAKERS)


def list_other_sides(conversation: Conversation, side: int) -> tuple[int, ...]:
    """Return the numbers of those a side talks with."""
    return tuple(n for n in range(len(conversation.sides)) if n != side)


def with_sides(conversation: Conversation, order: Sequence[int]) -> Conversation:
    """Return a conversation of some of its sides, in an order; what was said to others is said to nobody
    named. Raises ValueError for fewer than two, or the same twice.
    """
    if len(set(order)) < max(2, len(order)):
        raise ValueError("a conversation needs two or more who talk, each once")
    if tuple(order) == tuple(range(len(conversation.sides))):
        return conversation
    now = {EVERYBODY: EVERYBODY, **{was: n for n, was in enumerate(order)}}
    sides = []
    for n in order:
        side = conversation.sides[n]
        segments = tuple(
            s if s.to is None else msgspec.structs.replace(s, to=now.get(s.to)) for s in side.segments
        )
        sides.append(msgspec.structs.replace(side, segments=segments))
    return msgspec.structs.replace(conversation, sides=tuple(sides))


def get_word_lists(conversation: Conversation, side: int) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return a side's responses and hesitations: its own, else the conversation's."""
    of = conversation.sides[side]
    return (
        conversation.responses if of.responses is None else of.responses,
        conversation.hesitations if of.hesitations is None else of.hesitations,
    )


def get_side_name(conversation: Conversation, side: int) -> str:
    """Return what a side is called: its own name, else its number."""
    return conversation.sides[side].name or f"Speaker {side + 1}"


def list_segments_heard_by(conversation: Conversation, side: int) -> tuple[Segment, ...]:
    """Return what a side moves with, by start and never overlapping: its own clauses and responses, and what
    is left of the others' hesitations where it does not speak itself. Its own hesitations are idle. kind
    "hesitation" here is another's.
    """
    own = [s for s in conversation.sides[side].segments if s.kind != "hesitation"]
    theirs = [s for n in list_other_sides(conversation, side) for s in conversation.sides[n].segments]
    out, until = list(own), 0.0
    for s in sorted((s for s in theirs if s.kind == "hesitation"), key=lambda s: s.start):
        free = _free(max(s.start, until), s.end, own)
        out += [msgspec.structs.replace(s, start=a, end=b) for a, b in free]
        until = max(until, s.end)
    return tuple(sorted(out, key=lambda s: s.start))


def _free(start: float, end: float, taken: list[Segment]) -> Iterator[tuple[float, float]]:
    """Yield what of a stretch is in none of the segments, by start, as far as it is long enough."""
    for s in taken:
        if s.end > start and s.start < end:
            if s.start - start >= SHORTEST:
                yield start, s.start
            start = max(start, s.end)
    if end - start >= SHORTEST:
        yield start, end
