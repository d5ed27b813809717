"""Scripts of conformance for what happens exactly at a boundary: where `<` and `<=` part, at the times that a
plan of the project itself gives.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import floor
from typing import Any

from metagraph.engines.script_parts import Ask, ScriptCase, ScriptStep, ask, list_some_actions
from metagraph.engines.script_parts import make_case as _with_poses
from metagraph.graph.model import LAYERS, Action, Layer, Project
from metagraph.graph.requests import make_request
from metagraph.playback.plan import Cue, Plan
from metagraph.playback.planning.extend_performance import hear_asks

FITS = (-2e-6, -5e-7, 5e-7, 2e-6)  # seconds: either side of `cue_shapes.FITS`


def _just(seconds: float) -> tuple[float, ...]:
    """Return seconds by which to miss a time. It is met itself where it has few binary digits: not every
    language reads longer decimals to the last one.
    """
    return (*FITS, 0.0) if (seconds * 4096).is_integer() else FITS


def list_boundary_cases(project: Project) -> Iterator[ScriptCase]:
    """Yield the cases that suit a project."""
    for layer in LAYERS if _exact(project) else ():
        if list_some_actions(project, layer, "gesture"):
            for part in (_windows, _waits, _limits, _written, _extensions):
                yield from part(project, layer)
        yield from _cooldowns(project, layer)
    yield from _remembered(project)
    yield from _faces(project)
    yield from _forgotten(project)
    yield from _talked_over(project)
    yield from _read(project)


def _exact(project: Project) -> bool:
    """Whether frames have times that every language holds exactly: a boundary of others cannot be met."""
    played = {action.clip for layer in LAYERS for action in project.graphs[layer].actions.values()}
    return all((4096 / project.clips[clip].fps).is_integer() for clip in played)


def make_plan_case(
    name: str, about: str, asks: Sequence[Ask], end: float = 14.0, idle: bool = False
) -> ScriptCase:
    """Return a case of one step whose plan alone is compared."""
    return _with_poses(name, about, asks, end, idle=idle, alive=())


def _planned(project: Project, asks: Sequence[Ask], end: float = 20.0, idle: bool = False) -> Plan:
    return hear_asks(project, Plan(1, 0.0), 0.0, [make_request(dict(each)) for each in asks], end, {}, idle)


def _first(project: Project, layer: Layer) -> tuple[Action, Cue]:
    """Return a layer's first gesture, and how it plays when asked for at 1 s."""
    one = list_some_actions(project, layer, "gesture")[0]
    cues = _planned(project, [ask("a", "action", 1.0, action=one.id)]).layers[layer].cues
    return one, cues[-1]


def _windows(project: Project, layer: Layer) -> Iterator[ScriptCase]:
    """Windows of requests that touch, or leave as little as may be left."""
    shortest, wait = project.settings.shortest, project.settings.wait

    def g(ident: str, at: float, length: float, **more: Any) -> Ask:
        return ask(ident, "gesture", at, layer=layer, duration=length, **more)

    yield make_plan_case(
        f"{layer}: windows that touch",
        "one ends where the next begins: neither waits",
        [g("x", 1.0, 2.0), g("y", 3.0, 1.0), g("z", 4.0, 0.0), g("w", 4.0, 0.5)],
    )
    urgent = 1.0 + shortest
    for less in (0.0, 1 / 64):
        asks = [
            g("long", 1.0, 8.0, resume=True),
            g("urgent", urgent - less, 9.0 - urgent - shortest + 2 * less, priority=3),
        ]
        yield make_plan_case(
            f"{layer}: as short as may be left, less {less:g}",
            "before and after what interrupts",
            asks,
        )
    asks = [g("x", 1.0, 8.0), g("y", 9.0 - wait, 1.0), g("z", 9.0 - wait - 1 / 64, 1.0)]
    yield make_plan_case(f"{layer}: as long as may be waited", "in the meta plan", asks, 24.0)
    asks = [g("x", 1.0, 3.0), g("y", 1.0, 3.0, priority=2), g("z", 4.0, 2.0, priority=0, resume=True)]
    asks += [g("v", 4.0, 1.0, priority=0), g("u", 4.0, 1.0, priority=0), g("t", 6.0, 0.5, priority=2)]
    yield make_plan_case(f"{layer}: of the same start", "priority, then the id, decides", asks, 24.0)


def _waits(project: Project, layer: Layer) -> Iterator[ScriptCase]:
    """What waits for a running action exactly as long as it may, or ends when that does."""
    one, cue = _first(project, layer)
    ready = cue.end + project.settings.rest
    wait = project.settings.wait
    first = ask("a", "action", 1.0, action=one.id)
    for place, more in enumerate(_just(ready)):
        asks = [first, ask("b", "gesture", max(0.0, ready - wait + more), layer=layer)]
        yield make_plan_case(f"{layer}: waits as long as it may {place}", "for a running action", asks)
        start = 0.5 * (1.0 + ready)
        asks = [first, ask("b", "gesture", start, layer=layer, duration=ready - start + more)]
        yield make_plan_case(
            f"{layer}: a window over with the action before {place}", "it is covered, or not", asks
        )
        asks = [first, ask("b", "gesture", ready + more, layer=layer, duration=0.5 if more else 0.0)]
        yield make_plan_case(f"{layer}: asked for when it can begin {place}", "at that very moment", asks)
    late = ask("b", "gesture", max(0.0, ready - wait), layer=layer)
    later = ask("c", "gesture", max(0.0, ready - wait - 1 / 64), layer=layer)
    for name, asked in (("just", late), ("not", later)):
        steps = (ScriptStep(0.0, 20.0, (first,)), ScriptStep(cue.start + 0.25, 20.0, (asked,)))
        yield ScriptCase(f"{layer}: may {name} wait live", "for the action that runs", steps, alive=())


def _limits(project: Project, layer: Layer) -> Iterator[ScriptCase]:
    """Something more important that begins exactly when an action is over, or may be left."""
    for one in list_some_actions(project, layer, "gesture")[:3]:
        asks = [ask("a", "action", 1.0, action=one.id)]
        cues = _planned(project, asks).layers[layer].cues
        if not cues:
            continue
        ends = {"over": cues[-1].end}
        if one.timing.earliest_exit is not None:
            for place in range(4):
                both = [ask("a", "action", 1.0, action=one.id, hold=0.25 + 0.5 * place)]
                both += [ask("u", "gesture", 1.5 + 0.5 * place, layer=layer, priority=3)]
                yield make_plan_case(
                    f"{layer}: {one.name} held and left {place}", "before something else", both
                )
        if one.timing.earliest_exit is not None:
            left = cues[-1].start + one.timing.earliest_exit - cues[-1].entry + one.timing.blend_out
            ends["left"] = left
        for word, end in ends.items():
            for place, more in enumerate(_just(end)):
                both = [*asks, ask("u", "gesture", end + more, layer=layer, priority=3)]
                yield make_plan_case(
                    f"{layer}: {one.name} {word} {place}", "before something more important begins", both
                )


def _written(project: Project, layer: Layer) -> Iterator[ScriptCase]:
    """Requests that leave what a model wrote exactly as much as it needs, or touch it."""
    metas = [m for m in _planned(project, [], 20.0, True).layers[layer].metas if m.written]
    shortest = project.settings.shortest
    near = 1e-7
    for place, meta in enumerate(metas[:4:2]):
        about = "what was written is left the shortest"
        for word, more in (("less", -near), ("more", near)):
            asks = [ask("r", "fidget", meta.start + shortest + more, layer=layer, duration=0.5)]
            yield make_plan_case(
                f"{layer}: {about}, {word} {place}", "and no more", asks, meta.end + 4.0, idle=True
            )
        first = (floor(meta.start * 64) + 8) / 64  # a gap between requests of just the shortest, and less
        for word, less in (("just", 0.0), ("hardly", 1 / 64)):
            asks = [ask("r", "fidget", first - 0.5, layer=layer, duration=0.5)]
            asks += [ask("s", "fidget", first + shortest - less, layer=layer, duration=4.0)]
            yield make_plan_case(
                f"{layer}: a gap {word} long enough {place}", about, asks, meta.end + 4.0, idle=True
            )
        asks = [ask("r", "fidget", meta.end + near, layer=layer, duration=0.5)]
        start = max(0.0, meta.start - 0.5)
        asks += [ask("s", "fidget", start, layer=layer, duration=meta.start - start - near)]
        about = "what was written is not touched"
        yield make_plan_case(f"{layer}: {about} {place}", "before and after", asks, meta.end + 4.0, idle=True)


def _extensions(project: Project, layer: Layer) -> Iterator[ScriptCase]:
    """A plan that grows at the very moment something begins or ends."""
    gestures = list_some_actions(project, layer, "gesture")
    asks = tuple(ask(f"g{n}", "action", 1.0 + 4 * n, action=gestures[n % len(gestures)].id) for n in range(3))
    plan = _planned(project, asks)
    of = plan.layers[layer]
    moments = [c.start for c in of.cues[1:]] + [m.start for m in of.metas[1:]]
    moments += (
        [r.fade_start for r in of.rests[1:3]]
        + [r.start for r in of.rests[1:3]]
        + [c.end for c in of.cues[:2]]
    )
    exact = sorted({x for x in moments if x > 0 and (x * 4096).is_integer()})
    for place, now in enumerate(exact[:5]):
        steps = (
            ScriptStep(0.0, 20.0, asks),
            ScriptStep(now, 20.0, (ask("new", "gesture", layer=layer, priority=2),)),
            ScriptStep(now, 24.0, (ask("w", "withdraw", what="g1"),)),
        )
        yield ScriptCase(
            f"{layer}: heard at a moment that tells {place}",
            "what has begun stays",
            steps,
            alive=(),
        )
        growing = (ScriptStep(0.0, now), ScriptStep(now, now + 8.0, forget=now))
        yield ScriptCase(
            f"{layer}: ends and is forgotten at such a moment {place}",
            "as it would have been",
            growing,
            idle=True,
        )


def _cooldowns(project: Project, layer: Layer) -> Iterator[ScriptCase]:
    """What may be drawn again exactly when its cooldown is over."""
    graph = project.graphs[layer]
    for kind in ("gesture", "fidget"):
        found = [a for a in graph.actions.values() if a.kind == kind and a.stance == graph.start]
        for one in [
            a for a in found if a.cooldown > 0 and sum(set(b.tags) >= set(a.tags) for b in found) == 1
        ][:2]:
            first = ask("a", kind, 1.0, layer=layer, tags=list(one.tags))
            cues = _planned(project, [first]).layers[layer].cues
            if not cues:
                continue
            again = cues[-1].end + one.cooldown
            for place, more in enumerate(_just(again)):
                asks = [first, ask("b", kind, again + more, layer=layer, tags=list(one.tags))]
                yield make_plan_case(
                    f"{layer}: {one.name} has cooled down {place}", "or nearly", asks, again + 6.0
                )


def _remembered(project: Project) -> Iterator[ScriptCase]:
    """Uses that are exactly as old as the settings' memory, and draws as far back as spacing looks."""
    memory = project.settings.memory
    for layer in LAYERS:
        if len(list_some_actions(project, layer, "gesture")) < 2:
            continue
        asks = [ask(f"g{n}", "gesture", 0.5 + 4.0 * n, layer=layer) for n in range(16)]
        yield make_plan_case(
            f"{layer}: sixteen, one by one",
            "what came long before counts as it should",
            asks,
            165.0,
        )
        if memory > 0:
            asks = [ask(f"g{n}", "gesture", 1.0 + 0.5 * memory * n, layer=layer) for n in range(24)]
            about = "uses at the edge of the memory"
            yield make_plan_case(f"{layer}: as old as is remembered", about, asks, 13.0 * memory + 5.0)


def _faces(project: Project) -> Iterator[ScriptCase]:
    """Texts whose letters, marks and pauses tell, and looks as far as head, eyes and lids go."""
    if not project.life.on:
        return
    texts = (
        "a - b – c — d… e, f; g: h! (i) j? k. l m",
        "Accommodate a bee, a bookkeeper's fee; ß ñ ı 한국 नमस्ते",
        "et c\u0327a n\u0303o ’tis o'clock — “quoted”",
    )
    asks = [ask(f"t{n}", "say", 1.0 + 5.0 * n, text=text, duration=4.9) for n, text in enumerate(texts)] + [
        ask("again", "say", 5.95, text="ooo mmm", duration=0.1, priority=0)
    ]
    times = tuple(round(1.05 + 0.31 * n, 3) for n in range(48))
    yield _with_poses(
        "texts with marks", "shapes of letters, pauses of marks", asks, times=times, alive=(True,)
    )
    looks = (
        [0.1, -2.0, 0.3],
        [0.0, 6.0, 0.4],
        [3.0, 1.5, -0.5],
        [-3.0, 1.5, -0.5],
        [0.3, 1.5, -2.0],
        [0.0, 1.4, 3.0],
    )
    asks = [ask(f"k{n}", "look", 1.0 + 2.0 * n, to=to, strict=True) for n, to in enumerate(looks)]
    times = tuple(round(1.06 + 2.0 * n + more, 3) for n in range(len(looks)) for more in (0.0, 0.3, 1.6))
    yield _with_poses(
        "looks as far as can be", "limits of head, eyes and lids", asks, times=times, alive=(True,)
    )


def _forgotten(project: Project) -> Iterator[ScriptCase]:
    """Looks, words and modes that are over, just over, or not yet when the past is forgotten."""
    if not project.life.on:
        return
    asks: list[Ask] = []
    for n in range(12):
        to = [0.5 * (-1) ** n, 1.2 + 0.05 * n, 1.0]
        asks.append(ask(f"k{n}", "look", 1.0 + 1.5 * n, to=to, duration=0.75, strict=n % 3 == 0))
        asks.append(ask(f"t{n}", "say", 1.25 + 1.5 * n, text="So it is, then.", duration=1.5))
    asks += [ask("m1", "mode", 4.0, mode="talking"), ask("m2", "mode", 9.0, mode="listening")]
    for place, seconds in enumerate((4.0, 5.5, 9.25, 14.0)):
        steps = (
            ScriptStep(0.0, 12.0, tuple(asks)),
            ScriptStep(seconds, 20.0, forget=seconds),
            ScriptStep(seconds + 0.5, 24.0, forget=seconds + 0.5),
        )
        times = (seconds + 0.55, seconds + 1.3)
        about = "what still shows is kept"
        yield ScriptCase(
            f"looks and words that are forgotten {place}", about, steps, times=times, alive=(True,)
        )
        yield ScriptCase(f"looks and words, just forgotten {place}", about, steps[:2], alive=(), idle=True)


def _talked_over(project: Project) -> Iterator[ScriptCase]:
    """Lines that begin together or interrupt others, and what is taken back at the moment it begins."""
    if not project.life.on:
        return

    def t(ident: str, at: float, length: float, priority: int) -> Ask:
        text = "Oh, how so? Mamma mia."
        return ask(ident, "say", at, text=text, duration=length, priority=priority)

    asks = [t("a", 1.0, 3.0, 2), t("b", 2.0, 4.0, 1), t("c", 3.0, 1.5, 3), t("d", 6.0, 2.0, 1)]
    asks += [t("e", 6.0, 1.0, 1), t("f", 9.0, 2.0, 2), t("g", 9.0, 3.0, 1), t("h", 10.5, 1.0, 2)]
    times = tuple(round(1.13 + 0.37 * n, 3) for n in range(30))
    yield _with_poses("lines that interrupt lines", "who is heard", asks, times=times, alive=(True,))
    now = 4.0 - project.settings.lookahead
    asks = [
        ask("k", "look", 4.0, to=[0.8, 1.2, 0.9]),
        t("a", 4.0, 2.0, 1),
        ask("m", "mode", 4.0, mode="talking"),
        ask("p", "place", 4.0, name="user", point=[1.5, 1.0, 0.5]),
        ask("u", "look", 5.0, to="user"),
    ]
    steps = (
        ScriptStep(0.0, 12.0, (*asks, t("b", 3.5, 4.0, 0), ask("n", "look", 3.5, to="ahead", duration=4.0))),
        ScriptStep(now, 12.0, tuple(ask(f"w{x}", "withdraw", what=x) for x in "kambnp")),
    )
    times = (3.7, 3.95, 4.05, 4.3, 5.1, 6.2)
    yield ScriptCase("taken back as it begins", "it never was", steps, times=times, alive=(True,))


def _read(project: Project) -> Iterator[ScriptCase]:
    """Values at the ends of the ranges that requests have, and just beyond."""
    layer = next((x for x in LAYERS if list_some_actions(project, x, "gesture")), None)
    if layer is None:
        return
    values: list[dict[str, Any]] = [
        {"priority": 1000},
        {"priority": 1001},
        {"priority": -1000},
        {"priority": -1001},
        {"hold": 600},
        {"hold": 600.5},
        {"hold": -0.5},
        {"duration": 0},
        {"duration": -1},
        {"stroke": 1e6},
        {"stroke": 1e6 + 1},
        {"tags": ["a" * 200]},
        {"tags": ["a" * 201]},
        {"tags": [""]},
        {"tags": "word"},
        {"limb": "none"},
        {"prepare": 1},
        {"strange": 1},
        {"told": -1},
    ]
    asks = [ask(f"v{n}", "gesture", 1e-3 * n, layer=layer, **more) for n, more in enumerate(values)]
    long = 200
    asks += [
        ask("i" * long, "gesture", 1.0, layer=layer),
        ask("j" * (long + 1), "gesture", 1.0, layer=layer),
        ask("a0", "action", 2.0, action=""),
        ask("a1", "action", 2.0, action="b" * long),
        ask("a2", "action", 2.0, action="b" * (long + 1)),
        ask("l0", "look", 0.0, to=[1e6, 0, 0], duration=0.5),
        ask("l1", "look", 0.0, to=[1e6 + 1, 0, 0]),
        ask("l2", "look", 0.0, to=[0, 0]),
        ask("l3", "look", 0.5, to="ahead", amount=1),
        ask("l4", "look", 0.5, amount=1.5),
        ask("l5", "look", 0.5, amount=-0.5),
        ask("l6", "look", 1.0, amount=0),
        ask("m0", "mode", 3.0, mode="none"),
        ask("s0", "say", 3.0, line=1.5),
        ask("s1", "say", 3.0, line=""),
        ask("s2", "say", 3.0, text="x" * 20001),
        {"do": "nothing", "id": "n"},
        {"id": "none"},
        ask("z", "gesture", 1e6, layer=layer),
    ]
    yield make_plan_case("values at the ends of their ranges", "what is read, what is refused", asks, 6.0)
