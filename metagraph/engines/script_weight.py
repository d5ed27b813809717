"""Cases of bodies that answer their arms."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from metagraph.engines.script_parts import ScriptCase, ask, make_case
from metagraph.graph.model import Project
from metagraph.playback.posing.rigs import get_rigs
from metagraph.playback.posing.weight import has_weight

MOST = 6  # actions in a case


def list_weight_cases(project: Project) -> Iterator[ScriptCase]:
    """Yield cases of one arms' action after the other, and of some that the body plays, too."""
    rig = get_rigs(project).weight.rig if has_weight(project) and project.skeleton is not None else None
    arms, body = project.graphs["arms"], project.graphs["body"]
    if rig is None or rig.strength <= 0:
        return
    acts = [a for kind in ("gesture", "fidget") for a in arms.of(arms.start or "", kind)]
    asks = [ask(f"w{n}", "action", 1.0 + 3.0 * n, action=a.id) for n, a in enumerate(acts[:MOST])]
    times = tuple(np.round(np.arange(0.9, 2.0 + 3.0 * len(asks), 0.37), 3).tolist())
    about = "the body answers as it stands, and comes back"
    for stance in [*body.stances][:2] if asks else ():
        name = f"arms that weigh in {stance}"
        yield make_case(name, about, asks, 19.0, stances={"body": stance}, times=times, alive=(True,))
    clips = {a.clip: a for a in acts}
    both = [(clips[a.clip], a) for a in body.actions.values() if a.clip in clips and a.stance == body.start]
    asks = []
    for n, (one, other) in enumerate(both[:MOST]):
        layer = ask(f"b{n}", "action", 1.0 + 3.0 * n, action=other.id)
        if other.kind != "stance":
            asks.append(layer)
        asks.append(ask(f"a{n}", "action", 1.2 + 3.0 * n, action=one.id))
    if asks:
        about = "what the body shows of a clip, too, moves its own hips"
        times = tuple(np.round(np.arange(0.9, 2.0 + 3.0 * len(both), 0.37), 3).tolist())
        for seed in (1, 2):
            yield make_case(
                f"one clip on both {seed}", about, asks, 19.0, seed=seed, times=times, alive=(True,)
            )
