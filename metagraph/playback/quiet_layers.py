"""Find layers on which nothing plays by itself while a character idles, listens or talks, and what helps.

A viewer sees a figure that hardly lives, and an empty lane says nothing. What is counted is what the models
write and the planner performs, in each mode that lasts.
"""

from __future__ import annotations

from collections.abc import Mapping

from metagraph.common.wording import Phrase, join_phrases, phrase
from metagraph.graph.model import LAYERS, Layer, Mode, Part, Project
from metagraph.graph.problem import Problem
from metagraph.graph.words import LASTING_MODES
from metagraph.playback.planning.running_plan import improvise

SECONDS = 300.0  # of each mode
_PART: Mapping[Layer, Part] = {"body": "legs", "arms": "arms", "head": "head"}  # what a layer is there for
_NAMES: Mapping[Layer, Phrase] = {
    "body": phrase("the body"),
    "arms": phrase("the arms"),
    "head": phrase("the head"),
}
_DOES: Mapping[Mode, Phrase] = {
    "idle": phrase("idles"),
    "listening": phrase("listens"),
    "talking": phrase("talks"),
}
_NODS = phrase(
    "Add clips of the head alone: drop one that rests on the Stance node of the layer 'head', then nods and "
    "shakes on its Gesture node. The character then nods while it listens."
)
_SHIFTS = phrase("Drop clips that shift the weight on the Fidget node of the layer 'body'.")
_GESTURES = phrase("Drop gestures on the Gesture node of the layer 'arms'.")
_FIDGETS = phrase("Drop clips on the Fidget node of the stances that it rests in.")


def find_quiet_layers(project: Project, seconds: float = SECONDS) -> list[Problem]:
    """Return a hint for each layer on which nothing plays in a mode; nothing for a project without stances
    that play. seconds: how long each mode is looked at.
    """
    resting = [x for x in LAYERS if any(a.kind == "stance" for a in project.graphs[x].actions.values())]
    if project.skeleton is None or not resting:
        return []
    quiet: dict[Layer, list[Mode]] = {layer: [] for layer in LAYERS}
    for mode in LASTING_MODES:
        plan = improvise(project, seconds, None, mode)
        for layer in LAYERS:
            if all(cue.action.kind == "transition" for cue in plan.layers[layer].cues):
                quiet[layer].append(mode)
    out = []
    for layer, modes in quiet.items():
        if modes and (problem := _describe(project, layer, modes, resting)) is not None:
            out.append(problem)
    return out


def _describe(project: Project, layer: Layer, modes: list[Mode], resting: list[Layer]) -> Problem | None:
    graph = project.graphs[layer]
    words = phrase(
        "nothing plays on {layer} while the character {does}",
        layer=_NAMES[layer],
        does=join_phrases([_DOES[mode] for mode in modes], ", "),
    )
    if layer not in resting:
        moved = [x for x in resting if project.graphs[x].weight(_PART[layer]) > 0]
        if moved:
            words = phrase(
                "{words}: it has no clips of its own, and moves only with clips of {others}",
                words=words,
                others=join_phrases([_NAMES[x] for x in moved], " and "),
            )
        remedy = {"body": _SHIFTS, "arms": _GESTURES, "head": _NODS}[layer]
        if layer == "body" and moved:  # a second layer that moves the legs would add up with the first
            remedy = phrase(
                "Drop clips that shift the weight on the Fidget node of {layer}, whose clips move the legs.",
                layer=_NAMES[moved[0]],
            )
    elif "idle" in modes or ("listening" in modes and layer != "head"):
        remedy = _FIDGETS
    else:
        remedy = _NODS if layer == "head" else _GESTURES if layer == "arms" else _SHIFTS
    if (
        layer == "arms"
        and modes == ["listening"]
        and any(a.kind == "gesture" for a in graph.actions.values())
    ):
        return None  # hands that lie still while somebody listens are as people's are
    return Problem("hint", "play-nothing", words, remedy, layer)
