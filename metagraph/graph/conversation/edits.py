"""Edits of conversations: kept ones, their sides, and the segments of what is said. Pure functions Project ->
Project.

A segment is meant by its place among its side's segments, from 0. Times are seconds; what would reach over a
neighbour, or out of the conversation, is held there. A segment's peak goes with it and stays inside, whatever
it is labelled: labelled back, nothing is lost.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace
from typing import Any

import msgspec

from metagraph.common.wording import phrase
from metagraph.graph import ids
from metagraph.graph.conversation.model import (
    AUTO,
    EVERYBODY,
    SHORTEST,
    SPOKEN,
    Conversation,
    Rates,
    Segment,
    Side,
    Sound,
    Word,
    get_word_lists,
)
from metagraph.graph.edit_error import EditError
from metagraph.graph.edits import find_free_name
from metagraph.graph.model import Project
from metagraph.graph.timeline_edits import remove_timeline
from metagraph.graph.vocabulary import join_tokens, make_word_vocabularies, split_tokens

_DIGITS = 3  # of seconds: what is dragged lands on milliseconds
Lists = tuple[tuple[str, ...], tuple[str, ...]]  # responses and hesitations
Place = tuple[int, int]  # side, and the place among its segments


# --- conversations


def add_conversation(project: Project, conversation: Conversation) -> tuple[Project, str]:
    """Keep a conversation under a name of its own; return the project and the conversation's id."""
    taken = {c.name for c in project.conversations.values()}
    named = msgspec.structs.replace(
        conversation, name=find_free_name(_clean(conversation.name) or "Conversation", taken)
    )
    ident = ids.make_id(project, "v", msgspec.json.encode(named))
    return replace(project, conversations={**project.conversations, ident: named}), ident


def remove_conversation(project: Project, ident: str) -> Project:
    _conversation(project, ident)
    project = remove_timeline(project, ident)
    return replace(project, conversations={i: c for i, c in project.conversations.items() if i != ident})


def change_conversation(project: Project, ident: str, **changes: Any) -> Project:
    """Set fields of a conversation: name, distance, seed, blinks. Raises EditError, also for values out of
    range.
    """
    if "name" in changes:
        changes["name"] = _clean(str(changes["name"]))
        if not changes["name"]:
            raise EditError(phrase("a conversation needs a name"))
    return _with(project, ident, _valid(_conversation(project, ident), changes))


def change_side(project: Project, ident: str, side: int, /, **changes: Any) -> Project:
    """Set fields of one who talks: name, audio, channel, project, character, take, motion, place, rates.
    Raises EditError, also for values out of range.
    """
    of = _conversation(project, ident)
    if "name" in changes:
        changes["name"] = _clean(str(changes["name"]))
    return _with_side(project, ident, side, _valid(of.sides[side], changes))


def set_rates(project: Project, ident: str, side: int, **rates: float) -> Project:
    """Set how often one who talks moves with what is said: clause, response, hesitation, mirror, 0..1.
    Raises EditError out of that range.
    """
    of = _conversation(project, ident).sides[side]
    return _with_side(project, ident, side, msgspec.structs.replace(of, rates=_valid(of.rates, rates)))


def set_word_lists(
    project: Project,
    ident: str,
    responses: Iterable[str],
    hesitations: Iterable[str],
    side: int | None = None,
    language: str | None = None,
) -> Project:
    """Set which words make a segment a response or a hesitation, and label the segments again by them.

    side: the one whose own lists they are; None: the lists of all, which have none of their own then.
    language: the code of what they are of, None to leave it. What was labelled otherwise than the lists
    before would, was labelled by hand, and stays as it is; so does what has no words. Only whole segments are
    labelled: none is parted or joined. Raises EditError.
    """
    of = _conversation(project, ident)
    lists = _listed(responses), _listed(hesitations)
    changes: dict[str, Any] = {} if language is None else {"language": language}
    sides = list(of.sides)
    for n, one in enumerate(of.sides):
        if side not in (None, n):
            continue
        before = get_word_lists(of, n)
        own = dict(zip(("responses", "hesitations"), (None, None) if side is None else lists, strict=True))
        segments = tuple(_labelled(s, before, lists) for s in one.segments)
        sides[n] = _valid(one, {**own, **changes}, segments=segments)
    both = {"responses": lists[0], "hesitations": lists[1]} if side is None else {}
    return _with(project, ident, _valid(of, both, sides=tuple(sides)))


def _labelled(segment: Segment, before: Lists, after: Lists) -> Segment:
    """Return a segment as other lists label it, if it is what the lists before said."""
    if not split_tokens(segment.text):
        return segment
    was, now = classify_words(segment.text, *before), classify_words(segment.text, *after)
    return msgspec.structs.replace(segment, kind=now) if segment.kind == was != now else segment


def set_language(project: Project, language: str) -> Project:
    """Set what conversations are read in: a code, or `AUTO`."""
    return replace(project, language=_clean(language) or AUTO)


def classify_words(text: str, responses: Collection[str], hesitations: Collection[str]) -> Sound:
    """Return what words are by two lists: a hesitation or a response if nothing else is said, else a clause.
    Said of both, it is a response: the partner is answered.
    """
    words = [split_tokens(text)]
    answers, pauses, either, _ = make_word_vocabularies(tuple(responses), tuple(hesitations))
    if not either.made_of(words):
        return "clause"
    return "hesitation" if pauses.made_of(words) and not answers.made_of(words) else "response"


def _listed(words: Iterable[str]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(x for x in map(_clean, words) if x))


# --- segments


def move_segment(project: Project, ident: str, side: int, at: int, by: float) -> Project:
    """Move a segment in time, as far as its neighbours leave room; its peak goes along."""
    of, low, high = _room(project, ident, side, at)
    by = round(min(max(by, low - of.start), high - of.end), _DIGITS)
    start = min(max(low, round(of.start + by, _DIGITS)), high)
    end = min(max(start, of.end + (start - of.start)), high)
    peak = None if of.peak is None else min(max(start, of.peak + (start - of.start)), end)
    return _set(project, ident, side, at, msgspec.structs.replace(of, start=start, end=end, peak=peak))


def resize_segment(
    project: Project, ident: str, side: int, at: int, start: float | None = None, end: float | None = None
) -> Project:
    """Move an end of a segment, or both: to its neighbours at most, and never nearer to the other end than a
    segment lasts at least.
    """
    of, low, high = _room(project, ident, side, at)
    least = min(SHORTEST, of.end - of.start)  # one that was read may be shorter
    first = (
        of.start
        if start is None
        else min(max(low, round(start, _DIGITS)), (of.end if end is None else high) - least)
    )
    last = of.end if end is None else max(min(high, round(end, _DIGITS)), first + least)
    peak = None if of.peak is None else min(max(first, of.peak), last)
    return _set(project, ident, side, at, msgspec.structs.replace(of, start=first, end=last, peak=peak))


def set_peak(project: Project, ident: str, side: int, at: int, peak: float | None) -> Project:
    """Say where a segment's stress is, inside it; None: nowhere."""
    of = _segment(project, ident, side, at)
    held = None if peak is None else min(max(of.start, round(peak, _DIGITS)), of.end)
    return _set(project, ident, side, at, msgspec.structs.replace(of, peak=held))


def relabel_segments(project: Project, ident: str, places: Collection[Place], kind: Sound) -> Project:
    """Say what segments are. Raises EditError for idle: what lies between segments is."""
    _spoken(kind)
    for side, at in places:
        project = _set(
            project, ident, side, at, msgspec.structs.replace(_segment(project, ident, side, at), kind=kind)
        )
    return project


def address_segments(project: Project, ident: str, places: Collection[Place], to: int | None) -> Project:
    """Say whom segments are said to: a side, `EVERYBODY`, or, for None, that it be inferred. Raises EditError
    for a side that is not there, or the speaker's own.
    """
    of = _conversation(project, ident)
    for side, at in places:
        if to is not None and to != EVERYBODY and (to == side or not 0 <= to < len(of.sides)):
            raise EditError(phrase("a segment can only be addressed to another speaker of this conversation"))
        segment = msgspec.structs.replace(_segment(project, ident, side, at), to=to)
        project = _set(project, ident, side, at, segment)
    return project


def split_segment(
    project: Project, ident: str, side: int, at: int, seconds: float, peak: float | None = None
) -> Project:
    """Part a segment in two, its words by their middles. peak: of the part the segment's own peak is not in.
    Raises EditError if a part would be too short.
    """
    of, seconds = _segment(project, ident, side, at), round(seconds, _DIGITS)
    if not of.start + SHORTEST <= seconds <= of.end - SHORTEST:
        raise EditError(
            phrase(
                "a segment can only be split inside it, between {first:.2f} and {last:.2f} s",
                first=of.start + SHORTEST,
                last=of.end - SHORTEST,
            )
        )
    words = _conversation(project, ident).sides[side].words
    parts = []
    for start, end, first in ((of.start, seconds, True), (seconds, of.end, False)):
        own = of.peak is not None and (of.peak < seconds) == first
        there = of.peak if own else peak if peak is not None and start <= peak <= end else None
        text = _text(words, start, end) if _text(words, of.start, of.end) else of.text if first else ""
        parts.append(msgspec.structs.replace(of, start=start, end=end, peak=there, text=text))
    return _replaced(project, ident, side, at, at + 1, parts)


def merge_segments(project: Project, ident: str, side: int, first: int, last: int) -> Project:
    """Make one of the segments from the first to the last, of what is between them, too. It is a clause if
    one of them was, else what the first was; its peak is the first clause's, else the first there is. Raises
    EditError for fewer than two.
    """
    some = _conversation(project, ident).sides[side].segments[max(0, first) : last + 1]
    if first < 0 or len(some) < 2 or len(some) != last - first + 1:
        raise EditError(phrase("there is no segment after this one to merge it with"))
    kind: Sound = "clause" if any(s.kind == "clause" for s in some) else some[0].kind
    peaks = [s.peak for s in sorted(some, key=lambda s: s.kind != "clause") if s.peak is not None]
    text = join_tokens(s.text for s in some if s.text)
    made = Segment(kind, some[0].start, some[-1].end, peaks[0] if peaks else None, text)
    return _replaced(project, ident, side, first, last + 1, (made,))


def add_segment(
    project: Project, ident: str, side: int, kind: Sound, start: float, end: float, peak: float | None = None
) -> tuple[Project, int]:
    """Add a segment if there is none, as far as the gap round its start reaches; its words are those that lie
    in it. Return the project and its place. Raises EditError if there is no room.
    """
    _spoken(kind)
    of = _conversation(project, ident)
    segments, start, end = of.sides[side].segments, *sorted((round(start, _DIGITS), round(end, _DIGITS)))
    low, high = find_gap_at(of, side, (start + end) / 2) or (0.0, -1.0)
    start, end = max(low, start), min(high, end)
    if end - start < SHORTEST:
        raise EditError(
            phrase(
                "there is no room for a segment here; a segment is at least {shortest:g} s long",
                shortest=SHORTEST,
            )
        )
    at = sum(1 for s in segments if s.end <= start)
    held = None if peak is None else min(max(start, peak), end)
    made = Segment(kind, start, end, held, _text(of.sides[side].words, start, end))
    return _replaced(project, ident, side, at, at, (made,)), at


def remove_segments(project: Project, ident: str, places: Collection[Place]) -> Project:
    for side, at in places:
        _segment(project, ident, side, at)
    for side in {side for side, _ in places}:
        segments = _conversation(project, ident).sides[side].segments
        left = tuple(s for n, s in enumerate(segments) if (side, n) not in places)
        project = _replaced(project, ident, side, 0, len(segments), left)
    return project


def find_gap_at(conversation: Conversation, side: int, seconds: float) -> tuple[float, float] | None:
    """Return from when to when nothing is segmented round a time; None if a segment is, and out of the
    conversation.
    """
    low, high = 0.0, conversation.length
    for s in conversation.sides[side].segments:
        if s.start < seconds < s.end:
            return None
        if s.end <= seconds:
            low = max(low, s.end)
        elif s.start >= seconds:
            high = min(high, s.start)
            break
    return (low, high) if low <= seconds <= high else None


# --- what they share


def _conversation(project: Project, ident: str) -> Conversation:
    found = project.conversations.get(ident)
    if found is None:
        raise EditError(phrase("that conversation is not in this project"))
    return found


def _segment(project: Project, ident: str, side: int, at: int) -> Segment:
    segments = _conversation(project, ident).sides[side].segments
    if not 0 <= at < len(segments):
        raise EditError(phrase("that segment is no longer there"))
    return segments[at]


def _room(project: Project, ident: str, side: int, at: int) -> tuple[Segment, float, float]:
    """Return a segment, and from when to when it can lie: between its neighbours, inside the conversation."""
    found, of = _segment(project, ident, side, at), _conversation(project, ident)
    segments = of.sides[side].segments
    low = segments[at - 1].end if at else 0.0
    high = segments[at + 1].start if at + 1 < len(segments) else max(of.length, found.end)
    return found, low, high


def _spoken(kind: Sound) -> None:
    if kind not in SPOKEN:
        raise EditError(phrase("a segment cannot be idle: remove the segment instead"))


def _text(words: Sequence[Word], start: float, end: float) -> str:
    """Return the words whose middles lie in a stretch."""
    return join_tokens(w.text for w in words if start <= (w.start + w.end) / 2 < end)


def _clean(words: str) -> str:
    return " ".join(words.split())


def _valid(before: Any, changes: dict[str, Any], **unchecked: Any) -> Any:
    """Return a value with fields set, each as its type allows. Raises EditError. unchecked: fields that are
    known to be right.
    """
    types = {f.name: f.type for f in msgspec.structs.fields(type(before))}
    try:
        made = {
            name: msgspec.convert(value, types[name], from_attributes=False)
            for name, value in changes.items()
        }
        return msgspec.structs.replace(before, **made, **unchecked)
    except KeyError as error:
        raise EditError(phrase("there is no setting named {error}", error=error)) from None
    except (msgspec.ValidationError, ValueError, TypeError) as error:
        raise EditError(str(error)) from None


def _with(project: Project, ident: str, after: Conversation) -> Project:
    if after == project.conversations[ident]:
        return project
    return replace(project, conversations={**project.conversations, ident: after})


def _with_side(project: Project, ident: str, side: int, after: Side) -> Project:
    of = _conversation(project, ident)
    sides = tuple(after if n == side else s for n, s in enumerate(of.sides))
    return _with(project, ident, msgspec.structs.replace(of, sides=sides))


def _set(project: Project, ident: str, side: int, at: int, segment: Segment) -> Project:
    return _replaced(project, ident, side, at, at + 1, (segment,))


def _replaced(
    project: Project, ident: str, side: int, first: int, end: int, segments: Sequence[Segment]
) -> Project:
    """Put segments in the place of those from the first to before the end."""
    of = _conversation(project, ident).sides[side]
    try:
        after = msgspec.structs.replace(of, segments=(*of.segments[:first], *segments, *of.segments[end:]))
    except ValueError as error:
        raise EditError(str(error)) from None
    return _with_side(project, ident, side, after)


PAPER = {
    "female": Rates(),
    "male": Rates(clause=0.62, response=0.53, hesitation=0.35),
}  # the two actors of Yang et al., table 1
