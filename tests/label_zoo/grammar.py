"""How studios name clips: prefixes, languages, orders of words, sides, takes and stances by number."""

from __future__ import annotations

import csv
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Literal

import numpy as np

LANGUAGES = ("en", "synonym", "de", "fr", "es", "it", "pt", "romaji", "pinyin", "ja", "zh")
STYLES = ("snake", "camel", "kebab", "space", "dots", "title space", "Snake", "UPPER")
SIDES: Mapping[str, tuple[str, str, str]] = {
    "Lf": ("Lf", "Rt", "Bt"),
    "L": ("L", "R", "LR"),
    "left": ("left", "right", "both"),
    "l": ("l", "r", ""),
    "Left": ("LeftHand", "RightHand", "BothHands"),
    "none": ("", "", ""),
    "de": ("links", "rechts", "beide"),
    "fr": ("gauche", "droite", ""),
    "es": ("izq", "der", ""),
    "ja": ("左", "右", "両手"),
    "zh": ("左", "右", "双手"),
}
TO = ("to", "2", "from to", "trans", "To only", "arrow", "glued")
Order = Literal["stance first", "action first", "action only"]


@dataclass(frozen=True)
class Grammar:
    """How a set's clips are called.

    prefix: before every name, as it is. language: a column of the words. style: one of STYLES. side: a key of
    SIDES. order: whether and where clips say their stance; the clips of the first stance say none where
    `silent`. numbered: stances by number after a word ("Idle" -> Idle01), by letter where it ends with `@`
    ("Sit_@" -> Sit_A), by posture and number where it holds `{}` ("Idle{}" -> IdleSitBack01), or "" by what
    they are. together:
    stance and action joined without a separator but `_` between (IdleSeated01_ShrugLf01). to: one of TO.
    loop: what the name of a stance's loop ends with. take: "", "1", "01", "001" or "(1)". opaque: names that
    tell nothing, `{}` the number.
    """

    prefix: str = ""
    language: str = "en"
    style: str = "snake"
    side: str = "Lf"
    order: Order = "stance first"
    silent: bool = False
    numbered: str = ""
    together: bool = False
    to: str = "to"
    loop: str = ""
    take: str = "01"
    opaque: str = ""
    accents: bool = True


@cache
def words(language: str) -> Mapping[str, str]:
    """Return key -> words, of one of LANGUAGES."""
    path = Path(__file__).with_name("words.tsv")
    with path.open(encoding="utf-8", newline="") as file:
        return {row["key"]: row[language] for row in csv.DictReader(file, delimiter="\t")}


def joined(parts: list[str], style: str) -> str:
    """Return words as one text; words of scripts without case stay together."""
    bits = [bit for part in parts for bit in part.split() if bit]
    if style == "camel":
        return "".join(bit[:1].upper() + bit[1:] for bit in bits)
    if style == "Snake":
        return "_".join(bit[:1].upper() + bit[1:] for bit in bits)
    if style == "title space":
        return " ".join(bit[:1].upper() + bit[1:] for bit in bits)
    if style == "UPPER":
        return "_".join(bit.upper() for bit in bits)
    return {"snake": "_", "kebab": "-", "space": " ", "dots": "."}[style].join(bits)


class Namer:
    """Gives a set's clips their names, each once. stances: key of a stance -> the words of its posture, in
    the order in which they are numbered.
    """

    def __init__(self, how: Grammar, stances: Mapping[str, str], draw: np.random.Generator) -> None:
        self.how, self.draw = how, draw
        self.stances = [*stances]
        self.words = dict(stances)
        self.taken: set[str] = set()
        self.count = int(draw.integers(1, 400))

    def stance(self, key: str) -> str:
        """Return what a stance is called, in words."""
        if not self.how.numbered:
            return self._told(self.words[key])
        number = self.stances.index(key) + 1
        if self.how.numbered.endswith("@"):
            return self.how.numbered[:-1] + "ABCDEFGHIJKLMNOP"[number - 1]
        if "{}" in self.how.numbered:
            postures = {k: [w for w in keys.split() if len(w) > 1] for k, keys in self.words.items()}
            alike = [k for k in self.stances if postures[k] == postures[key]]
            posture = joined([self._told(" ".join(postures[key]))], "camel")
            return f"{self.how.numbered.replace('{}', posture)}{alike.index(key) + 1:02d}"
        digits = f"{number:02d}" if len(self.how.take) != 1 else str(number)
        return f"{self.how.numbered}{digits}"

    def _told(self, keys: str) -> str:
        table = words(self.how.language)
        text = " ".join(table.get(key, key) for key in keys.split())
        if not self.how.accents:
            text = unicodedata.normalize("NFKD", text.replace("ß", "ss"))
            text = "".join(c for c in text if not unicodedata.combining(c))
        return text

    def name(self, kind: str | None, action: str, stance: str, end: str = "", limb: str | None = None) -> str:
        """Return the name of a clip that has none yet. action: key of its words."""
        how = self.how
        self.count += int(self.draw.integers(1, 3))
        if how.opaque:
            return self._once(how.opaque.replace("{}", f"{self.count:03d}"), False)
        if kind == "stance":
            parts = [self.stance(stance), how.loop] if how.loop else [self.stance(stance)]
            return self._once(self._text(parts), False)
        if kind == "transition":
            return self._once(self._between(self.stance(stance), self.stance(end)), False)
        side = SIDES[how.side][("left", "right", "both").index(limb)] if limb else ""
        action_words = self._told(action)
        tells = how.order != "action only" and not (how.silent and stance == self.stances[0]) and stance
        if kind is None:
            return self._once(self._text([action_words]), True)
        if how.together and tells:
            return self._once(
                f"{joined([self.stance(stance)], 'camel')}_{joined([action_words, side], 'camel')}", True
            )
        parts = [action_words, side]
        if tells:
            parts = (
                [self.stance(stance), *parts]
                if how.order == "stance first"
                else [*parts, self.stance(stance)]
            )
        return self._once(self._text(parts), True)

    def _text(self, parts: list[str]) -> str:
        return joined([p for p in parts if p], self.how.style)

    def _between(self, a: str, b: str) -> str:
        how = self.how
        camel = how.style in ("camel", "title space", "Snake")
        if how.together:
            return f"{joined([a], 'camel')}_To{joined([b], 'camel')}"
        if how.to == "2":
            return self._text([a]) + "2" + self._text([b])
        if how.to == "glued":
            return self._text([a]) + "to" + self._text([b])
        if how.to == "arrow":
            return f"{self._text([a])}-{self._text([b])}"
        to = {"de": "zu", "fr": "vers", "es": "a", "it": "a", "pt": "para", "ja": "から", "zh": "到"}
        word = to.get(how.language, "To" if camel else "to")
        if how.to == "To only":
            return self._text([word, b]) if how.silent else self._text([a, word, b])
        if how.to == "from to":
            return self._text(["from", a, "to", b])
        if how.to == "trans":
            return self._text(["trans", a, b])
        return self._text([a, word, b])

    def _once(self, name: str, numbered: bool) -> str:
        """Return the name with prefix and the first take number that is free."""
        how = self.how
        for take in range(1, 1000):
            digits = {"": "", "1": str(take), "01": f"{take:02d}", "001": f"{take:03d}"}.get(
                how.take, f" ({take})"
            )
            if not numbered and take == 1:
                digits = ""
            if not digits and take > 1:
                digits = f"_{take}"
            if digits and how.style in ("snake", "Snake", "UPPER", "kebab", "space", "title space", "dots"):
                between = {"kebab": "-", "space": " ", "title space": " ", "dots": "."}.get(how.style, "_")
                digits = digits if digits[0] in " _" or how.together else between + digits
            full = how.prefix + name + digits
            if full not in self.taken:
                self.taken.add(full)
                return full
        raise AssertionError("a thousand clips of one name")
