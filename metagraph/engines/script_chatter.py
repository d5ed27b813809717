"""Scripts of conformance in which this and that is asked by chance while it plays."""

from __future__ import annotations

from collections.abc import Iterator
from random import Random
from typing import Any

from metagraph.engines.script_parts import Ask, ScriptCase, ScriptStep, ask
from metagraph.graph.model import LAYERS, Layer, Project


def list_chatter_cases(project: Project) -> Iterator[ScriptCase]:
    """Yield sessions in which this and that is asked by chance."""
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
        yield ScriptCase(
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
            return ask(ident, "gesture", at, **more)
        case "fidget":
            return ask(ident, "fidget", at, layer=layer, **more)
        case "stance" if graph.stances:
            return ask(
                ident,
                "stance",
                at,
                layer=layer,
                stance=chance.choice([*graph.stances]),
                stay=chance.random() < 0.3,
                **more,
            )
        case "action" if graph.actions:
            return ask(ident, "action", at, action=chance.choice([*graph.actions]), **more)
        case "look":
            return ask(
                ident,
                "look",
                at,
                to=chance.choice(("user", "ahead", [0.4, 1.2, 0.8])),
                duration=chance.choice((None, 1.5)),
                **more,
            )
        case "say":
            return ask(
                ident,
                "say",
                at,
                text=chance.choice(("Well, yes.", "I really do not think so at all.", "Hm")),
                **more,
            )
        case "blink":
            return ask(ident, "blink", at)
        case "mode":
            return ask(ident, "mode", at, mode=chance.choice(("idle", "listening", "talking", None)))
    return ask(ident, "change", at, layer=layer, **more)
