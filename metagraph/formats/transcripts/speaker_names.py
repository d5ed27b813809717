"""Who speaks by what a line of text begins with: a name before a colon ("Ann: so"), or one in brackets
("[Ann] so", "(SPEAKER_00) so").
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from metagraph.common.wording import phrase
from metagraph.formats.transcripts.words import Collected

_MARKS = "\u0300-\u036f\u0900-\u109f\u0e00-\u0eff"  # of vowels: none of them is a letter to a pattern
_LETTERS = rf"[^\W_][\w .'’,&{_MARKS}-]{{0,48}}?"
_ROLE = r"(?:\s*[(（][^()（）\n]{1,40}[)）])?"  # "Ann (host)"
_START = rf"\s*(?:[-–>]{{1,2}}\s*)?({_LETTERS})({_ROLE})\s*"
_COLON = re.compile(rf"{_START}(?::(?:\s+|$)|：\s*)")
_TIGHT = re.compile(rf"{_START}:(?=[^\W\d_])")  # "Ann:so", but neither 10:30 nor http://
_BRACKETED = re.compile(rf"\s*[\[(（【]\s*({_LETTERS})\s*[\])）】]\s*(?:[:：]\s*)?(?=\S)")
_MOST = 12  # names in one file; more are no names but lists, places, numbers
_LONE = 3  # words of a name that stands alone
# What stands before a colon, or in brackets, and is nobody.
_NOBODY = frozenset(
    [
        "note",
        "notes",
        "ps",
        "warning",
        "caution",
        "attention",
        "example",
        "question",
        "answer",
        "q",
        "a",
        "remember",
        "tip",
        "result",
        "results",
        "summary",
        "conclusion",
        "first",
        "second",
        "third",
        "finally",
        "subject",
        "title",
        "date",
        "time",
        "location",
        "place",
        "problem",
        "solution",
        "chapter",
        "part",
        "step",
        "rule",
        "fact",
        "music",
        "applause",
        "laughter",
        "laughs",
        "laughing",
        "silence",
        "noise",
        "crosstalk",
        "inaudible",
        "cheering",
        "sighs",
        "coughs",
        "http",
        "https",
        "www",
        "hinweis",
        "achtung",
        "beispiel",
        "frage",
        "antwort",
        "merke",
        "fazit",
        "musik",
        "applaus",
        "gelächter",
        "lachen",
        "stille",
        "remarque",
        "exemple",
        "réponse",
        "musique",
        "applaudissements",
        "rires",
        "nota",
        "atención",
        "ejemplo",
        "pregunta",
        "respuesta",
        "música",
        "aplausos",
        "risas",
        "esempio",
        "domanda",
        "risposta",
        "musica",
        "applausi",
    ]
)


@dataclass(frozen=True)
class SpeakerNames:
    """Which beginnings of lines are names. way: has the name in its first group. lone: the only name, where
    it was read from a single line.
    """

    way: re.Pattern[str]
    known: frozenset[str]
    lone: str = ""

    def tell(self, out: Collected) -> None:
        """Add a note of a name that was read from a single line."""
        if self.lone:
            out.notes.append(
                phrase(
                    "'{name}' before the colon is read as the speaker's name, not as a word", name=self.lone
                )
            )

    def part(self, line: str) -> tuple[str, str] | None:
        """Return who says a line, and the rest of it; None if it begins with no name."""
        found = self.way.match(line)
        return (found[1], line[found.end() :]) if found is not None and found[1] in self.known else None


def find_speaker_names(texts: Sequence[Sequence[str]]) -> SpeakerNames:
    """Return the names that lines begin with. texts: the lines of each cue or message, without tags."""
    return _in_brackets(texts) or _before_colons(texts)


def _in_brackets(texts: Sequence[Sequence[str]]) -> SpeakerNames | None:
    """Return the names in brackets that at least half of all texts begin with; a "[laughter]" now and then is
    none.
    """
    firsts = [_BRACKETED.match(lines[0]) for lines in texts if lines]
    found = {m[1] for m in firsts if m is not None and m[1].casefold() not in _NOBODY}
    often = 2 * sum(m is not None for m in firsts) >= len(firsts)
    if not often or not 0 < len(found) <= _MOST:
        return None
    if len(found) == 1 and sum(m is not None for m in firsts) < 2:
        return None
    return SpeakerNames(_BRACKETED, frozenset(found))


def _before_colons(texts: Sequence[Sequence[str]]) -> SpeakerNames:
    """Return the names that stand before a colon: those that come again, or beside others. A single one is a
    name where it looks like one and nothing speaks against it; "Note: ..." is none.
    """
    lines = [line for some in texts for line in some]
    found = Counter(m.group(1) for line in lines if (m := _COLON.match(line)))
    people = {name for name in found if name.casefold() not in _NOBODY and not name.isdigit()}
    often = {name for name, times in found.items() if times > 1 and name.casefold() not in _NOBODY}
    if 1 < len(people) <= _MOST:
        return SpeakerNames(_COLON, frozenset(people | often))
    if often:
        return SpeakerNames(_COLON, frozenset(often))
    if len(people) == 1 and _like_a_name(name := next(iter(people)), lines):
        return SpeakerNames(_COLON, frozenset(people), name)
    tight = Counter(m.group(1) for line in lines if (m := _TIGHT.match(line)))
    again = {name for name, times in tight.items() if times > 1 and name.casefold() not in _NOBODY}
    if again and 2 * sum(tight[name] for name in again) >= len(texts):
        return SpeakerNames(_TIGHT, frozenset(again))
    return SpeakerNames(_COLON, frozenset())


def _like_a_name(name: str, lines: Sequence[str]) -> bool:
    """Return whether a lone text before a colon is a name: up to three words, each with a capital or a number
    (writing without capitals aside), in the first line, and none of them said in small letters elsewhere.
    """
    words = name.split()
    first = next((line for line in lines if line.strip()), "")
    named = _COLON.match(first)
    if len(words) > _LONE or named is None or named[1] != name:
        return False
    if any(w[0].islower() for w in words) or any(w.casefold().strip(".") in _NOBODY for w in words):
        return False
    said = {w.strip(".,;:!?…\"'()") for line in lines for w in line.split()}
    return not any(w.casefold() in said for w in words if w.casefold() != w)
