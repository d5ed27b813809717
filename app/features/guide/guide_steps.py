"""The steps to a first character: what each asks for, where to look, and when it is done."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from app.project.files import SAMPLE
from app.translation import make_lazy_texts, tr
from metagraph.graph.model import Kind, Project

CLIPS = tuple(
    SAMPLE.parent / "clips" / f"hands_at_sides__{name}.glb"
    for name in ("stance", "wave_hello_rt_01", "check_watch_lf_01")
)
WATCHED = 6.0  # seconds of playing after which somebody has watched


@dataclass(frozen=True)
class Seen:
    """What has happened since the guide began. watched: seconds of the performance that were played.
    exported: files for an engine were written.
    """

    project: Project
    watched: float = 0.0
    exported: bool = False

    def has(self, kind: Kind) -> bool:
        """Return whether there is an action of a kind."""
        return any(action.kind == kind for action in self.project.actions())


@dataclass(frozen=True)
class GuideStep:
    """ident: stable. panel: the id of the panel to look at. is_done: whether the step has been taken."""

    ident: str
    panel: str
    is_done: Callable[[Seen], bool]


STEPS = (
    GuideStep("clips", "library", lambda seen: len(seen.project.clips) >= 3),
    GuideStep("stance", "graph", lambda seen: seen.has("stance")),
    GuideStep("gesture", "graph", lambda seen: seen.has("gesture")),
    GuideStep("fidget", "graph", lambda seen: seen.has("fidget")),
    GuideStep("watch", "character", lambda seen: seen.watched >= WATCHED),
    GuideStep("export", "", lambda seen: seen.exported),
)
WORDS: Mapping[str, str] = make_lazy_texts(
    lambda: {
        "clips": tr(
            "Add clips: drop at least three files or a folder on the window, or use three clips of "
            "the sample."
        ),
        "stance": tr(
            "Drag the resting clip onto the middle of the graph. Or select it and press 1. It "
            "becomes a stance: the pose that everything else starts and ends in."
        ),
        "gesture": tr("Drag a clip with a meaning, such as a wave, onto Gesture. Or select it and press 2."),
        "fidget": tr(
            "Drag a clip without a meaning, such as a look at a watch, onto Fidget. Or select it and press 3."
        ),
        "watch": tr(
            "All connections are made. Watch for a few seconds: the character rests, waves and fidgets by "
            "itself, with a blend at each change. The space bar pauses and plays."
        ),
        "export": tr("Press Ctrl+E, choose your engine and export. The engine plays what you just saw."),
        "end": tr(
            "This is your first character. Next: label a whole folder with Graph > Label clips, or "
            "make it talk in the workspace Talk."
        ),
    }
)


def find_step(seen: Seen, skipped: int) -> int:
    """Return the place of the first step that is neither done nor skipped, `len(STEPS)` after the last.
    skipped: how many were skipped or done before, from the first on; what was done stays done.
    """
    return next((n for n in range(skipped, len(STEPS)) if not STEPS[n].is_done(seen)), len(STEPS))
