"""Cases of feet that stay planted while the layer blends that moves the legs."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from metagraph.engines.script_parts import ScriptCase, ask, make_case
from metagraph.graph.model import Project
from metagraph.playback.posing.rigs import get_rigs
from metagraph.playback.posing.weight import has_planted_feet

MOST = 9  # actions in a case
EDGES = (
    -0.04,
    0.03,
    0.11,
    0.19,
    0.27,
    0.34,
    0.41,
    0.48,
    0.56,
)  # seconds from where an action begins, and to its end


def list_feet_cases(project: Project) -> Iterator[ScriptCase]:
    """Yield cases of one of that layer's actions after the other, from stance to stance, and of its loops."""
    planted = has_planted_feet(project) and project.skeleton is not None
    layer = get_rigs(project).weight.feet_layer if planted else None
    if layer is None:
        return
    body = project.graphs[layer]
    for stance in [*body.stances][:2]:
        acts = [a for kind in ("gesture", "fidget") for a in body.of(stance, kind)][:MOST]
        asks = [ask(f"f{n}", "action", 1.0 + 3.0 * n, action=a.id) for n, a in enumerate(acts)]
        if asks:
            times: set[float] = set()
            for n, action in enumerate(acts):
                start, end = project.span(action)
                times |= {1.0 + 3.0 * n + x for x in EDGES} | {1.0 + 3.0 * n + end - start - x for x in EDGES}
            about = "feet are held, and step, as the body's actions come and go"
            more = {"stances": {layer: stance}, "times": tuple(sorted(round(t, 3) for t in times))}
            yield make_case(f"feet in {stance}", about, asks, 29.0, alive=(True,), **more)
    ways = [a for a in body.actions.values() if a.kind == "transition" and a.stance == body.start][:2]
    asks = []
    for n, action in enumerate(ways):
        asks.append(ask(f"to{n}", "stance", 1.0 + 6.0 * n, layer=layer, stance=action.end_stance))
        asks.append(ask(f"back{n}", "stance", 4.0 + 6.0 * n, layer=layer, stance=body.start))
    every = tuple(np.round(np.arange(0.5, 4.0 + 6.0 * len(ways), 0.13), 3).tolist())
    for seed in (1, 2):
        about = "loops take over from loops, and transitions lead from stance to stance"
        yield make_case(
            f"feet from stance to stance {seed}", about, asks, 19.0, seed=seed, times=every, alive=(True,)
        )
    about = "nothing is asked: loops take over from one another, and begin anew"
    often = tuple(np.round(np.arange(0.2, 9.0, 0.17), 3).tolist())
    yield make_case("feet at rest", about, [], 20.0, seed=3, times=often, alive=(True,))
