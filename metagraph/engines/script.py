"""What conformance asks: scripts of requests over time for whatever a project has, one for each rule of
planner and life.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations
from random import Random
from typing import Any

from metagraph.engines.script_parts import Ask, Case, ScriptStep
from metagraph.engines.script_parts import ask as _ask
from metagraph.engines.script_parts import once as _once
from metagraph.engines.script_parts import some as _some
from metagraph.graph.expand import chain
from metagraph.graph.model import LAYERS, Layer, Project


def cases(project: Project) -> Iterator[Case]:
    """Yield the cases that suit a project."""
    for part in (
        _alone,
        _layers,
        _requests,
        _timely,
        _conflicts,
        _stances,
        _refused,
        _over_time,
        _life,
        _chatter,
    ):
        yield from part(project)


def _alone(project: Project) -> Iterator[Case]:
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


def _layers(project: Project) -> Iterator[Case]:
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


def _requests(project: Project) -> Iterator[Case]:
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


def _timely(project: Project) -> Iterator[Case]:
    """What says how late it may come."""
    for layer in LAYERS:
        gestures = _some(project, layer, "gesture")
        if not gestures:
            continue
        one, own = gestures[0], dict[str, Any](layer=layer, late=0.0)
        tags = sorted({t for a in gestures for t in a.tags})
        many = next((a.tags for a in gestures if len(a.tags) > 1), one.tags)
        asks = [_ask(f"s{n}", "gesture", stroke=2.0 + 0.8 * n, **own) for n in range(8)]
        asks += [
            _ask(f"t{n}", "gesture", stroke=11.0 + 1.3 * n, tags=[tags[n % len(tags)]], layer=layer, late=0.3)
            for n in range(6 if tags else 0)
        ]
        asks += [
            _ask(f"one{n}", "gesture", stroke=21.0 + 0.1 * n, tags=[tag], **own) for n, tag in enumerate(many)
        ]
        asks += [
            _ask("room", "gesture", stroke=24.0, **own),
            _ask("next", "action", action=one.id, stroke=25.4, late=0.0),
            _ask("held", "gesture", stroke=28.0, hold=1.0, **own),
            _ask("after", "gesture", stroke=29.9, layer=layer, late=2.0),
        ]
        about = "strokes on time or not at all, shared ones, and what leaves room for the next"
        yield _once(f"{layer}: strokes that may not be late", about, asks, 36.0)
        now = [
            _ask("n0", "gesture", stroke=6.6, **own),
            _ask("n1", "gesture", stroke=7.8, layer=layer, late=0.5),
        ]
        more = [_ask("n2", "gesture", stroke=8.9, **own), _ask("n3", "gesture", stroke=9.0, **own)]
        steps = (
            ScriptStep(0.0, 14.0, (_ask("b", "gesture", 4.9, layer=layer),)),
            ScriptStep(5.6, 14.0, tuple(now)),
            ScriptStep(7.9, 16.0, tuple(more)),
            ScriptStep(8.95, 20.0, (_ask("n4", "gesture", 8.9, **own), _ask("n5", "gesture", 9.5, **own))),
            ScriptStep(12.0, 24.0, (_ask("n6", "gesture", stroke=12.7, **own),), forget=9.0),
        )
        about = "what runs is left for what may not be late"
        yield Case(f"{layer}: strokes that become known late", about, steps, idle=True)
        asks = [
            _ask("a", "gesture", stroke=4.0, **own),
            _ask("b", "gesture", stroke=4.5, layer=layer, late=4.0),
        ]
        asks += [
            _ask(f"c{n}", "gesture", stroke=12.0 + 0.2 * n, tags=[t], **own) for n, t in enumerate(many[:2])
        ]
        on = [ScriptStep(now, now + 18.0) for now in (1.0, 3.0, 12.0, 13.0)]
        about = "lateness is told once, and what serves two is not played twice"
        yield Case(f"{layer}: strokes that are planned on", about, (ScriptStep(0.0, 20.0, tuple(asks)), *on))
    for layer in LAYERS:
        graph = project.graphs[layer]
        gestures, late = _some(project, layer, "gesture"), {"late": 0.4}
        if not gestures:
            continue
        other = next((a for a in gestures if a.stance != gestures[0].stance), None)
        asks = [
            _ask("plays", "action", 1.0, action=gestures[0].id),
            _ask("waits", "gesture", 1.2, layer=layer, late=0.1),
            _ask("fidget", "fidget", 1.4, layer=layer, **late),
            _ask("soon", "action", 7.0, action=gestures[0].id),
            _ask("change", "change", 7.3, layer=layer, **late),
        ]
        asks += [_ask("far", "action", 13.0, action=other.id, **late)] if other else []
        asks += [
            _ask(f"go{n}", "stance", 18.0 + 0.2 * n, stance=ident, **late)
            for n, ident in enumerate(list(graph.stances)[:3])
        ]
        asks += [_ask("nod", "nod", 18.1, **late), _ask("shake", "shake", 18.3, **late)]
        about = "of those without a stroke the start counts; transitions on the way take time"
        yield _once(f"{layer}: starts that may not be late", about, asks, 26.0)


def _conflicts(project: Project) -> Iterator[Case]:
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


def _stances(project: Project) -> Iterator[Case]:
    for layer in LAYERS:
        graph = project.graphs[layer]
        begin = next(
            (s for s in (graph.start, *graph.stances) if s is not None and graph.of(s, "stance")), None
        )
        if begin is None:
            continue
        lost = [s for s in graph.stances if s != begin and chain(graph, begin, s) is None]
        lost += [s for s in graph.stances if not graph.of(s, "stance") and s not in lost]
        for stance in lost[:2]:
            there = [a for a in graph.actions.values() if a.stance == stance or a.end_stance == stance]
            asks = [_ask("there", "stance", 1.0, layer=layer, stance=stance)]
            asks += [_ask(f"p{n}", "action", 2.0 + 3 * n, action=a.id) for n, a in enumerate(there[:2])]
            yield _once(
                f"{layer}: no way to {stance}", "what cannot be reached, or could not rest, is refused", asks
            )
        ways = {s: way for s in graph.stances if s != begin and (way := chain(graph, begin, s))}
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
        yield Case(
            f"{layer}: to stay", "the models do not leave a stance that was asked to stay", steps, idle=True
        )
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
            yield Case(
                f"{layer}: a way that is interrupted", "something more important comes while on the way", hops
            )
        hop = _some(project, layer, "transition")[0]
        asks = [
            _ask("t", "action", 1.0, action=hop.id),
            _ask("t2", "action", 6.0, action=hop.name, layer=layer),
        ]
        yield _once(f"{layer}: a transition by name", "found by its id and by its name", asks)


def _refused(project: Project) -> Iterator[Case]:
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
    yield Case("asked in the past", "too late is past, a little late waits", steps, idle=True)
    yield Case("asked in the past, at rest", "no model plays meanwhile", steps)
    asks = [_ask("negative", "gesture", 0.0, layer=layer), _ask("beyond", "gesture", 60.0, layer=layer)]
    yield Case(
        "beyond the end",
        "what begins after the end waits for the plan to grow",
        (ScriptStep(0.0, 10.0, tuple(asks)), ScriptStep(5.0, 70.0)),
        times=(1.0, 60.5, 69.0),
    )


def _over_time(project: Project) -> Iterator[Case]:
    layer: Layer = next((x for x in ("arms", "head", "body") if _some(project, x, "gesture")), "arms")
    grow = tuple(ScriptStep(0.0 if n == 0 else n * 2.0, 10.0 + n * 2.0) for n in range(12))
    yield Case("a horizon that moves", "in many steps as in one", grow, idle=True)
    forget = tuple(ScriptStep(n * 3.0, 12.0 + n * 3.0, forget=max(0.0, n * 3.0 - 6.0)) for n in range(12))
    yield Case(
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
    yield Case(
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
    yield Case("withdrawn", "what has not begun is taken back; what has plays on", steps)
    steps = (ScriptStep(0.0, 20.0, asks), ScriptStep(2.0, 20.0, (_ask("w", "withdraw"),)))
    yield Case("all withdrawn", "with no name everything is taken back", steps, idle=True)
    steps = (ScriptStep(0.0, 20.0, asks), ScriptStep(2.0, 20.0, (_ask("keep", "gesture", 7.0, layer=layer),)))
    yield Case("asked again under the same id", "the later one counts", steps)
    asks = (_ask("long", "gesture", 1.0, layer=layer, duration=9.0, resume=True),)
    steps = (
        ScriptStep(0.0, 24.0, asks),
        ScriptStep(3.0, 24.0, (_ask("now", "gesture", layer=layer, priority=3),)),
        ScriptStep(6.0, 30.0),
    )
    yield Case("interrupted live", "the running action is never touched", steps)
    steps = (
        ScriptStep(0.0, 60.0),
        ScriptStep(2.0, 60.0, (_ask("m1", "mode", 5.0, mode="listening"),)),
        ScriptStep(3.0, 60.0, (_ask("m2", "mode", 25.0, mode="idle"),)),
        ScriptStep(20.0, 60.0, (_ask("s1", "say", 22.0, text="and so it went on for quite some time"),)),
        ScriptStep(30.0, 60.0, (_ask("w1", "withdraw", what="m2"),)),
    )
    yield Case("modes asked for live", "who listens or idles gestures less than who talks", steps, idle=True)


def _timed() -> Iterator[Case]:
    """Yield lines whose words and mouth shapes are told with their times."""
    words = [["Hello", 0.1, 0.45], ["there", 1.5, 1.9], {"word": "friend", "start": 1.9, "end": 2.4}]
    polly = [
        {"time": 0, "type": "sentence", "start": 0, "end": 7, "value": "Mapped."},
        {"time": 6, "type": "word", "start": 0, "end": 6, "value": "Mapped"},
        {"time": 6, "type": "viseme", "value": "p"},
        {"time": 90, "type": "viseme", "value": "a"},
        {"time": 210, "type": "viseme", "value": "p"},
        {"time": 300, "type": "viseme", "value": "t"},
        {"time": 380, "type": "viseme", "value": "sil"},
    ]
    azure = [
        {"audioOffset": 500_000 + 1_100_000 * n, "visemeId": id} for n, id in enumerate((21, 2, 18, 7, 0))
    ]
    shapes = [[0.0, "ou", 0.7], [0.2, "PP"], [0.3, "oh"], [0.6, "sil"]]
    frames = [{"time": n / 30, "weights": {"jawOpen": 0.02 * n, "mouthFunnel": 0.3}} for n in range(40)]
    asks = [
        _ask("w1", "say", 1.0, words=words),
        _ask("w2", "say", 5.0, text="Mapped.", visemes=polly),
        _ask("w3", "say", 6.0, visemes=azure, duration=1.0),
        _ask("w4", "say", 8.0, visemes=frames, set="arkit"),
        _ask("w5", "say", 10.0, visemes=shapes, words=words),
        _ask("w6", "say", 12.5, words=[["cut", 0.0, 1.0], ["short", 1.2]]),
        _ask("w7", "say", 13.2, text="by this"),
        _ask("r1", "say", 13.0, visemes=[[0.0, "aa"], [0.1, "nothing"]]),
        _ask("r2", "say", 13.0, visemes=[[0.5, "aa"], [0.1, "PP"]]),
        _ask("r3", "say", 13.0, words=[["late", 0.0, 3.0]], duration=1.0),
        _ask("r4", "say", 13.0, words=[["back", 1.0, 0.5]]),
        _ask("r5", "say", 13.0, words=[["only"]]),
    ]  # fmt: skip
    yield _once(
        "words and shapes with their times",
        "the mouth follows them and is shut between; what cannot be read is refused",
        asks,
        16.0,
        times=(
            1.2,
            1.35,
            2.0,
            2.7,
            3.2,
            5.05,
            5.15,
            5.25,
            6.1,
            6.2,
            6.4,
            8.7,
            9.1,
            10.1,
            10.25,
            10.4,
            12.9,
            13.25,
        ),
        alive=(False, True),
    )
    steps = (
        ScriptStep(0.0, 12.0, (_ask("s", "say", 1.0, words=words[:1]),)),
        ScriptStep(1.3, 12.0, (_ask("s", "say", words=words[1:]),)),
        ScriptStep(2.2, 12.0, (_ask("s", "say", words=[*words, ["again", 2.6, 3.2]]),)),
        ScriptStep(4.0, 12.0, (_ask("s", "say", words=[["later", 3.0, 3.9], ["still", 4.0]]),), forget=3.5),
        ScriptStep(5.0, 12.0, (_ask("v", "say", visemes=[[0.0, "aa"], [0.3, "PP"], [0.5, "O"]]),)),
        ScriptStep(5.3, 12.0, (_ask("v", "say", visemes=[[0.6, "E"], [0.9, "sil"]]),)),
        ScriptStep(6.0, 12.0, (_ask("x", "withdraw", what="v"),)),
        ScriptStep(6.2, 12.0, (_ask("n", "say", 7.0, words=[["told", 0.1, 0.4]]),)),
        ScriptStep(6.4, 12.0, (_ask("n", "say", 7.0, words=[["beforehand", 0.5, 1.0]]),)),
    )
    yield Case(
        "a line that is added to",
        "what is said of it stands, what comes later is added",
        steps,
        times=(3.6, 3.9, 4.15, 4.3, 4.6, 4.9, 5.2, 5.45, 5.6, 5.75, 5.95, 6.1, 6.3, 7.2, 7.7),
        alive=(False, True),
    )


def _life(project: Project) -> Iterator[Case]:
    if not project.life.on:
        return
    both, times = (True,), (0.5, 1.05, 1.3, 2.2, 3.6, 5.15, 7.9, 11.0)
    point = [0.8, 1.4, 0.9]
    asks = [
        _ask("l1", "look", 1.0, to=point, duration=2.0),
        _ask("l2", "look", 5.0, to="ahead", duration=1.5),
        _ask("l3", "look", 7.0, to=[-1.0, 0.6, 0.2], amount=0.5),
    ]
    yield _once(
        "looks",
        "eyes first, the head after; back when a look ends",
        asks,
        idle=False,
        times=times,
        alive=both,
    )
    near = [
        _ask("l4", "look", 1.0, to=[0.06, 1.58, 0.2]),
        _ask("l5", "look", 4.0, to=[0.0, 3.0, 0.4], duration=2.0),
    ]
    yield _once(
        "something near",
        "what is nearer than a hand is looked at as if it were farther",
        near,
        times=times,
        alive=both,
    )
    asks = [
        _ask("s1", "look", 1.0, to="thing", strict=True),
        _ask("p1", "place", 0.0, name="thing", point=[0.5, 1.0, 1.0]),
    ]
    asks += [
        _ask(f"m{n}", "place", 2.0 + 0.25 * n, name="thing", point=[0.5 - 0.1 * n, 1.0 + 0.05 * n, 1.0])
        for n in range(8)
    ]
    asks += [_ask("s2", "look", 6.0, to=[0.0, 1.5, -2.0], priority=0), _ask("s3", "look", 8.0, to="user")]
    yield _once(
        "a thing that moves",
        "strict looks do not avert; the gaze follows a named point",
        asks,
        times=times,
        alive=both,
    )
    asks = [
        _ask("b1", "blink", 1.0),
        _ask("b2", "blink", 1.05),
        _ask("m1", "mode", 2.0, mode="listening"),
        _ask("m2", "mode", 8.0, mode="talking"),
        _ask("m3", "mode", 11.0, mode=None),
    ]
    yield _once(
        "blinks and modes",
        "blinks asked for; modes change rates",
        asks,
        60.0,
        times=(0.9, 1.03, 1.1, 9.0, 33.3),
        alive=both,
    )
    asks = [
        _ask("t1", "say", 1.0, text="Hello there, nice to see you!"),
        _ask("t2", "say", 4.0, text="Größe, naïve Straße: 42", duration=2.0),
    ]
    asks += [
        _ask("t3", "say", 5.0, text="This interrupts it."),
        _ask("t4", "say", 9.0, text="日本 Ещё καλημέρα", priority=2),
        _ask("t5", "say", 9.5, text="not said", priority=1),
    ]
    yield _once(
        "words that are said",
        "mouth shapes from letters; what interrupts, what is not said",
        asks,
        times=(1.2, 1.5, 2.0, 4.7, 5.3, 9.3, 9.8, 10.4),
        alive=both,
    )
    yield from _timed()
    long = (
        "This is a rather long sentence, which goes on and on, so that many of its syllables are "
        "stressed, and nobody stops it for a while."
    )
    asks = [
        _ask("long", "say", 1.0, text=long),
        _ask("cut", "say", 14.0, text="Nobody hears the end of this one, ever, at all."),
    ]
    steps = (ScriptStep(0.0, 24.0, tuple(asks)), ScriptStep(15.0, 24.0, (_ask("w", "withdraw", what="cut"),)))
    yield Case(
        "stressed syllables",
        "blinks on them; a mouth that is cut short closes",
        steps,
        times=(2.3, 5.1, 8.7, 15.11, 15.15, 15.2),
        alive=both,
    )
    said = list(project.lines)[:2]
    if said:
        asks = [_ask(f"line{n}", "say", 1.0 + 6 * n, line=line) for n, line in enumerate(said)] + [
            _ask("bare", "say", 14.0, line=said[0], gestures=False)
        ]
        yield _once(
            "lines",
            "their sound's mouth shapes and their own requests",
            asks,
            24.0,
            times=(1.3, 1.9, 2.6, 7.4, 14.5, 15.2),
            alive=both,
        )
    if any(a.kind == "gesture" for a in project.graphs["head"].actions.values()):
        asks = [_ask("n1", "nod", 1.0), _ask("n2", "shake", 5.0), _ask("n3", "nod", 9.0, priority=2)]
        yield _once("nods", "gestures of the head tagged so, or called so", asks, alive=both)
    yield _once(
        "two minutes",
        "what is drawn goes on being drawn",
        [],
        120.0,
        idle=True,
        times=(61.3, 99.9, 119.5),
        alive=both,
    )


def _chatter(project: Project) -> Iterator[Case]:
    for seed in (1, 2, 3):
        chance = Random(seed)
        now, steps = 0.0, []
        for n in range(24):
            asks = tuple(
                _random(project, chance, f"r{n}.{k}x", now) for k in range(chance.choice((0, 1, 1, 2)))
            )
            forget = max(0.0, now - 12.0) if n % 6 == 5 else None
            steps.append(ScriptStep(round(now, 3), round(now + 14.0, 3), asks, forget))
            now += chance.choice((0.016, 0.2, 1.0, 2.5))
        last = steps[-1].now
        times = tuple(round(last + x, 3) for x in (-4.0, -1.7, 0.1, 0.9, 3.3, 8.0))
        yield Case(
            f"chatter {seed}",
            "asked this and that while it plays",
            tuple(steps),
            seed,
            True,
            times=times,
            alive=(True, False),
        )


def _random(project: Project, chance: Random, ident: str, now: float) -> Ask:
    layer: Layer = chance.choice(LAYERS)
    graph = project.graphs[layer]
    at = None if chance.random() < 0.4 else round(now + chance.uniform(-1.0, 6.0), 3)
    at = None if at is not None and at < 0 else at
    more: dict[str, Any] = {"priority": chance.choice((1, 1, 1, 2, 3))}
    match chance.choice(
        ("gesture", "gesture", "fidget", "stance", "action", "change", "look", "say", "blink", "mode")
    ):
        case "gesture":
            more |= {"layer": layer, "resume": chance.random() < 0.3}
            if chance.random() < 0.3:
                more["duration"] = round(chance.uniform(0.2, 5.0), 2)
            if chance.random() < 0.3:
                more["stroke"] = round(now + chance.uniform(0.0, 4.0), 2)
            if chance.random() < 0.3:
                more["hold"] = round(chance.uniform(0.0, 2.0), 2)
            return _ask(ident, "gesture", at, **more)
        case "fidget":
            return _ask(ident, "fidget", at, layer=layer, **more)
        case "stance" if graph.stances:
            return _ask(
                ident,
                "stance",
                at,
                layer=layer,
                stance=chance.choice([*graph.stances]),
                stay=chance.random() < 0.3,
                **more,
            )
        case "action" if graph.actions:
            return _ask(ident, "action", at, action=chance.choice([*graph.actions]), **more)
        case "look":
            return _ask(
                ident,
                "look",
                at,
                to=chance.choice(("user", "ahead", [0.4, 1.2, 0.8])),
                duration=chance.choice((None, 1.5)),
                **more,
            )
        case "say":
            return _ask(
                ident,
                "say",
                at,
                text=chance.choice(("Well, yes.", "I really do not think so at all.", "Hm")),
                **more,
            )
        case "blink":
            return _ask(ident, "blink", at)
        case "mode":
            return _ask(ident, "mode", at, mode=chance.choice(("idle", "listening", "talking", None)))
    return _ask(ident, "change", at, layer=layer, **more)
