"""The timeline's lanes: for each layer what was asked for above and what plays below, and a lane for speech and gaze.

Geometry and hit-testing are functions of values; the widget paints, and turns the mouse into edits.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QFont, QFontMetricsF

from app.asks import STAGE, ask_words, kind_of, lane_of
from app.performance import Shown
from metagraph.graph.asks import AnyAsk
from metagraph.graph.model import LAYERS, Layer, Project
from metagraph.playback.hear import Answer
from metagraph.playback.plan import Cue

LEFT, RULER, LANE = 84, 24, 60
ASKS = 0.44  # of a lane's height is for what was asked
STEPS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 60.0, 300.0)
NAMES = (STAGE, *LAYERS)
TITLES = {STAGE: "Speech", "body": "Body", "arms": "Arms", "head": "Head"}
NARROWEST = 22.0  # pixels of a mark


@dataclass(frozen=True)
class Scale:
    """Seconds to pixels: `first` seconds stand at the left of the lanes, `each` pixels a second."""

    first: float
    each: float

    def x(self, seconds: float) -> float:
        return LEFT + (seconds - self.first) * self.each

    def seconds(self, x: float) -> float:
        return self.first + (x - LEFT) / self.each

    def step(self) -> float:
        """Seconds between marks of the ruler, at least 64 pixels apart."""
        return next((s for s in STEPS if s * self.each >= 64), STEPS[-1])


def lanes(height: float) -> dict[str, QRectF]:
    """Return where each lane is, from the top: the stage, then the layers."""
    each = min(LANE, max(32.0, (height - RULER) / len(NAMES)))
    return {name: QRectF(0, RULER + n * each, 1e6, each) for n, name in enumerate(NAMES)}


def rows(lane: QRectF) -> tuple[QRectF, QRectF]:
    """Return a lane's upper row, what was asked, and its lower, what plays."""
    upper = lane.height() * ASKS
    return QRectF(lane.left(), lane.top() + 2, lane.width(), upper - 3), QRectF(
        lane.left(), lane.top() + upper, lane.width(), lane.height() - upper - 3
    )


def lane_at(height: float, at: QPointF) -> str | None:
    """Return the lane under a point."""
    return next((name for name, lane in lanes(height).items() if at.x() >= LEFT and lane.contains(at)), None)


def cue_at(shown: Shown, scale: Scale, height: float, at: QPointF) -> tuple[Layer, Cue] | None:
    """Return the cue under a point."""
    seconds = scale.seconds(at.x())
    for layer in LAYERS:
        if at.x() >= LEFT and rows(lanes(height)[layer])[1].contains(at):
            cue = shown.plan.layers[layer].cue_at(seconds)
            return (layer, cue) if cue is not None else None
    return None


@dataclass(frozen=True)
class Mark:
    """An ask as it is drawn. at: the seconds it asks for. lost: it will not play. late: by how many seconds."""

    ask: AnyAsk
    rect: QRectF
    words: str
    kind: str | None
    at: float
    answer: Answer | None

    @property
    def lost(self) -> bool:
        return self.answer is not None and self.answer.state == "refused"

    @property
    def late(self) -> float:
        if self.answer is None or self.answer.at is None or getattr(self.ask, "stroke", None) is not None:
            return 0.0
        return max(0.0, self.answer.at - self.at)


def time_of(ask: AnyAsk, answer: Answer | None) -> float:
    """Return when an ask stands in the timeline: when it was wanted, else when it plays."""
    stroke = getattr(ask, "stroke", None)
    if stroke is not None:
        return float(stroke)
    if ask.at is not None:
        return float(ask.at)
    if ask.told is not None:
        return float(ask.told)
    return answer.at if answer is not None and answer.at is not None else 0.0


def marks(
    asks: Sequence[AnyAsk],
    answers: Mapping[str, Answer],
    project: Project,
    scale: Scale,
    height: float,
    font: QFont,
    shift: Mapping[str, float] | None = None,
) -> list[Mark]:
    """Return what stands in the upper rows, the later on top. shift: seconds by which some are being dragged."""
    measure = QFontMetricsF(font)
    places = lanes(height)
    rows_: dict[str, list[Mark]] = {}
    timed = sorted(((time_of(x, answers.get(x.id)) + (shift or {}).get(x.id, 0.0), n, x) for n, x in enumerate(asks)), key=lambda t: t[:2])
    for at, _, ask in timed:
        lane = lane_of(ask, project)
        area = rows(places[lane])[0]
        words = ask_words(ask, project)
        width = min(260.0, measure.horizontalAdvance(words) + 18)
        mark = Mark(ask, QRectF(scale.x(at), area.top(), width, area.height()), words, kind_of(ask), at, answers.get(ask.id))
        rows_.setdefault(lane, []).append(mark)
    out: list[Mark] = []
    for of in rows_.values():
        for n, mark in enumerate(of):
            room = of[n + 1].rect.left() - mark.rect.left() - 3 if n + 1 < len(of) else mark.rect.width()
            rect = QRectF(mark.rect)
            rect.setWidth(max(NARROWEST, min(rect.width(), room)))
            out.append(Mark(mark.ask, rect, mark.words, mark.kind, mark.at, mark.answer))
    return out


def mark_at(found: Sequence[Mark], at: QPointF) -> Mark | None:
    """Return the mark under a point, the topmost of several."""
    return next((m for m in reversed(found) if m.rect.contains(at) and at.x() >= LEFT), None)


def told(mark: Mark, project: Project) -> str:
    """Return what to say about a mark: what was asked, what came of it, or why nothing did."""
    when = f"at {mark.at:.2f} s" if getattr(mark.ask, "stroke", None) is None else f"its stroke at {mark.at:.2f} s"
    lines = [f"{mark.words}, {when}" + (f", priority {mark.ask.priority}" if mark.ask.priority != 1 else "")]
    answer = mark.answer
    if answer is not None:
        if answer.state == "refused":
            lines.append(f"Does not play: {answer.why}")
        elif answer.state == "done":
            lines.append(answer.why[:1].upper() + answer.why[1:])
        elif answer.at is not None:
            what = ", ".join(w for w in answer.what if w not in ("look", "speech", "mode", "place", "blink"))
            lines.append(f"Plays{' ' + what if what else ''} from {answer.at:.2f} s" + (f": {answer.why}" if answer.why else ""))
    return "\n".join([*lines, "Drag it in time; double-click changes it; Delete takes it back"])


def elided(text: str, font: QFont, width: float) -> str:
    return QFontMetricsF(font).elidedText(text, Qt.TextElideMode.ElideRight, width)
