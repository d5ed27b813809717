"""Scripts of conformance in which something is asked again under its id, one thing changed: a runtime that
takes the two for the same goes on as if nothing had been said. Also all shapes of speech services' sets, and
actions by name and layer.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from metagraph.engines.script_parts import ScriptCase, ScriptStep, ask, list_some_actions, make_case
from metagraph.graph.model import LAYERS, Project
from metagraph.playback.life.line_timing import AZURE, OCULUS, POLLY

AT = 6.0  # seconds at which what is requested begins
SHORT = 0.05  # seconds of the shortest shapes

_SAID: dict[str, Any] = {"words": [["one", 0.0, 0.4], ["two", 0.9, 1.4]]}
_SHAPED: dict[str, Any] = {"visemes": [[0.0, "aa"], [0.4, "PP"], [0.7, "O", 0.8]]}
_CHANGES: tuple[tuple[str, dict[str, Any], dict[str, Any]], ...] = (
    ("look", {"to": "lamp", "amount": 0.9}, {"to": "lamp", "amount": 0.3}),
    ("look", {"to": "lamp"}, {"to": "lamp", "strict": True}),
    ("look", {"to": [0.6, 1.5, 1.2]}, {"to": [0.6, 1.2, 1.2]}),
    ("look", {"to": "lamp", "duration": 4.0}, {"to": "lamp", "duration": 1.0}),
    ("place", {"name": "lamp", "point": [0.8, 1.6, 1.0]}, {"name": "lamp", "point": [0.8, 1.6, -0.4]}),
    ("say", _SAID, {"words": [["one", 0.0, 0.4], ["two", 0.9, 1.8]]}),
    ("say", _SAID, {"words": [["one", 0.0, 0.4], ["toe", 0.9, 1.4]]}),
    ("say", _SAID, {"words": [["one", 0.0, 0.4], ["two", 1.0, 1.4]]}),
    ("say", _SHAPED, {"visemes": [[0.0, "aa"], [0.4, "PP"], [0.8, "O", 0.8]]}),
    ("say", _SHAPED, {"visemes": [[0.0, "aa"], [0.4, "PP"], [0.7, "E", 0.8]]}),
    ("say", _SHAPED, {"visemes": [[0.0, "aa"], [0.4, "PP"], [0.7, "O", 0.2]]}),
    ("mode", {"mode": "talking"}, {"mode": "listening"}),
    ("mood", {"mood": "sad"}, {"mood": [-0.71, 0.4]}),
    ("mood", {"mood": "sad", "intensity": 0.5}, {"mood": "sad", "intensity": 1.6}),
    ("mood", {"mood": "happy", "duration": 5.0}, {"mood": "happy", "duration": 1.0}),
)  # fmt: skip


def list_replaced_cases(project: Project) -> Iterator[ScriptCase]:
    """Yield the cases that suit a project."""
    looked = ask("seen", "look", AT - 0.5, to="lamp")
    here = ask("lamp", "place", 0.0, name="lamp", point=[-0.7, 1.4, 0.9])
    for n, (do, first, then) in enumerate(_CHANGES):
        begin = (here, looked) if do == "place" else (here,)
        steps = (
            ScriptStep(0.0, 14.0, (*begin, ask("x", do, AT, **first))),
            ScriptStep(3.0, 14.0, (ask("x", do, AT, **then),)),
        )
        yield ScriptCase(
            f"asked again: {do} {n}", "one thing of it is another now", steps, times=(7.45,), alive=(True,)
        )
    for layer in LAYERS:
        for stance in list(project.graphs[layer].stances)[1:2]:
            yield ScriptCase(
                f"asked again: stance of {layer}",
                "no longer to stay in it",
                (
                    ScriptStep(0.0, 60.0, (ask("x", "stance", 3.0, stance=stance, layer=layer, stay=True),)),
                    ScriptStep(1.0, 60.0, (ask("x", "stance", 3.0, stance=stance, layer=layer, stay=False),)),
                ),
                idle=True,
                times=(30.0,),
            )
    yield from _sets()
    yield from _named(project)
    yield _pieces()


def _pieces() -> ScriptCase:
    """Return a case of what is said piece by piece, with gestures made for it, and is taken back."""
    words = [["one", 0.0, 0.4], ["two", 0.5, 0.9]]
    made = [ask(f"s/{n}", "gesture", AT + n) for n in (1, 3)]
    steps = (
        ScriptStep(0.0, 30.0, (ask("u", "look", 1.0), ask("v", "look", 2.0, to="ahead"))),
        ScriptStep(5.9, 30.0, (ask("s", "say", words=words), *made)),
        ScriptStep(6.1, 30.0, (ask("s", "say", words=[["three", 0.0, 0.3], ["four", 0.3, 0.8]]),)),
        ScriptStep(7.4, 30.0, (ask("w", "withdraw", what="s"),)),
        ScriptStep(9.0, 30.0, (ask("t", "say", text="One thing."),)),
        ScriptStep(9.1, 30.0, (ask("t", "say", text="一二三四。", mood="happy"),)),
        ScriptStep(14.0, 30.0, (ask("l", "say", words=words),)),
        ScriptStep(18.0, 30.0, (ask("l", "say", words=[["late", 1.0, 1.4]]),)),
        ScriptStep(18.2, 30.0, (ask("l", "say", words=[["later", 1.5, 2.0]]),)),
        ScriptStep(18.4, 30.0, (ask("all", "withdraw"),)),
    )
    times = (6.7, 7.3, 7.6, 8.0, 9.5, 10.3, 11.5, 18.3, 18.45, 19.0)
    return ScriptCase("said in pieces", "pieces follow each other and end together", steps, times=times)


def _sets() -> Iterator[ScriptCase]:
    oculus = [[0.12 * n, name] for n, name in enumerate(OCULUS)]
    azure = [{"audioOffset": 1_200_000 * n, "visemeId": int(name)} for n, name in enumerate(AZURE)]
    polly = [{"time": 120 * n, "type": "viseme", "value": name} for n, name in enumerate(POLLY)]
    quick = [[SHORT * n, name] for n, name in enumerate(("aa", "sil", "E", "PP", "O", "sil", "aa", "nn"))]
    asks = [
        ask("s1", "say", 1.0, visemes=oculus),
        ask("s2", "say", 5.0, visemes=azure, duration=3.0),
        ask("s3", "say", 9.0, visemes=polly),
        ask("s4", "say", 12.0, visemes=quick),
        ask("s5", "say", 13.0, visemes=[[0.0, "@"], [SHORT, "a"]], set="polly"),
    ]
    starts = ((1.0, len(oculus)), (5.0, len(azure)), (9.0, len(polly)))
    times = [round(start + 0.12 * n + 0.06, 3) for start, count in starts for n in range(0, count, 2)]
    times += [round(start + 0.12 * n + 0.1, 3) for start, count in starts for n in range(1, count, 4)]
    times += [12.03, 12.12, 12.22, 12.33, 13.02, 13.08, 13.2]
    yield make_case(
        "every shape of every set",
        "speech services' shapes, some of them very short",
        asks,
        14.0,
        times=tuple(times),
        alive=(True,),
    )


def _named(project: Project) -> Iterator[ScriptCase]:
    asks = []
    for n, layer in enumerate(LAYERS):
        found = list_some_actions(project, layer, "gesture", "fidget", "transition")
        if not found:
            continue
        other = LAYERS[(n + 1) % len(LAYERS)]
        one = found[0]
        asks += [
            ask(f"{layer}1", "action", 1.0, action=one.id, layer=layer),
            ask(f"{layer}2", "action", 9.0, action=one.name, layer=layer),
            ask(f"{layer}3", "action", 2.0, action=one.id, layer=other),
            ask(f"{layer}4", "action", 17.0, action=one.id, stroke=0.01),
            ask(f"{layer}5", "action", action=one.id, stroke=24.0, late=0.2),
        ]
    yield make_case("by id and layer", "an action is looked for in the layer that is told alone", asks, 30.0)
    soon = [
        ask(f"{layer}s", "gesture", layer=layer, stroke=0.04)
        for layer in LAYERS
        if list_some_actions(project, layer, "gesture")
    ]
    again = [
        ask(f"{layer}t", "gesture", layer=layer, stroke=8.0, late=0.05)
        for layer in LAYERS
        if list_some_actions(project, layer, "gesture")
    ]
    near = [
        ask(f"{layer}u", "gesture", layer=layer, stroke=8.25, late=0.0)
        for layer in LAYERS
        if list_some_actions(project, layer, "gesture")
    ]
    yield make_case(
        "strokes sooner than can be", "and two a quarter of a second apart", [*soon, *again, *near], 20.0
    )
