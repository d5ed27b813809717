"""Scripts of conformance in which this and that is said by chance, in pieces, and steered: what was spoken by
then, what began and ended, and what became of each request are compared after each step.
"""

from __future__ import annotations

from collections.abc import Iterator
from random import Random
from typing import Any

from metagraph.engines.script_parts import Ask, ScriptCase, ScriptStep, ask
from metagraph.graph.model import Project

SCRIPTS = 6
STEPS = 26
AFTER = (
    0.3,
    1.5,
    4.0,
    70.0,
)  # seconds behind the last step at which is looked once more: also when all is forgotten
_SAID = (
    "One thing. Another thing!",
    "It isn't so, is it?",
    " and on",
    "…",
    "二三 four 五。",
    "Hm",
    "so",
    " it goes,",
    "Oh no no",
)
_WORDS = ("one", "two", "three", "four", "five", "six", "seven", "eight")
_SHAPES = ("aa", "PP", "O", "sil", "E", "FF", "nn", "U")
_POLLY = ("a", "p", "O", "sil", "e", "f", "t", "u")


def list_speech_cases(project: Project) -> Iterator[ScriptCase]:
    """Yield the cases that suit a project."""
    if not project.life.on:
        return
    for seed in range(1, SCRIPTS + 1):
        chance = Random(100 + seed)
        now, steps = 0.0, []
        talk = _Talk(chance, [*project.lines])
        for n in range(STEPS):
            asks = tuple(talk.draw(now, n < 3) for _ in range(chance.choice((1, 1, 2, 3))))
            forget = max(0.0, now - 4.0) if n % 9 == 8 else None
            steps.append(ScriptStep(round(now, 3), round(now + 14.0, 3), asks, forget))
            now += chance.choice((0.125, 0.25, 0.25, 0.5, 0.5, 1.0, 3.0))
        last = steps[-1].now
        yield ScriptCase(
            f"said by chance {seed}",
            "in pieces, of words, letters and shapes, paused, gone on with, broken off and said anew",
            tuple(steps),
            seed,
            times=(round(last + 0.11, 3),) if seed == 1 else (),
            alive=(True,) if seed == 1 else (),
            watched=tuple(round(last + x, 3) for x in AFTER),
        )


class _Talk:
    """What is asked by chance, and how far each line has come."""

    def __init__(self, chance: Random, lines: list[str]) -> None:
        self.chance = chance
        self.lines = lines
        self.told: dict[str, int] = {}  # words or shapes of each line that were reported
        self.count = 0

    def draw(self, now: float, first: bool) -> Ask:
        """Return something that is asked. first: and that something be said."""
        chance = self.chance
        self.count += 1
        ident = chance.choice(("s", "s", "t", "u"))
        match chance.choice(_TOLD if first else (*_TOLD, *_STEERED)):
            case "text":
                more: dict[str, Any] = {"text": chance.choice(_SAID)}
                if chance.random() < 0.2:
                    more["duration"] = chance.choice((0.0, 0.75, 2.0))
                return ask(ident, "say", self._at(now), **more, **self._mood())
            case "words":
                return ask(ident, "say", self._at(now), words=self._words(ident), **self._mood())
            case "letters":
                letters = [
                    [x, 0.125 * n, 0.125 * n + 0.125]
                    for n, x in enumerate(chance.choice(("Oh so", "二三", "a b ")))
                ]
                return ask(ident, "say", self._at(now), characters=letters, **self._mood())
            case "shapes":
                return ask(ident, "say", self._at(now), **self._shapes(ident))
            case "line" if self.lines:
                return ask(
                    ident,
                    "say",
                    self._at(now),
                    line=chance.choice(self.lines),
                    gestures=chance.random() < 0.5,
                )
            case "child":
                does = chance.choice(("nod", "look", "gesture", "mood"))
                own: dict[str, Any] = {"to": [0.5, 1.5, 1.0]} if does == "look" else {}
                own = {"mood": "warm", "duration": 2.0} if does == "mood" else own
                return ask(f"{ident}/{self.count}", does, self._at(now), **own)
            case does if does in _STEERED:
                named: dict[str, Any] = {"what": ident} if chance.choice((0, 1, 2, 3)) else {}
                return ask(f"{does}{self.count}", does, **named)
        return ask(f"b{self.count}", "blink", self._at(now))

    def _at(self, now: float) -> float | None:
        if self.chance.random() < 0.7:
            return None
        return max(0.0, round(now + self.chance.choice((-0.5, 0.0, 0.25, 1.0, 2.5)), 3))

    def _mood(self) -> dict[str, Any]:
        found: dict[str, Any] = {"more": True} if self.chance.random() < 0.45 else {}
        if self.chance.random() < 0.15:
            found |= {
                "mood": self.chance.choice(("happy", "sad")),
                "intensity": self.chance.choice((None, 1.5)),
            }
        if self.chance.random() < 0.15:
            found["priority"] = self.chance.choice((0, 2))
        return found

    def _range(self, ident: str) -> tuple[int, int]:
        """Return which words or shapes are reported: the next, all from the first, or some again."""
        told = self.told.get(ident, 0)
        first = self.chance.choice((told, told, told, 0, max(0, told - 1), told + 2))
        end = min(len(_WORDS), first + self.chance.choice((1, 2, 4)))
        if first >= end:
            first, end = 0, 2
        self.told[ident] = end
        return first, end

    def _words(self, ident: str) -> list[Any]:
        first, end = self._range(ident)
        by = self.chance.choice((0.0, 0.0, 0.0, 0.125, 2.0))
        open_end = self.chance.random() < 0.2
        return [
            [_WORDS[n], 0.375 * n + by] if open_end else [_WORDS[n], 0.375 * n + by, 0.375 * n + by + 0.25]
            for n in range(first, end)
        ]

    def _shapes(self, ident: str) -> dict[str, Any]:
        first, end = self._range(ident)
        by = self.chance.choice((0.0, 0.0, 0.0, 0.0625, 2.0))
        names = self.chance.choice((_SHAPES, _SHAPES, _POLLY))
        shapes = [[0.25 * n + by, names[n]] for n in range(first, end)]
        if self.chance.random() < 0.25:
            shapes[-1].append(0.5)
        return {"visemes": shapes, "set": "polly" if names is _POLLY else "oculus", **self._mood()}


_TOLD = ("text", "text", "words", "words", "letters", "shapes", "shapes", "line")
_STEERED = ("pause", "pause", "resume", "resume", "interrupt", "finish", "withdraw", "child", "child")
