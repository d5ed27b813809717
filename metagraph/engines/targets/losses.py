"""List what every state machine loses of a meta-graph; each target adds its own."""

from __future__ import annotations

from metagraph.common.wording import phrase, plural_phrase
from metagraph.engines.targets.target import Loss
from metagraph.graph.model import Project


def _varied(project: Project) -> int:
    """Count the stances with several loops."""
    return sum(len(g.of(s, "stance")) > 1 for g in project.graphs.values() for s in g.stances)


def _ways(project: Project) -> int:
    """Count the transitions that are not the only one between two stances."""
    seen: set[tuple[str, str | None]] = set()
    again = 0
    for action in project.actions():
        if action.kind == "transition":
            again += (action.stance, action.end_stance) in seen
            seen.add((action.stance, action.end_stance))
    return again


def _masked(project: Project) -> int:
    return sum(1 for a in project.actions() if a.limb != "both" or a.joints or a.joint_weights)


def _soft(project: Project) -> int:
    return sum(1 for a in project.actions() if a.joint_weights)


def _repeating(project: Project) -> int:
    return sum(a.timing.repeat > 0 and a.kind in ("gesture", "fidget") for a in project.actions())


def _seams(project: Project) -> int:
    return sum(1 for a in project.actions() if a.kind == "stance" and a.timing.blend_in > 0)


def _weighted(project: Project) -> int:
    return sum(1 for g in project.graphs.values() for w in g.weights.values() if w not in (0.0, 1.0))


CONVERSATIONS = Loss(
    plural_phrase(
        "{count} conversation is left out: no export contains conversations. Render it as a "
        "video, or play its two characters yourself",
        "{count} conversations are left out: no export contains conversations. Render them as "
        "videos, or play their characters yourself",
        0,
    ),
    lambda project: len(project.conversations),
)
PROPS = Loss(
    plural_phrase("{count} prop is left out", "{count} props are left out", 0),
    lambda project: len(project.props),
)
PERFORMANCES = Loss(
    plural_phrase(
        "{count} saved performance is left out",
        "{count} saved performances are left out",
        0,
    ),
    lambda project: len(project.performances),
)
MACHINE: tuple[Loss, ...] = (
    Loss(
        phrase(
            "no planner: it does not choose actions by tags, limb or likelihood, plan ahead, or "
            "time strokes; you must request each action"
        )
    ),
    Loss(phrase("no Markov models: without requests, the character does not perform")),
    Loss(phrase("no life layers: no breathing, gaze, blinks or lip sync")),
    Loss(phrase("holds have the length they have in the clip, and preparations are never skipped")),
    Loss(
        plural_phrase(
            "{count} stance has several loops: only the first plays automatically, the others on request",
            "{count} stances have several loops: only the first plays automatically, the others on request",
            0,
        ),
        _varied,
    ),
    Loss(
        plural_phrase(
            "{count} transition is not the first between its stances: it plays only if you request it",
            "{count} transitions are not the first between their stances: each plays only if you request it",
            0,
        ),
        _ways,
    ),
    Loss(
        plural_phrase(
            "{count} action moves only a part of its layer: the rest holds the first pose of the stance "
            "instead of playing on",
            "{count} actions move only a part of their layer: the rest holds the first pose of the stance "
            "instead of playing on",
            0,
        ),
        _masked,
    ),
    Loss(
        plural_phrase(
            "{count} action has partial joint weights: these are baked into the clip, relative to the first "
            "pose of the stance, and cannot be changed there",
            "{count} actions have partial joint weights: these are baked into the clips, relative to the "
            "first pose of the stance, and cannot be changed there",
            0,
        ),
        _soft,
    ),
    Loss(
        plural_phrase(
            "{count} action repeats for as long as a request asks: there, it plays for its usual time",
            "{count} actions repeat for as long as a request asks: there, each plays for its usual time",
            0,
        ),
        _repeating,
    ),
    Loss(
        plural_phrase(
            "{count} loop blends its seam here but jumps at the seam there",
            "{count} loops blend their seam here but jump at the seam there",
            0,
        ),
        _seams,
    ),
    PERFORMANCES,
)
WEIGHTS = Loss(
    plural_phrase(
        "{count} layer weight other than 0 and 1 counts as 1",
        "{count} layer weights other than 0 and 1 count as 1",
        0,
    ),
    _weighted,
)
CROSSFADE = Loss(phrase("blends are plain crossfades: they slow a clip down and then speed it up"))
