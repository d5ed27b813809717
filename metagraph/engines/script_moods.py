"""Scripts of conformance for moods: what is likelier, larger, faster, and how life goes."""

from __future__ import annotations

from collections.abc import Iterator

from metagraph.engines.script_parts import ScriptCase, ScriptStep, ask, list_some_actions, make_case
from metagraph.graph.model import LAYERS, Project

_TIMES = (0.4, 1.2, 2.1, 3.3, 4.6, 5.2, 7.7, 9.1, 11.3)


def list_mood_cases(project: Project) -> Iterator[ScriptCase]:
    """Yield cases of moods: told for ever, for a while, for one request, taken back, and forgotten."""
    both = (True, False)
    feelings = ("sad", "excited", "angry", "tired")
    asks = [ask(f"f{n}", "mood", 12.0 * n, mood=feeling) for n, feeling in enumerate(feelings)]
    yield make_case(
        "the models in four moods",
        "likelihoods, extent and tempo; breath, blinks and looks; posture and face fade from one to the next",
        asks, 48.0, idle=True, alive=both, times=(5.0, 11.9, 12.4, 13.2, 20.5, 24.6, 29.1, 36.2, 37.0, 44.4),
    )  # fmt: skip
    for layer in LAYERS:
        gestures = list_some_actions(project, layer, "gesture")
        if not gestures:
            continue
        asks = [ask("base", "mood", 0.0, mood=[0.2, -0.6], intensity=0.7)]
        asks += [ask(f"g{n}", "gesture", layer=layer, stroke=1.5 + 2.7 * n) for n in range(6)]
        asks += [ask("held", "action", 19.0, action=gestures[0].id, hold=1.4, mood="excited", intensity=2.0)]
        asks += [ask("soft", "action", 25.0, action=gestures[0].id, stroke=26.0, intensity=0.0)]
        asks += [ask("late", "gesture", layer=layer, stroke=31.0, late=0.2, mood=[-0.9, 1.0])]
        yield make_case(
            f"{layer}: strokes in a mood",
            "slow ones begin earlier, so that strokes stay on time; a request's own mood",
            asks, 36.0, alive=both,
        )  # fmt: skip
    asks = [
        ask("b", "mood", 1.0, mood="calm", intensity=1.5),
        ask("t", "mood", 2.0, mood="tense", duration=3.0),
        ask("i", "mood", 3.5, intensity=0.5, duration=4.0),
        ask("s", "say", 4.0, text="I cannot believe that this happened.", mood="sad", intensity=1.8),
        ask("n", "nod", 4.5, mood="afraid"),
        ask("strange", "mood", 5.0, mood="blue"),
    ]
    yield make_case(
        "moods over moods",
        "what lasts comes back when what was laid over it is over; a line's own; one that is not known",
        asks, idle=True, alive=both, times=_TIMES,
    )  # fmt: skip
    steps = (
        ScriptStep(0.0, 20.0, (ask("b", "mood", 0.0, mood="happy"), ask("c", "mood", 6.0, mood="bored"))),
        ScriptStep(3.0, 22.0, (ask("d", "mood", mood=[-1.0, -1.0]),)),
        ScriptStep(8.0, 26.0, (ask("w", "withdraw", what="d"),)),
        ScriptStep(14.0, 34.0, (), 9.0),
        ScriptStep(16.0, 40.0, (ask("e", "mood", 17.0, mood="excited", intensity=2.0),), 12.0),
    )
    yield ScriptCase(
        "moods come and go", "told while it plays, taken back, forgotten", steps, 1, True, alive=both,
        times=(13.0, 15.2, 17.3, 18.1, 21.7, 26.6, 33.3),
    )  # fmt: skip
