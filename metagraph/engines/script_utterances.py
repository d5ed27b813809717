"""Scripts of conformance in which what is said comes in pieces, is paused, goes on and is broken off."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from metagraph.engines.script_parts import ScriptCase, ScriptStep, ask
from metagraph.graph.model import Project

TOKENS = ("Well", ",", " I", " do", " not", " th", "ink", " so", ".")
LETTERS = [
    ["O", 0.1, 0.2],
    ["n", 0.2, 0.3],
    ["e", 0.3, 0.4],
    [" ", 0.4, 0.5],
    ["二", 0.5, 0.8],
    ["三", 0.8, 1.1],
]
ENDS = 24.0  # seconds of each script


def list_utterance_cases(project: Project) -> Iterator[ScriptCase]:
    """Yield the cases that suit a project."""
    words = [["one", 0.1, 0.4], ["two", 0.5, 0.9], ["three", 1.0, 1.6], ["four", 1.7, 2.2]]
    for name, said in (
        ("text", {"text": "It rains all day, so take a coat with you.", "mood": "happy"}),
        ("words", {"words": words, "mood": "sad"}),
        ("shapes", {"visemes": [[0.0, "aa"], [0.5, "PP"], [0.9, "O", 0.8], [1.8, "sil"]], "set": "oculus"}),
    ):
        yield _turned(name, said)
    steps = [_step(2.0 + 0.2 * n, ask("s", "say", text=text, more=True)) for n, text in enumerate(TOKENS)]
    steps += [
        _step(6.0, ask("s", "say", text=" Once more?", more=True, mood="happy")),
        _step(6.3, ask("p", "pause", what="s")),
        _step(7.0, ask("s", "say", text=" And again.", more=True)),
        _step(8.0, ask("r", "resume", what="s"), ask("s/1", "gesture", 9.0)),
        _step(12.0, ask("f", "finish", what="s")),
        _step(13.0, ask("s", "say", text="Anew", more=True), ask("c", "say", 16.0, characters=LETTERS)),
        _step(15.0, ask("i", "interrupt", what="s")),
    ]
    yield ScriptCase(
        "words in pieces",
        "text behind text, until it is finished",
        tuple(steps),
        idle=True,
        times=(2.3, 3.1, 6.2, 6.5, 8.4, 9.3, 14.0, 16.4),
        alive=(True,),
    )
    faint = [[0.0, "aa", 0.4], [0.12, "PP"], [0.3, "O", 0.9], [0.42, "PP"], [0.6, "E", 0.3], [1.4, "sil"]]
    steps = [
        _step(0.0, ask("a", "say", 1.0, text="This is one thing."), ask("v", "say", 8.0, visemes=faint)),
        _step(0.0, *(ask(f"a/{word}", "nod", 12.0 + n) for n, word in enumerate(("1", "two", "x/3")))),
        _step(0.5, ask("w", "withdraw", what="a")),
    ]
    yield ScriptCase(
        "taken back with what was made for it",
        "ids that only look like its own stay; faint and short mouth shapes",
        tuple(steps),
        idle=True,
        times=(1.4, 8.1, 8.35, 9.0, 12.3, 13.3, 14.3),
        alive=(True,),
    )
    steps = [
        _step(1.0, ask("a", "say", text="This is one thing."), ask("b", "say", 4.0, text="That is another.")),
        _step(1.5, ask("p", "pause"), ask("q", "pause", what="b")),
        _step(2.0, ask("r", "resume", what="b"), ask("r2", "resume", what="b")),
        _step(2.5, ask("i", "interrupt", what="a"), ask("t", "resume")),
        _step(5.0, ask("n", "interrupt"), ask("o", "finish"), ask("w", "withdraw")),
    ]
    yield ScriptCase(
        "several things paused",
        "each goes on for itself",
        tuple(steps),
        times=(1.7, 2.4, 3.0),
        alive=(True,),
    )


def _turned(name: str, said: dict[str, Any]) -> ScriptCase:
    """Return a case in which something is paused, goes on, and is broken off, with gestures made for it."""
    steps = (
        _step(0.5, ask("d", "look", to="ahead")),
        _step(2.0, ask("s", "say", **said), *[ask(f"s/{n}", "gesture", 2.2 + 1.3 * n) for n in range(3)]),
        _step(2.0, ask("s/3", "gesture", stroke=4.6), ask("s/4", "look", 3.5, to=[0.5, 1.5, 1.0])),
        _step(2.71, ask("p", "pause")),
        _step(4.0, ask("r", "resume", what="s")),
        _step(5.03, ask("i", "interrupt", what="s")),
        ScriptStep(9.0, ENDS, (ask("s", "say", **said),), forget=8.0),
        _step(9.9, ask("j", "interrupt")),
    )
    return ScriptCase(
        f"{name} that is interrupted",
        "it stops at a sound, its gestures go back, and the gaze goes to the partner",
        steps,
        idle=True,
        times=(2.5, 2.9, 3.9, 4.3, 4.9, 5.2, 5.6, 9.5),
        alive=(True,),
    )


def _step(now: float, *asks: Any) -> ScriptStep:
    return ScriptStep(now, ENDS, tuple(asks))
