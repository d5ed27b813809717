"""What a character of the runtime is asked to say at random, piece by piece, ends once, whatever is done to it."""

from __future__ import annotations

import random
from collections import Counter
from typing import Any

import pytest

from metagraph.engines.character import Character
from metagraph.graph.model import Project
from metagraph.playback.life.utterances import is_paused

TICK = 1 / 60
IDS = ("x", "y")
WORDS = ("Well", " I", " think", " it", " rains", ",", " all day", ".", "Yes")
STEERED = ("interrupt", "pause", "resume", "finish", "withdraw")


class Talker:
    """A character that is asked at random, and what was heard of it."""

    def __init__(self, project: Project, seed: int) -> None:
        self.character = Character(project, idle=False)
        self.random = random.Random(seed)
        self.begun: set[tuple[str, float]] = set()
        self.ends: Counter[str] = Counter()
        self.steps: list[object] = []

    def go(self, ticks: int, step: float = TICK) -> None:
        for _ in range(ticks):
            before = self.character.now
            self.character.update(before + step)
            now, speeches = self.character.now, self.character.plan.track.speeches
            self.begun |= {(s.id, s.asked) for s in speeches if s.start <= now and s.end > before}
            self.ends.update(e.meta for e in self.character.events() if e.reason)

    def choose(self) -> None:
        """Do one step of the many that are possible."""
        r, ident = self.random, self.random.choice(IDS)
        kind = r.choices(("say", "append", "words", "steer", "wait"), (2, 3, 2, 4, 5))[0]
        if kind == "wait":
            ticks = r.choice((1, 3, 20, 90))
            self.steps.append(ticks)
            self.go(ticks)
            return
        request: dict[str, Any] = {"do": "say", "id": ident}
        if kind == "steer":
            request = {"do": r.choice(STEERED)} | ({"what": ident} if r.random() < 0.7 else {})
        elif kind == "words":
            count = r.randint(1, 4)
            request["words"] = [[f"word{n}", 0.4 * n, 0.4 * n + 0.3] for n in range(count)]
            request["more"] = bool(count % 2)
        elif kind == "append":
            request |= {"text": r.choice(WORDS), "more": True}
        else:
            request["text"] = "".join(r.choices(WORDS, k=r.randint(1, 6)))
        self.steps.append(request)
        self.character.ask(request)

    def stop(self) -> None:
        """Let all be said to its end."""
        for do in ("resume", "finish"):
            self.character.ask({"do": do})
            self.go(1)
        self.go(40)
        self.go(290, 0.1)


def find_fault(project: Project, seed: int) -> str:
    """Return what is wrong with one sequence, "" if nothing is."""
    talker = Talker(project, seed)
    for _ in range(talker.random.randint(3, 25)):
        talker.choose()
    talker.stop()
    wanted = Counter(ident for ident, _ in talker.begun)
    track = talker.character.plan.track
    left = [s for s in track.speeches if is_paused(s.start) or (s.more and track.last_speech(s.id) is s)]
    if talker.ends == wanted and not left:
        return ""
    return f"seed {seed}: {dict(talker.ends)} ends of {dict(wanted)}, left {left}, after {talker.steps}"


@pytest.mark.parametrize("seed", range(12))
def test_each_utterance_that_begins_ends_once(sample: Project, seed: int) -> None:
    assert find_fault(sample, seed) == ""
