"""Cases of actions that repeat a part of their clip."""

from __future__ import annotations

from collections.abc import Iterator

from metagraph.engines.script_parts import ScriptCase, ScriptStep, ask, list_some_actions, make_case
from metagraph.graph.model import LAYERS, Project
from metagraph.graph.repeating import cycle_of


def list_repeat_cases(project: Project) -> Iterator[ScriptCase]:
    """Yield cases of actions that repeat, on each layer that has some: for as long as they do by themselves,
    as long as asked, with strokes in time, cut, left early and gone on with.
    """
    for layer in LAYERS:
        actions = list_some_actions(project, layer, "gesture", "fidget")
        found = [a for a in actions if cycle_of(a.kind, a.timing, *project.span(a)) > 0]
        others = [a for a in actions if a not in found]
        for n, one in enumerate(found):
            start, end = project.span(one)
            at = tuple(round(1.0 + k * 0.37 * (end - start), 3) for k in range(24))
            yield make_case(
                f"{layer}: {one.id} repeats",
                "whole cycles, with a seam between them, blended in and out once",
                [ask("r", "action", 1.0, action=one.id)],
                9.0,
                times=at,
                alive=(False, True),
            )
            asks = [
                ask("long", "action", 1.0, action=one.id, duration=5.3),
                ask("short", "action", 9.0, action=one.id, duration=0.2),
                ask("in time", "action", action=one.id, stroke=14.0),
                ask("soon", "action", 18.0, action=one.id, stroke=18.1, hold=2.0),
                ask("sad", "action", 23.0, action=one.id, mood=[-0.8, -0.6]),
            ]
            yield make_case(
                f"{layer}: {one.id} for as long as asked",
                "the nearest whole number of cycles; strokes fall in the first",
                asks,
                30.0,
                seed=n + 1,
            )
            if not others:
                continue
            asks = [
                ask("r1", one.kind, 1.0, layer=layer, tags=one.tags[-1:], duration=6.0, resume=True),
                ask("cut", "action", 2.6, action=others[0].id, priority=3),
                ask("r2", "action", 12.0, action=one.id),
                ask("next", "action", 12.9, action=others[0].id),
                ask("r3", "action", 18.0, action=one.id, duration=4.0),
                ask("stroke", "action", action=others[0].id, stroke=20.5, late=0.1),
            ]
            yield make_case(
                f"{layer}: {one.id} is left",
                "after its first cycle it may be left; what was cut goes on for what is left of its time",
                asks,
                28.0,
            )
            quick = ask("r", "action", 1.0, action=one.id, duration=6.0, mood="excited")
            slow = ask("s", "action", 13.0, action=one.id, duration=6.0, mood=[-0.8, -0.8])
            steps = (
                ScriptStep(0.0, 24.0, (quick, slow)),
                ScriptStep(1.6, 24.0, (ask("now", "action", action=others[0].id, late=3.0),)),
                ScriptStep(13.6, 30.0, (ask("then", "action", action=others[0].id, late=3.0),)),
            )
            yield ScriptCase(
                f"{layer}: {one.id} is left while it plays",
                "sooner in a quick mood than in a slow one",
                steps,
            )
