"""Scripts of conformance in which requests of every kind crowd together by chance, all at quarters of a
second, so that many meet each other's boundaries exactly; only their plans are compared.
"""

from __future__ import annotations

from collections.abc import Iterator
from random import Random
from typing import Any

from metagraph.engines.script_parts import Ask, ScriptCase, ScriptStep, ask
from metagraph.graph.model import LAYERS, Layer, Project

SEEDS = range(1, 49)
MOODS = ("happy", "sad", "angry", "calm", "excited", "tired", "afraid", [0.5, -0.75], [-0.25, 0.5])
MODES = ("idle", "listening", "talking", "thinking", "reacting", None)
TEXTS = ("Well, yes.", "I really do not think so. Do you?", "Hm", "No! Never, and not today; why would I?")


def list_crowd_cases(project: Project, seeds: range = SEEDS) -> Iterator[ScriptCase]:
    """Yield cases of crowds of requests, the models on in every other one."""
    for seed in seeds:
        chance = Random(1000 + seed)
        now, steps = 0.0, []
        known: list[Ask] = []
        for n in range(10):
            asks = []
            for k in range(chance.choice((0, 1, 2, 4))):
                one = _any(project, chance, f"r{n}.{k}", now, known)
                known.append(one)
                asks.append(one)
            if chance.random() < 0.4 and known:
                asks.append(_again(project, chance, now, known))
            forget = max(0.0, now - chance.choice((0.0, 1.0, 6.0))) if n % 3 == 2 else None
            steps.append(ScriptStep(now, now + 12.0, tuple(asks), forget))
            now += chance.choice((0.25, 0.5, 1.0, 2.5))
        stances: dict[Layer, str] = {}
        for layer in LAYERS if seed % 4 == 3 else ():
            if project.graphs[layer].stances:
                stances[layer] = chance.choice([*project.graphs[layer].stances])
        watched = (now + 1.0, now + 4.0) if seed % 3 == 0 else None
        yield ScriptCase(
            f"crowd {seed}",
            "every request and all at once",
            tuple(steps),
            seed,
            seed % 2 == 0,
            stances,
            alive=(),
            watched=watched,
        )
    for seed in range(1, 5):
        yield _evening(Random(seed), seed)


def _evening(chance: Random, seed: int) -> ScriptCase:
    """Return a case of some minutes in which modes and moods change and little else is asked."""
    asks: list[Ask] = []
    for n in range(14):
        at = 20.0 * n + _quarters(chance, 0.0, 12.0)
        asks.append(ask(f"m{n}", "mode", at, mode=chance.choice(MODES[:5])))
        if n % 3 == 1:
            asks.append(ask(f"f{n}", "mood", at + 2.0, mood=chance.choice(MOODS), duration=30.0))
        if n % 4 == 2:
            asks.append(ask(f"g{n}", "gesture", at + 6.0, layer=chance.choice(LAYERS)))
        if n % 5 == 3:
            asks.append(ask(f"c{n}", "change", at + 8.0, layer=chance.choice(LAYERS)))
    step = ScriptStep(0.0, 300.0, tuple(asks))
    return ScriptCase(
        f"an evening {seed}", "modes and moods over minutes", (step,), 40 + seed, True, alive=()
    )


def _quarters(chance: Random, low: float, high: float) -> float:
    return round(chance.uniform(low, high) * 4) / 4


def _again(project: Project, chance: Random, now: float, known: list[Ask]) -> Ask:
    """Return what was asked before under the same id: as it was, or with a part of another of its kind."""
    old = chance.choice(known)
    if chance.random() < 0.25:
        return old
    for _ in range(40):
        new = _any(project, chance, old["id"], now, known)
        if new["do"] == old["do"]:
            fields = sorted({*old, *new} - {"do", "id"})
            changed = chance.choice(fields) if fields else "at"
            out = {name: value for name, value in old.items() if name != changed}
            return {**out, changed: new[changed]} if changed in new else out
    return old


def _any(project: Project, chance: Random, ident: str, now: float, known: list[Ask]) -> Ask:
    layer: Layer = chance.choice(LAYERS)
    graph = project.graphs[layer]
    at = None if chance.random() < 0.3 else max(0.0, now + _quarters(chance, -1.0, 6.0))
    more: dict[str, Any] = {} if chance.random() < 0.5 else {"priority": chance.choice((0, 1, 2, 3))}

    def sometimes(share: float, **fields: Any) -> None:
        if chance.random() < share:
            more.update(fields)

    tags = sorted({t for a in graph.actions.values() for t in a.tags})
    kind = chance.choice(
        ("gesture", "gesture", "gesture", "fidget", "stance", "action", "action", "change", "nod", "shake")
        if chance.random() < 0.65
        else (
            "look",
            "blink",
            "say",
            "say",
            "mode",
            "mood",
            "mood",
            "place",
            "withdraw",
            "interrupt",
            "pause",
        )
    )
    sometimes(0.25, late=chance.choice((0.0, 0.25, 0.5, 2.0)))
    match kind:
        case "gesture" | "fidget":
            more["layer"] = layer
            sometimes(0.25, resume=True)
            sometimes(0.25, duration=_quarters(chance, 0.25, 5.0))
            sometimes(0.2, limb=chance.choice(("left", "right", "both")))
            sometimes(0.3 if tags else 0.0, tags=[chance.choice(tags or [""])])
            sometimes(0.15, mood=chance.choice(MOODS))
        case "action" if graph.actions:
            more["action"] = chance.choice([*graph.actions])
            sometimes(0.15, intensity=chance.choice((0.0, 0.5, 1.5, 2.0)))
            sometimes(0.2, duration=_quarters(chance, 0.25, 5.0))
        case "stance" if graph.stances:
            more |= {"stance": chance.choice([*graph.stances])}
            sometimes(0.3, stay=True)
        case "change":
            more["layer"] = layer
            sometimes(0.3, limb=chance.choice(("left", "right", "both")))
        case "nod" | "shake":
            sometimes(0.3, tags=["positive"])
        case _:
            return _lasting(chance, kind, ident, at, known)
    if kind in ("gesture", "action"):
        sometimes(0.35, stroke=max(0.0, now + _quarters(chance, 0.0, 5.0)))
        sometimes(0.25, hold=_quarters(chance, 0.0, 2.0))
        sometimes(0.15, prepare=False)
    return ask(ident, kind, at, **more)


def _lasting(chance: Random, kind: str, ident: str, at: float | None, known: list[Ask]) -> Ask:
    more: dict[str, Any] = {}
    match kind:
        case "look":
            more["to"] = chance.choice(("user", "ahead", "door", [0.5, 1.25, 0.75], [-1.0, 1.5, 0.25]))
            more |= chance.choice(({}, {"duration": 1.5}, {"strict": True}, {"amount": 0.5}))
        case "say":
            more["text"] = chance.choice(TEXTS)
            more |= chance.choice(
                ({}, {}, {"priority": 0}, {"priority": 2}, {"duration": 2.0}, {"mood": "sad"})
            )
            more |= {"more": True} if chance.random() < 0.3 else {}
            lines = [one["id"] for one in known if one["do"] == "say"]
            if lines and chance.random() < 0.4:  # a further piece of one
                ident = lines[-1]
        case "mode":
            more["mode"] = chance.choice(MODES)
        case "mood":
            more["mood"] = chance.choice(MOODS)
            more |= chance.choice(({}, {"duration": 2.0}, {"intensity": 1.5}, {"intensity": 0.0}))
        case "place":
            more |= {"name": chance.choice(("user", "door")), "point": [0.5, 1.5, 1.0]}
        case "withdraw" | "interrupt" | "pause" | "resume" | "finish":
            lines = [one["id"] for one in known if one["do"] == "say"]
            every = [one["id"] for one in known[-8:]]
            more["what"] = chance.choice([*every, *lines[-4:], *lines[-2:], ""])
        case _:
            return ask(ident, "blink", at)
    return ask(ident, kind, at, **more)
