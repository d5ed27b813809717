"""Scripts of conformance for what differs by little: moods by their names and at their ends, requests no more
important than what models write, limbs wished for, lines of no sound, what comes before all there is.
"""

from __future__ import annotations

from collections.abc import Iterator

from metagraph.engines.script_parts import ScriptCase, ScriptStep, ask, list_some_actions, make_case
from metagraph.graph.model import LAYERS, Project
from metagraph.playback.planning.mood import MOODS


def list_shade_cases(project: Project) -> Iterator[ScriptCase]:
    """Yield the cases that suit a project; all but one compare plans alone."""
    asks = [ask(f"m{n}", "mood", 2.0 * n, mood=name) for n, name in enumerate(MOODS)]
    yield make_case("every mood by its name", "each is a point of its own", asks, 26.0, alive=())
    ends = (([1.0, 0.9], 2.0), ([-1.0, -0.9], 0.0), ([0.6, 0.3], 1.0), ([-0.5, -0.3], 1.4))
    asks = [ask(f"e{n}", "mood", 24.0 * n, mood=m, intensity=i) for n, (m, i) in enumerate(ends)]
    yield make_case(
        "moods at their ends",
        "what is likelier there, also near tagged moods",
        asks,
        96.0,
        idle=True,
        alive=(),
    )
    asks = [
        ask("7", "say", 1.0, line=7),
        ask("again", "say", 4.0, line=7, mood="happy"),
        ask("more", "say", 7.0, line=7, intensity=0.4),
        ask("dots", "say", 9.0, text="...", duration=1.5),
        ask("short", "say", 11.0, text="Oh", duration=0.0005),
        ask("long", "say", 12.0, text="9 and 42, of 1,000."),
    ]
    yield make_case(
        "lines of little sound", "a line's mood and what is told of it; marks and numbers alone",
        asks, idle=True, alive=(True,), times=(1.4, 4.3, 7.4, 9.6, 12.9),
    )  # fmt: skip
    steps = (
        ScriptStep(0.0, 20.0, (ask("a", "mode", 8.0, mode="listening"), ask("l", "look", 9.0, to=[0, 1, 2]))),
        ScriptStep(1.0, 20.0, (ask("b", "mode", 3.0, mode="idle"), ask("k", "look", 4.0, to=[1, 1, 2]))),
        ScriptStep(2.0, 20.0, (ask("c", "mood", 9.0, mood="sad"), ask("d", "mood", 5.0, mood="sad"))),
    )
    yield ScriptCase("before all there is", "what comes later may begin earlier", steps, 1, True, alive=())
    for layer in LAYERS:
        gestures = list_some_actions(project, layer, "gesture")
        if not gestures:
            continue
        asks = [
            ask(f"p{n}", "gesture", 3.0 + 4.0 * n, layer=layer, priority=p)
            for n, p in enumerate((0, -1, 0, 1))
        ]
        yield make_case(
            f"{layer}: no more important than the models", "equals go by their times",
            asks, 24.0, idle=True, alive=(),
        )  # fmt: skip
        asks = [
            ask(f"w{n}", "gesture", layer=layer, stroke=1.2 + 0.9 * n, limb=limb, late=late)
            for n, (limb, late) in enumerate(
                (limb, late) for late in (0.0, 0.4, 1.5) for limb in ("left", "right", "both", None)
            )
        ]
        yield make_case(
            f"{layer}: limbs and lateness", "wishes, each with a time", asks, 24.0, idle=True, alive=()
        )
        asks = [
            ask("slow", "mood", 0.0, mood="tired", intensity=0.6),
            ask("cut", "gesture", 2.0, layer=layer, duration=9.0, resume=True),
            ask("by", "action", 3.5, action=gestures[0].id, priority=5, hold=0.8),
            ask("fast", "mood", 14.0, mood="angry"),
            ask("cut2", "gesture", 15.0, layer=layer, duration=9.0, resume=True, prepare=False),
            ask("by2", "action", 16.2, action=gestures[-1].id, priority=5),
        ]
        yield make_case(
            f"{layer}: resumed in a mood", "what is left of it, slower or faster", asks, 30.0, alive=()
        )
