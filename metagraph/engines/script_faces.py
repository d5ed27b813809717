"""Scripts of conformance for the face: lips that meet, brows in speech, a mood's face over time, cues."""

from __future__ import annotations

from collections.abc import Iterator

from metagraph.engines.script_parts import ScriptCase, ScriptStep, ask, list_some_actions, make_case
from metagraph.graph.model import LAYERS, Project


def list_face_cases(project: Project) -> Iterator[ScriptCase]:
    """Yield cases of lips and expressions, where the life layers are on."""
    if not project.life.on:
        return
    both = (True,)
    asks = [
        ask("q", "say", 0.5, text="Maybe Bob moved five boxes upstairs?"),
        ask("r", "say", 3.4, text="You may have my map."),
        ask("s", "say", 6.0, text="是吗？"),
        ask("t", "say", 8.0, text="Who would believe that we will be back before the summer is over?"),
        ask("u", "say", 11.0, text="Nobody."),
    ]
    yield make_case(
        "questions and lips that meet",
        "closures through the smoothing, rounding ahead of vowels; brows on stressed words and at questions, "
        "one of which is cut short",
        asks, alive=both,
        times=(0.62, 0.8, 1.03, 1.4, 2.2, 2.7, 3.0, 3.3, 3.58, 3.9, 4.31, 6.2, 6.6, 9.1, 10.4, 10.9, 11.3),
    )  # fmt: skip
    feelings = ("happy", "sad", "angry", "neutral")
    asks = [ask(f"f{n}", "mood", 8.0 * n, mood=feeling) for n, feeling in enumerate(feelings)]
    asks += [ask("m", "mode", 20.0, mode="listening"), ask("n", "mood", 26.0, intensity=0.4)]
    yield make_case(
        "a mood's face over time",
        "it comes up and goes back; a listener's passing smiles, in a good mood, a bad one and none",
        asks, 40.0, alive=both, times=tuple(1.7 + 2.3 * n for n in range(16)),
    )  # fmt: skip
    asks = []
    for layer in LAYERS:
        tagged = [action for action in list_some_actions(project, layer, "gesture") if action.tags]
        asks += [
            ask(f"{layer}{n}", "action", 1.0 + 4.0 * n, action=action.id)
            for n, action in enumerate(tagged[:3])
        ]
    if asks:
        yield make_case(
            "faces of gestures",
            "greeting, yes and no show on the face, from when they begin",
            asks, 16.0, alive=both,
            times=(1.05, 1.16, 1.22, 1.4, 1.9, 2.6, 5.13, 5.3, 6.0, 6.6, 9.2, 9.5, 10.3),
        )  # fmt: skip
    steps = (
        ScriptStep(0.0, 12.0, (ask("a", "mood", 0.0, mood="warm"), ask("m", "mode", 0.0, mode="listening"))),
        ScriptStep(4.0, 16.0, (ask("b", "say", text="Did you see that, or did you not see it at all?"),)),
        ScriptStep(6.5, 20.0, (ask("w", "withdraw", what="b"),), 2.0),
        ScriptStep(11.0, 32.0, (ask("c", "say", 12.0, text="Really? I would never have believed it."),), 9.0),
    )
    yield ScriptCase(
        "faces come and go", "told while they play, cut short, forgotten", steps, alive=both,
        times=(11.2, 12.2, 12.6, 14.5, 18.8, 23.4, 29.9),
    )  # fmt: skip
