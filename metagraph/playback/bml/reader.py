"""Behaviour Markup Language in: a block of BML 1.0, or of a dialect near it, becomes asks.

Read are gesture, pointing, head, posture, gaze, speech, face (blinks), wait, animation; constraints between
their sync points; `composition`. What is not understood is left out with a note, never with an error: a block
made for more than we can do still does what it can. Times BML leaves to the realiser (how long a gesture
prepares) come from the project's clips where there is a project, and are guessed if there is none.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Literal

import msgspec

from metagraph.graph import requests as a
from metagraph.graph.model import Project
from metagraph.playback.bml.times import Behaviour, BlockTiming, parse_seconds
from metagraph.playback.bml.words import SYNCS, BmlWords, spell_word
from metagraph.playback.bml.writer import write_bml
from metagraph.playback.bml.xml import Element, parse_bml

__all__ = ["BmlBlock", "read_block", "read_bml", "write_bml"]

MOST = 500  # behaviours of one block
Composition = Literal["merge", "append", "replace"]
BLINKS = ("blink", "blinkboth", "eyesclosed")
INFLUENCE = {
    "eyes": 0.25,
    "head": 0.75,
}  # how far a gaze turns the head with the eyes; all else goes all the way
SAID = ("description", "lang", "voice")  # within a speech, but not spoken
NOT_READ = {
    "event": "events are sent by 'metagraph live' itself, see its events",
    "locomotion": "the character stays where it is",
    "reach": "the character's hands follow its clips",
}


@dataclass(frozen=True)
class BmlBlock:
    """What a block says. asks: `at` None for the block's beginning; ids are the behaviours' own, "" without.
    notes: what was left out or guessed, with its line. composition: "replace" has withdrawn all else with its
    first ask.
    """

    asks: tuple[a.AnyRequest, ...]
    notes: tuple[str, ...] = ()
    ident: str = ""
    composition: Composition = "merge"


def read_bml(
    text: str, at: float = 0.0, priority: int = 1, project: Project | None = None
) -> tuple[a.AnyRequest, ...]:
    """Return the asks of a block that begins at `at` seconds. Raises RequestError with line, element and
    remedy.
    """
    return read_block(text, at, priority, project).asks


def read_block(text: str, at: float = 0.0, priority: int = 1, project: Project | None = None) -> BmlBlock:
    """Return a block with what there is to say about it. project: whose tags, names and clips lexemes and
    lengths are taken from.
    """
    root = parse_bml(text)
    if root.name.lower() == "act":
        root = next((e for e in root if e.name.lower() == "bml"), root)
    if root.name.lower() != "bml":
        raise a.RequestError(f"{root.place}: the first element must be <bml>")
    word = spell_word(root.get("composition") or "merge").replace("appendafter", "append")
    if word not in ("merge", "append", "replace"):
        raise a.RequestError(
            f"{root.place}: composition is MERGE, APPEND or REPLACE, not '{root.get('composition')}'"
        )
    reader = _Reader(BmlWords(project), at, priority)
    reader.collect(root)
    try:
        asks = reader.timing.asks()
    except RecursionError:
        raise a.RequestError(
            f"{root.place}: too many behaviours wait for one another; give some of them times in seconds"
        ) from None
    first: tuple[a.AnyRequest, ...] = (a.Withdraw(),) if word == "replace" else ()
    return BmlBlock(first + asks, tuple(reader.notes), root.get("id"), word)  # type: ignore[arg-type]


# An element's asks, and its sync points' seconds after its start; None for as its clip has.
_Read = tuple[list[Any], dict[str, float] | None]


class _Reader:
    def __init__(self, words: BmlWords, at: float, priority: int) -> None:
        self.words, self.priority = words, priority
        self.timing = BlockTiming(at, self._note, words.offsets)
        self.notes: list[str] = []

    # --- elements

    def collect(self, parent: Element) -> None:
        """Read the behaviours of a block, and of the parts of it that are required."""
        for element in parent:
            kind = element.name.lower()
            if kind == "required":
                self.collect(element)
            elif kind == "constraint":
                self.timing.constraints += list(element)
            elif kind in ("synchronize", "before", "after"):
                self.timing.constraints.append(element)
            else:
                self._behaviour(kind, element)

    def _behaviour(self, kind: str, element: Element) -> None:
        asks, offsets = self._read(kind, element)
        asks = self._no_later(element, asks)
        felt = self._felt(element)
        if felt:
            asks = [msgspec.structs.replace(x, **felt) if hasattr(x, "mood") else x for x in asks]
        times = {
            sync: value
            for name, value in element.attributes.items()
            if (sync := spell_word(name)) in SYNCS and value.strip()
        }
        if len(self.timing.behaviours) >= MOST:
            raise a.RequestError(f"{element.place}: a block has at most {MOST} behaviours; send several")
        self.timing.add(Behaviour(element, element.get("id"), asks, offsets, times))

    def _read(self, kind: str, e: Element) -> _Read:
        """Return an element's asks, still without times, and its sync points' seconds after its start; None
        for as its clip has.
        """
        common: dict[str, Any] = {
            "id": e.get("id"),
            "priority": self._integer(e, "metagraph:priority", self.priority),
        }
        tags = self._tags(e)
        layer: Any = e.get("metagraph:layer")  # no word for a layer is refused when the asks are timed
        match kind:
            case "gesture" | "pointing":
                return [self._hands(kind, e, tags, common)], None
            case "animation":
                ask = a.Play(action=self.words.action(e.get("name"), layer), layer=layer or None, **common)
                return [ask], None
            case "head":
                return self._head(e, tags, common)
            case "posture" | "postureshift" | "body":
                return self._posture(kind, e, common), {"ready": 0.5, "relax": 1.0, "end": 1.0}
            case "gaze" | "gazeshift" | "headdirectionshift":
                return [self._gaze(e, common)], {"ready": 0.3, "relax": 1.0, "end": 1.3}
            case "speech":
                return self._speech(e, common)
            case "face" | "facelexeme" | "faceshift":
                if spell_word(e.get("lexeme", "type")) in BLINKS or spell_word(e.get("lexeme")) in BLINKS:
                    return [a.Blink(**common)], {"attackpeak": 0.07, "end": 0.17}
                self._note(e, "is left out; of the face only BLINK is asked for this way")
                return [], {}
            case "wait" | "pause":
                length = self._number(e, "duration", 0.0) or self._number(e, "max-wait", 0.0)
                return [], {"end": length}
        return self._own(kind, e, tags, common)

    def _own(self, kind: str, e: Element, tags: tuple[str, ...] | None, common: dict[str, Any]) -> _Read:
        """Return what `_read` does of our own elements; the others are left out with a note."""
        layer: Any = e.get("metagraph:layer")
        limb: Any = e.get("mode").lower() or None
        match kind:
            case "metagraph:fidget":
                resume = e.get("metagraph:resume") == "true"
                tags = tags or _listed(e.get("lexeme"))
                return [a.Fidget(tags=tags, layer=layer or "arms", limb=limb, resume=resume, **common)], None
            case "metagraph:change":
                return [a.Change(layer=layer or "arms", limb=limb, **common)], {"end": 1.0}
            case "metagraph:mode":
                return [a.Behave(mode=e.get("mode") or None, **common)], {"end": 0.0}  # type: ignore[arg-type]
            case "metagraph:mood":
                length = self._number(e, "duration", -1.0)
                return [a.Feel(duration=None if length < 0 else length, **common)], {"end": max(0.0, length)}
            case "metagraph:place":
                place = a.Place(name=e.get("name"), point=self._point(e, e.get("point")), **common)
                return [place], {"end": 0.0}
            case "metagraph:withdraw":
                return [a.Withdraw(what=e.get("what"), **common)], {"end": 0.0}
        why = NOT_READ.get(kind, "it is none of the behaviours that are understood")
        self._note(e, f"is left out; {why}")
        return [], {}

    def _hands(
        self, kind: str, e: Element, tags: tuple[str, ...] | None, common: dict[str, Any]
    ) -> a.Gesture | a.Play:
        layer: Any = e.get("metagraph:layer")
        lexeme = e.get("lexeme") or ("" if spell_word(e.get("type")) == "lexeme" else e.get("type"))
        if kind == "pointing":
            lexeme = lexeme or "point"
            self._note(e, "is a pointing gesture as it was made; it does not aim at its target")
        hand = spell_word(e.get("mode", "hand")).removesuffix("s").removesuffix("hand")
        if e.get("name") and not lexeme:
            return a.Play(action=self.words.action(e.get("name"), layer), layer=layer or None, **common)
        limb = hand if hand in ("left", "right", "both") else None
        more = {"limb": limb, "resume": e.get("metagraph:resume") == "true"}
        return self._gesture(tags, lexeme, layer, common | more)

    def _gaze(self, e: Element, common: dict[str, Any]) -> a.Look:
        amount = INFLUENCE.get(spell_word(e.get("influence")), 1.0)
        if e.get("offsetangle") not in ("", "0", "0.0"):
            self._note(e, "looks straight at its target, without the offset")
        strict = e.get("metagraph:strict") == "true"
        to, amount = self._target(e), self._number(e, "metagraph:amount", amount)
        return a.Look(to=to, amount=amount, strict=strict, **common)

    def _no_later(self, e: Element, asks: list[Any]) -> list[Any]:
        """Return asks with how late they may come."""
        late = self._number(e, "metagraph:late", -1.0)
        if not e.get("metagraph:late"):
            return asks
        if not all("late" in ask.__struct_fields__ for ask in asks):
            self._note(e, "comes when it comes; metagraph:late means something for actions and stances")
            return asks
        return [msgspec.structs.replace(ask, late=late) for ask in asks]

    def _head(self, e: Element, tags: tuple[str, ...] | None, common: dict[str, Any]) -> _Read:
        lexeme = e.get("lexeme", "type")
        if e.get("repetition", "repeats") not in ("", "1", "1.0"):
            self._note(e, "nods and shakes as often as its clip; the repetition is left out")
        match spell_word(lexeme):
            case "nod":
                return [a.Nod(tags=tags or (), **common)], None
            case "shake":
                return [a.Shake(tags=tags or (), **common)], None
            case "" if e.get("target"):
                return [a.Look(to=self._target(e), **common)], {"ready": 0.3, "relax": 1.0, "end": 1.3}
        ask = self._gesture(tags, lexeme, e.get("metagraph:layer") or "head", common)
        return [ask], None

    def _gesture(
        self, tags: tuple[str, ...] | None, lexeme: str, layer: str, fields: dict[str, Any]
    ) -> a.Gesture | a.Play:
        if tags is not None:  # said in our own words
            return a.Gesture(layer=layer or "arms", tags=tags, **fields)  # type: ignore[arg-type]
        return self.words.gesture(_listed(lexeme), layer, fields)

    def _posture(self, kind: str, e: Element, common: dict[str, Any]) -> list[Any]:
        found = [(x.get("part"), x.get("type", "lexeme")) for x in e if x.name.lower() in ("stance", "pose")]
        word = e.get("stance", "lexeme", "type") if kind != "body" else e.get("posture")
        if word:
            found.insert(0, (e.get("part"), word))
        if not found:
            self._note(e, 'names no stance; say <stance type="..."/>')
        if kind == "posture" and e.get("end"):
            self._note(e, "lasts until another posture is asked for, not only until its end")
        layer, stay = e.get("metagraph:layer"), e.get("metagraph:stay") == "true"
        asks = [
            a.Go(stance=s, layer=x or None, stay=stay, **common)  # type: ignore[arg-type]
            for part, w in found
            for x, s in [self.words.stance(part, w, layer)]
        ]
        return [msgspec.structs.replace(x, id=f"{x.id}{n or ''}") if x.id else x for n, x in enumerate(asks)]

    def _speech(self, e: Element, common: dict[str, Any]) -> _Read:
        pieces, marks = [], {}
        spoken = next((x for x in e if x.name.lower() == "text"), e)
        length = 0
        keep = spoken.get("space") == "preserve"
        for piece in _spoken(spoken):
            if isinstance(piece, str):
                pieces.append(piece)
                length += len(" ".join(piece.split())) + 1
            elif piece.get("id", "name"):
                marks[spell_word(piece.get("id", "name"))] = float(length)
        text = "".join(pieces) if keep else " ".join("".join(pieces).split())
        line = e.get("metagraph:line", "ref") or self.words.line(e.get("id"))
        if not line and not text:
            self._note(e, "is left out; it says neither words in <text> nor a line's id in ref")
            return [], {"end": 0.0, **marks}
        seconds = self.words.spoken(line, text)
        share = seconds / max(1, length)
        ask = a.Say(line=line or None, text=text, gestures=e.get("metagraph:gestures") != "false", **common)
        return [ask], {"end": seconds, "relax": seconds, **{mark: x * share for mark, x in marks.items()}}

    # --- attributes

    def _note(self, e: Element, words: str) -> None:
        self.notes.append(f"{e.place} {words}")

    def _number(self, e: Element, name: str, default: float) -> float:
        text = e.get(name)
        if not text:
            return default
        value = parse_seconds(text)
        if value is None:
            raise a.RequestError(f"{e.place}: {name} is a number, not '{text}'")
        return value

    def _integer(self, e: Element, name: str, default: int) -> int:
        return int(self._number(e, name, default))

    def _felt(self, e: Element) -> dict[str, Any]:
        """Return the mood and intensity of an element that tells any."""
        word = e.get("metagraph:mood") or (e.get("mood") if e.name.lower() == "metagraph:mood" else "")
        own: dict[str, Any] = {}
        if word:
            values = [parse_seconds(x) for x in word.replace(",", " ").split()]
            own["mood"] = word if None in values else values
        if e.get("metagraph:intensity"):
            own["intensity"] = self._number(e, "metagraph:intensity", 1.0)
        try:
            read = msgspec.convert(own, a.Feel)
        except msgspec.ValidationError as error:
            raise a.RequestError(f"{e.place}: {a.explain_invalid_ask(error)}") from None
        return {name: getattr(read, name) for name in own}

    def _tags(self, e: Element) -> tuple[str, ...] | None:
        text = e.get("metagraph:tags")
        if not text:
            return None
        try:
            return msgspec.json.decode(text, type=tuple[str, ...])
        except (msgspec.DecodeError, RecursionError):
            raise a.RequestError(
                f'{e.place}: metagraph:tags is a JSON list of texts, as ["positive"]'
            ) from None

    def _point(self, e: Element, text: str) -> tuple[float, ...]:
        values = [parse_seconds(x) for x in text.replace(",", " ").split()]
        if len(values) != 3 or any(v is None for v in values):
            raise a.RequestError(f"{e.place}: a point is three numbers, metres, not '{text}'")
        return tuple(v for v in values if v is not None)

    def _target(self, e: Element) -> Any:
        if e.get("metagraph:to"):
            return e.get("metagraph:to")
        target = e.get("target") or "user"
        return (
            self._point(e, target)
            if re.fullmatch(r"[-+.\deE]+[\s,]+[-+.\deE]+[\s,]+[-+.\deE]+", target)
            else target
        )


def _spoken(e: Element) -> Iterable[str | Element]:
    """Yield what is said, in order: texts, and the elements that mark a place in them."""
    for part in e.parts:
        if isinstance(part, str) or part.name.lower() in ("sync", "mark", "tm", "bookmark"):
            yield part
        elif part.name.lower() not in SAID:
            yield from _spoken(part)


def _listed(lexeme: str) -> tuple[str, ...]:
    return tuple(word for x in lexeme.split(",") if (word := x.strip()))
