"""What conformance asks: scripts of requests over time for whatever a project has, one for each rule of
the planner; other parts of the same have modules beside it.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations
from typing import Any

from metagraph.engines.script_chatter import list_chatter_cases
from metagraph.engines.script_crowds import list_crowd_cases
from metagraph.engines.script_faces import list_face_cases
from metagraph.engines.script_feet import list_feet_cases
from metagraph.engines.script_life import list_life_cases
from metagraph.engines.script_moods import list_mood_cases
from metagraph.engines.script_parts import Ask, ScriptCase, ScriptStep
from metagraph.engines.script_parts import ask as _ask
from metagraph.engines.script_parts import list_some_actions as _some
from metagraph.engines.script_parts import make_case as _once
from metagraph.engines.script_repeats import list_repeat_cases
from metagraph.engines.script_replaced import list_replaced_cases
from metagraph.engines.script_shades import list_shade_cases
from metagraph.engines.script_speech import list_speech_cases
from metagraph.engines.script_timely import list_timely_cases
from metagraph.engines.script_told import list_told_cases
from metagraph.engines.script_utterances import list_utterance_cases
from metagraph.engines.script_weight import list_weight_cases
from metagraph.graph.expand import find_chain
from metagraph.graph.model import LAYERS, Layer, Project


def make_script_cases(project: Project) -> Iterator[ScriptCase]:
    """Yield the cases that suit a project."""
    for part in (
        _alone,
        _layers,
        _requests,
        list_timely_cases,
        list_repeat_cases,
        _conflicts,
        _stances,
        _refused,
        _over_time,
        list_life_cases,
        list_mood_cases,
        list_shade_cases,
        list_face_cases,
        list_replaced_cases,
        list_utterance_cases,
        list_speech_cases,
        list_told_cases,
        list_chatter_cases,
        list_crowd_cases,
        list_weight_cases,
        list_feet_cases,
    ):
        yield from part(project)


def _alone(project: Project) -> Iterator[ScriptCase]:
    yield _once(
        "nothing is asked",
        "no requests and no models: every layer rests in its stance",
        [],
        alive=(False, True),
    )
    yield _once(
        "the models alone", "the Markov models fill half a minute", [], 30.0, idle=True, alive=(False, True)
    )
    yield _once(
        "the models with another seed", "every draw is another one", [], 30.0, idle=True, seed=0xFFFFFFFF
    )
    about = "what is likelier the longer ago it was, and how long stances last at least"
    yield _once("eight minutes", about, [], 480.0, idle=True, seed=5, alive=())
    yield _once("no time at all", "a plan of 0 seconds", [], 0.0, idle=True)
    for layer in LAYERS:
        for stance in list(project.graphs[layer].stances)[1:3]:
            yield _once(
                f"the {layer} begin in {stance}",
                "a start stance that was chosen",
                [],
                8.0,
                idle=True,
                stances={layer: stance},
            )


def _layers(project: Project) -> Iterator[ScriptCase]:
    for count in (1, 2, 3):
        for layers in combinations(LAYERS, count):
            asks = []
            for layer in layers:
                found = _some(project, layer, "gesture", "fidget", "transition")
                asks += [_ask(f"{layer}1", "action", 1.0, action=found[0].id)] if found else []
            if len(asks) == count:
                yield _once(
                    f"layers {' '.join(layers)}",
                    "their offsets add up",
                    asks,
                    6.0,
                    times=(1.1, 1.4, 1.8, 2.5, 5.9),
                )


def _requests(project: Project) -> Iterator[ScriptCase]:
    for layer in LAYERS:
        gestures = _some(project, layer, "gesture")
        if not gestures:
            continue
        one = gestures[0]
        asks = [_ask(f"g{n}", "gesture", 0.5 + 3 * n, layer=layer) for n in range(12)]
        yield _once(
            f"{layer}: the same asked over and over",
            "counts make used actions rarer; never twice, spacing, cooldown",
            asks,
            40.0,
        )
        tags = sorted({t for a in gestures for t in a.tags})[:3]
        asks = [
            _ask(f"t{tag}", "gesture", 0.5 + 3 * n, layer=layer, tags=[tag]) for n, tag in enumerate(tags)
        ]
        asks += [
            _ask(f"l{limb}", "gesture", 10.0 + 3 * n, layer=layer, limb=limb)
            for n, limb in enumerate(("left", "right", "both"))
        ]
        yield _once(f"{layer}: tags and limbs", "all tags must be there; the limb is a wish", asks, 24.0)
        asks = [
            _ask("early", "gesture", layer=layer, stroke=0.05),
            _ask("stroke", "gesture", layer=layer, stroke=6.0),
            _ask("soon", "action", 11.0, action=one.id, stroke=11.1),
        ]
        others = _some(project, layer, "fidget", "transition")
        asks += [_ask("other", "action", action=others[0].id, stroke=16.0)] if others else []
        late = [_ask(f"s{n}", "gesture", layer=layer, stroke=20.0 + 1.1 * n, priority=2) for n in range(4)]
        asks += [*late, _ask("low", "gesture", 19.5, layer=layer, duration=6.0, resume=True)]
        yield _once(f"{layer}: strokes in time", "start late enough, or skip the preparation", asks, 32.0)
        asks = [
            _ask("long", "action", 1.0, action=one.id, hold=2.5),
            _ask("short", "action", 9.0, action=one.id, hold=0.0),
            _ask("bare", "action", 16.0, action=one.id, prepare=False),
            _ask("all", "gesture", layer=layer, stroke=24.0, hold=1.2, prepare=False),
        ]
        yield _once(
            f"{layer}: holds and preparations", "holds stretch and hurry; preparations skip", asks, 30.0
        )
        asks = [
            _ask("wanted", "gesture", 1.0, layer=layer, duration=0.6),
            _ask("while", "gesture", 6.0, layer=layer, duration=5.0),
        ]
        yield _once(f"{layer}: for a certain time", "a window, and one action in it", asks)
    for layer in LAYERS:
        fidgets = _some(project, layer, "fidget")
        if fidgets:
            asks = [
                _ask("f1", "fidget", 1.0, layer=layer),
                _ask("f2", "fidget", 1.0, layer=layer, priority=2),
            ]
            yield _once(f"{layer}: fidgets", "two at once, one more important", asks)


def _conflicts(project: Project) -> Iterator[ScriptCase]:
    layer: Layer = (
        "arms"
        if _some(project, "arms", "gesture")
        else next((x for x in LAYERS if _some(project, x, "gesture")), "arms")
    )
    if not _some(project, layer, "gesture"):
        return

    def g(ident: str, at: float, **more: Any) -> Ask:
        return _ask(ident, "gesture", at, layer=layer, **more)

    yield _once(
        "ties of start and priority",
        "of two alike, the id that sorts first goes first",
        [g("b", 2.0), g("a", 2.0), g("C", 2.0)],
    )
    yield _once(
        "ties of start",
        "the more important goes first",
        [g("low", 2.0, priority=1), g("high", 2.0, priority=5)],
    )
    asks = [g("long", 1.0, duration=8.0, resume=True), g("urgent", 3.0, priority=3)]
    yield _once("cut and resumed", "what is cut goes on with its remainder", asks)
    asks = [g("long", 1.0, duration=8.0), g("urgent", 3.0, priority=3)]
    yield _once("cut", "what is cut and does not resume is over", asks)
    asks = [g("x", 1.0), g("y", 1.2), g("z", 1.4), g("late", 1.5)]
    yield _once("a queue", "what cannot begin waits, at most so long", asks, 24.0)
    asks = [g("long", 1.0, duration=6.0), g("lesser", 2.0, priority=0)]
    yield _once("covered", "a lesser one waits too long", asks)
    asks = [
        g("r", 1.0, duration=10.0, resume=True),
        g("u1", 3.0, priority=2),
        g("u2", 6.0, priority=3),
        g("u3", 6.1, priority=3),
    ]
    yield _once("cut again and again", "each remainder has a key of its own", asks, 24.0)
    asks = [g("close", 1.0), g("soon", 1.3, priority=9)]
    yield _once("no room", "nothing fits before something more important", asks)
    asks = [g("p1", 4.0, priority=2), g("p2", 9.0, priority=2)]
    yield _once(
        "asked amid what the models do",
        "all that is asked for goes before all that models write",
        asks,
        24.0,
        idle=True,
    )


def _stances(project: Project) -> Iterator[ScriptCase]:
    for layer in LAYERS:
        graph = project.graphs[layer]
        begin = next(
            (s for s in (graph.start, *graph.stances) if s is not None and graph.of(s, "stance")), None
        )
        if begin is None:
            continue
        lost = [s for s in graph.stances if s != begin and find_chain(graph, begin, s) is None]
        lost += [s for s in graph.stances if not graph.of(s, "stance") and s not in lost]
        for stance in lost[:2]:
            there = [a for a in graph.actions.values() if a.stance == stance or a.end_stance == stance]
            asks = [_ask("there", "stance", 1.0, layer=layer, stance=stance)]
            asks += [_ask(f"p{n}", "action", 2.0 + 3 * n, action=a.id) for n, a in enumerate(there[:2])]
            yield _once(
                f"{layer}: no way to {stance}", "what cannot be reached, or could not rest, is refused", asks
            )
        ways = {s: way for s in graph.stances if s != begin and (way := find_chain(graph, begin, s))}
        if not ways:
            continue
        far = max(ways, key=lambda s: len(ways[s]))
        asks = [
            _ask("there", "stance", 1.0, layer=layer, stance=far),
            _ask("again", "stance", 8.0, layer=layer, stance=far),
        ]
        asks += [_ask("back", "stance", 9.0, layer=layer, stance=begin)]
        asks += [
            _ask(f"hop{n}", "stance", 20.0 + 5 * n, layer=layer, stance=far if n % 2 == 0 else begin)
            for n in range(8)
        ]
        yield _once(
            f"{layer}: to a stance and back",
            "the shortest chain of transitions; already there",
            asks,
            64.0,
            alive=(False, True),
        )
        asks = [
            _ask("stay", "stance", 1.0, layer=layer, stance=far, stay=True),
            _ask("leave", "withdraw", 30.0, what="stay"),
        ]
        steps = (ScriptStep(0.0, 40.0, (asks[0],)), ScriptStep(20.0, 40.0, (asks[1],)))
        yield ScriptCase(
            f"{layer}: to stay", "the models do not leave a stance that was asked to stay", steps, idle=True
        )
        gesture = _some(project, layer, "gesture")
        if gesture:
            asks = [_ask("far", "stance", 1.0, layer=layer, stance=far)]
            asks += [_ask(f"u{n}", "gesture", 1.25 + 0.25 * n, layer=layer, priority=4) for n in range(2)]
            yield _once(f"{layer}: cut on the way to a stance", "what is cut does not go on", asks, alive=())
        asks = [_ask("c1", "change", 1.0, layer=layer), _ask("c2", "change", 6.0, layer=layer)]
        yield _once(f"{layer}: any other stance", "a transition drawn among those there are", asks)
        there = [a for a in _some(project, layer, "gesture", "fidget") if a.stance == far]
        if there:
            asks = [
                _ask("p", "action", 1.0, action=there[0].id),
                _ask("q", "action", 12.0, action=graph.of(begin, "stance")[0].id),
            ]
            yield _once(
                f"{layer}: an action of another stance",
                "transitions lead there first; playing a loop means to go there",
                asks,
                24.0,
            )
            hops: tuple[ScriptStep, ...] = (
                ScriptStep(0.0, 20.0, (_ask("p", "action", 1.0, action=there[0].id),)),
            )
            hops += (
                ScriptStep(1.2, 20.0, (_ask("u", "stance", layer=layer, stance=begin, priority=4),)),
                ScriptStep(3.0, 22.0),
            )
            yield ScriptCase(
                f"{layer}: a way that is interrupted", "something more important comes while on the way", hops
            )
        hop = _some(project, layer, "transition")[0]
        asks = [
            _ask("t", "action", 1.0, action=hop.id),
            _ask("t2", "action", 6.0, action=hop.name, layer=layer),
        ]
        yield _once(f"{layer}: a transition by name", "found by its id and by its name", asks)


def _refused(project: Project) -> Iterator[ScriptCase]:
    asks = [
        _ask("u1", "action", 1.0, action="no such action"),
        _ask("u2", "stance", 1.0, stance="no such stance"),
        _ask("u3", "gesture", 1.0, tags=["no such tag"]),
        _ask("u4", "say", 1.0, line="no such line"),
        _ask("u5", "say", 1.0),
        _ask("u6", "nod", 1.0, tags=["no such tag"]),
        _ask("u7", "gesture", 1.0, layer="body", limb="left", tags=["no such tag"]),
        _ask("u8", "withdraw", 1.0, what="nothing of that name"),
    ]
    yield _once("what cannot be had", "each is refused, and nothing else suffers", asks, 6.0, idle=True)
    layer: Layer = next((x for x in LAYERS if _some(project, x, "gesture")), "arms")
    asks = [
        _ask("past", "gesture", 1.0, layer=layer),
        _ask("nearly", "gesture", 9.5, layer=layer),
        _ask("now", "gesture", layer=layer),
    ]
    steps = (ScriptStep(0.0, 20.0), ScriptStep(10.0, 20.0, tuple(asks)))
    yield ScriptCase("asked in the past", "too late is past, a little late waits", steps, idle=True)
    yield ScriptCase("asked in the past, at rest", "no model plays meanwhile", steps)
    asks = [_ask("negative", "gesture", 0.0, layer=layer), _ask("beyond", "gesture", 60.0, layer=layer)]
    yield ScriptCase(
        "beyond the end",
        "what begins after the end waits for the plan to grow",
        (ScriptStep(0.0, 10.0, tuple(asks)), ScriptStep(5.0, 70.0)),
        times=(1.0, 60.5, 69.0),
    )


def _over_time(project: Project) -> Iterator[ScriptCase]:
    layer: Layer = next((x for x in ("arms", "head", "body") if _some(project, x, "gesture")), "arms")
    grow = tuple(ScriptStep(0.0 if n == 0 else n * 2.0, 10.0 + n * 2.0) for n in range(12))
    yield ScriptCase("a horizon that moves", "in many steps as in one", grow, idle=True)
    forget = tuple(ScriptStep(n * 3.0, 12.0 + n * 3.0, forget=max(0.0, n * 3.0 - 6.0)) for n in range(12))
    yield ScriptCase(
        "a past that is forgotten",
        "what is planned on stays as it would have been",
        forget,
        idle=True,
        times=(33.5, 35.0, 41.0, 44.0),
        alive=(True, False),
    )
    busy = [ScriptStep(0.0, 12.0)]
    for n in range(1, 25):
        asked = tuple(
            _ask(f"n{n}.{x}x", "gesture", layer=x, duration=0.5)
            for x in LAYERS
            if _some(project, x, "gesture")
        )
        busy.append(ScriptStep(n * 3.0, 12.0 + n * 3.0, asked, max(0.0, n * 3.0 - 1.0)))
    late = [
        _ask(f"z{n}{x}x", "gesture", 76.0 + 3 * n, layer=x, duration=0.5) for n in range(16) for x in LAYERS
    ]
    busy.append(
        ScriptStep(75.0, 130.0, tuple(ask for ask in late if _some(project, ask["layer"], "gesture")))
    )
    yield ScriptCase(
        "much that is forgotten",
        "counts, spacing and cooldown reach back over what is forgotten",
        tuple(busy),
        idle=True,
    )
    steps: tuple[ScriptStep, ...]
    asks: tuple[Ask, ...] = (
        _ask("keep", "gesture", 4.0, layer=layer),
        _ask("gone", "gesture", 9.0, layer=layer),
    )
    steps = (
        ScriptStep(0.0, 20.0, asks),
        ScriptStep(2.0, 20.0, (_ask("w", "withdraw", what="gone"),)),
        ScriptStep(4.6, 20.0, (_ask("v", "withdraw", what="keep"),)),
    )
    yield ScriptCase("withdrawn", "what has not begun is taken back; what has goes back to its stance", steps)
    steps = (ScriptStep(0.0, 20.0, asks), ScriptStep(2.0, 20.0, (_ask("w", "withdraw"),)))
    yield ScriptCase("all withdrawn", "with no name everything is taken back", steps, idle=True)
    steps = (ScriptStep(0.0, 20.0, asks), ScriptStep(2.0, 20.0, (_ask("keep", "gesture", 7.0, layer=layer),)))
    yield ScriptCase("asked again under the same id", "the later one counts", steps)
    asks = (_ask("long", "gesture", 1.0, layer=layer, duration=9.0, resume=True),)
    steps = (
        ScriptStep(0.0, 24.0, asks),
        ScriptStep(3.0, 24.0, (_ask("now", "gesture", layer=layer, priority=3),)),
        ScriptStep(6.0, 30.0),
    )
    yield ScriptCase("interrupted live", "the running action is never touched", steps)
    steps = (
        ScriptStep(0.0, 60.0),
        ScriptStep(2.0, 60.0, (_ask("m1", "mode", 5.0, mode="listening"),)),
        ScriptStep(3.0, 60.0, (_ask("m2", "mode", 25.0, mode="idle"),)),
        ScriptStep(20.0, 60.0, (_ask("s1", "say", 22.0, text="and so it went on for quite some time"),)),
        ScriptStep(30.0, 60.0, (_ask("w1", "withdraw", what="m2"),)),
    )
    yield ScriptCase(
        "modes asked for live", "who listens or idles gestures less than who talks", steps, idle=True
    )
