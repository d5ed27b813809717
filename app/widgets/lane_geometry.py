"""The timeline's lanes: for each layer what was asked for above and what plays below, and a lane for speech
and gaze.

Geometry and hit-testing are functions of values; the widget paints, and turns the mouse into edits.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QFont

from app.look.shortening import measure_font
from app.stage.playback_source import ShownPlayback
from app.translation import make_lazy_texts, tr, tr_context
from app.widgets.request_menu import STAGE, ask_kind, describe_request
from metagraph.graph.model import LAYERS, Layer, Project
from metagraph.graph.requests import AnyRequest
from metagraph.graph.timeline_edits import find_lane
from metagraph.playback.plan import Cue
from metagraph.playback.planning.extend_performance import AskAnswer

LEFT, RULER, LANE = 84, 28, 104
NUMBERS = 16  # pixels of the ruler that are its numbers'; the strip below is the range's and the markers'
PLAYS = 34.0  # pixels at most for what plays in a lane; the rest is for what was asked
ROW, TALLEST = 19.0, 22.0  # pixels of a row of requests, at least and at most
STEPS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 60.0, 300.0)
NAMES = (STAGE, *LAYERS)
TITLES = make_lazy_texts(
    lambda: {
        "cameras": tr("Cameras"),
        STAGE: tr("Speech"),
        "words": tr("Words"),
        "body": tr("Body"),
        "arms": tr("Arms"),
        "head": tr("Head"),
    }
)
FIXED = {"cameras": 18.0, "words": 40.0}  # pixels of lanes that have no requests
GHOST = 14.0  # the same of another seed's
TALLEST_SHARE, LEAST_SHARE = 4.0, 0.45  # by which a lane can be made taller or lower
NARROWEST = 6.0  # pixels of a mark that others leave no room


@dataclass(frozen=True)
class LaneScale:
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


@dataclass(frozen=True)
class Sizes:
    """Which lanes there are besides stage and layers, and how tall each is. extra: "cameras", "words", and
    the seeds of ghosts as "ghost 7". tall: lane -> how many times its usual height it has.
    """

    extra: tuple[str, ...] = ()
    tall: tuple[tuple[str, float], ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """Return all lanes, from the top."""
        out = [n for n in ("cameras", STAGE, "words", *LAYERS) if n in NAMES or n in self.extra]
        return (*out, *(n for n in self.extra if n.startswith("ghost ")))

    def factor(self, name: str) -> float:
        return dict(self.tall).get(name, 1.0)

    def fixed(self, name: str) -> float | None:
        """Return how many pixels a lane has that has no requests; None for one that has."""
        usual = GHOST if name.startswith("ghost ") else FIXED.get(name)
        return usual * self.factor(name) if usual is not None else None

    def least(self, layer: float) -> float:
        """Return the height in which each layer has so many pixels."""
        return RULER + layer * len(NAMES) + sum(self.fixed(n) or 0.0 for n in self.extra)

    def resized(self, name: str, bottom: float, whole: float) -> Sizes:
        """Return the sizes with which a lane ends at `bottom`, in a widget `whole` pixels high."""
        fixed = self.fixed(name)
        if fixed is not None:
            top = place_lanes(whole, self)[name].top()
            return self.with_factor(name, (bottom - top) * self.factor(name) / fixed)
        names = self.names
        before, room = names[: names.index(name)], whole - RULER - sum(self.fixed(n) or 0.0 for n in names)
        above = sum(self.factor(n) for n in before if n in NAMES)
        below = sum(self.factor(n) for n in NAMES if n not in before and n != name)
        down = bottom - RULER - sum(self.fixed(n) or 0.0 for n in before)
        part = min(0.98, max(0.0, down / max(1.0, room)))
        if room >= LANE * (above + self.factor(name) + below):
            return self.with_factor(name, down / LANE - above)
        if not below:  # the last one ends where all end: the higher the mouse, the lower it is
            return self.with_factor(name, self.factor(name) * part)
        return self.with_factor(name, (part * (above + below) - above) / (1 - part))

    def with_factor(self, name: str, factor: float) -> Sizes:
        """Return the sizes with which a lane is so many times its usual height."""
        held = round(min(TALLEST_SHARE, max(LEAST_SHARE, factor)), 3)
        tall = {k: v for k, v in self.tall if k != name}
        return replace(self, tall=tuple(sorted(({**tall, name: held} if held != 1.0 else tall).items())))


EVEN = Sizes()


def place_lanes(height: float, sizes: Sizes = EVEN) -> dict[str, QRectF]:
    """Return where each lane is, from the top: the stage, then the layers, with what is shown besides."""
    names, whole = sizes.names, sum(sizes.factor(n) for n in NAMES)
    room = height - RULER - sum(sizes.fixed(n) or 0.0 for n in names)
    each = min(float(LANE), max(32.0 * len(NAMES) / whole, room / whole))
    out, top = {}, float(RULER)
    for name in names:
        tall = sizes.fixed(name)
        tall = each * sizes.factor(name) if tall is None else tall
        out[name] = QRectF(0, top, 1e6, tall)
        top += tall
    return out


def split_lane(lane: QRectF) -> tuple[QRectF, QRectF]:
    """Return a lane's upper row, what was asked, and its lower, what plays."""
    lower = min(PLAYS, lane.height() * 0.5)
    upper = lane.height() - lower
    return QRectF(lane.left(), lane.top() + 2, lane.width(), upper - 3), QRectF(
        lane.left(), lane.top() + upper, lane.width(), lower - 3
    )


def find_lane_at(height: float, at: QPointF, sizes: Sizes = EVEN) -> str | None:
    """Return the lane under a point."""
    places = place_lanes(height, sizes)
    return next((name for name, lane in places.items() if at.x() >= LEFT and lane.contains(at)), None)


def find_cue_at(
    shown: ShownPlayback, scale: LaneScale, height: float, at: QPointF, sizes: Sizes = EVEN
) -> tuple[Layer, Cue] | None:
    """Return the cue under a point."""
    seconds = scale.seconds(at.x())
    for layer in LAYERS:
        if at.x() >= LEFT and split_lane(place_lanes(height, sizes)[layer])[1].contains(at):
            cue = shown.plan.layers[layer].cue_at(seconds)
            return (layer, cue) if cue is not None else None
    return None


@dataclass(frozen=True)
class RequestMark:
    """An ask as it is drawn. at: the seconds it asks for. lost: it will not play. late: by how many
    seconds.
    """

    ask: AnyRequest
    rect: QRectF
    words: str
    kind: str | None
    at: float
    answer: AskAnswer | None

    @property
    def lost(self) -> bool:
        return is_lost(self.answer)

    @property
    def late(self) -> float:
        if self.answer is None or self.answer.at is None or getattr(self.ask, "stroke", None) is not None:
            return 0.0
        return max(0.0, self.answer.at - self.at)


def is_lost(answer: AskAnswer | None) -> bool:
    """Whether an ask will not play."""
    return answer is not None and answer.state == "refused"


def get_ask_time(ask: AnyRequest, answer: AskAnswer | None) -> float:
    """Return when an ask stands in the timeline: when it was wanted, else when it plays."""
    stroke = getattr(ask, "stroke", None)
    if stroke is not None:
        return float(stroke)
    if ask.at is not None:
        return float(ask.at)
    if ask.told is not None:
        return float(ask.told)
    return answer.at if answer is not None and answer.at is not None else 0.0


def place_marks(
    asks: Sequence[AnyRequest],
    answers: Mapping[str, AskAnswer],
    project: Project,
    scale: LaneScale,
    height: float,
    font: QFont,
    shift: Mapping[str, float] | None = None,
    sizes: Sizes = EVEN,
) -> list[RequestMark]:
    """Return what stands in the upper rows, the later on top. shift: seconds by which some are being
    dragged.
    """
    places, key = place_lanes(height, sizes), font.toString()
    areas = {name: split_lane(places[name])[0] for name in NAMES}
    counts = {name: max(1, int((area.height() + 1) // ROW)) for name, area in areas.items()}
    lasts: dict[tuple[str, int], int] = {}  # of each row its last mark, by its place in `out`
    out: list[RequestMark] = []
    timed = sorted(
        (
            (get_ask_time(x, answers.get(x.id)) + (shift or {}).get(x.id, 0.0), n, x)
            for n, x in enumerate(asks)
        ),
        key=lambda t: t[:2],
    )
    for at, _, ask in timed:
        lane, words, left = find_lane(ask, project), describe_request(ask, project), scale.x(at)
        area, count = areas[lane], counts[lane]
        tall = min(TALLEST, (area.height() + 1) / count - 1)
        ends = [out[lasts[lane, n]].rect.right() if (lane, n) in lasts else -1e9 for n in range(count)]
        row = next((n for n, end in enumerate(ends) if end + 3 <= left), None)
        if row is None:  # no row is free: the one whose last began first makes room
            row = min(range(count), key=lambda n: out[lasts[lane, n]].rect.left())
            before = out[lasts[lane, row]]
            rect = QRectF(before.rect)
            rect.setWidth(max(NARROWEST, left - 3 - rect.left()))
            out[lasts[lane, row]] = replace(before, rect=rect)
        rect = QRectF(
            left,
            area.top() + row * (tall + 1),
            max(
                NARROWEST,
                min(
                    260.0,
                    measure_text_width(f"⚠ {words}" if is_lost(answers.get(ask.id)) else words, key) + 16,
                ),
            ),
            tall,
        )
        lasts[lane, row] = len(out)
        out.append(RequestMark(ask, rect, words, ask_kind(ask), at, answers.get(ask.id)))
    return out


def mark_at(found: Sequence[RequestMark], at: QPointF) -> RequestMark | None:
    """Return the mark under a point, the topmost of several."""
    return next((m for m in reversed(found) if m.rect.contains(at) and at.x() >= LEFT), None)


VERBS = make_lazy_texts(
    lambda: {
        "say": tr("Said"),
        "look": tr("Looks"),
        "mode": tr("Changes"),
        "mood": tr("Changes"),
        "place": tr_context("request", "Moves"),
        "blink": tr_context("request", "Blinks"),
    }
)


def describe_outcome(ask: AnyRequest, answer: AskAnswer | None) -> str:
    """Return in one sentence what becomes of an ask; nothing while it is not known."""
    if answer is None:
        return ""
    why = answer.why.rstrip(".")
    if answer.state == "refused":
        return tr("Does not play: {why}.", why=why)
    if answer.at is None:
        return f"{why[:1].upper()}{why[1:]}." if why else ""
    what = ", ".join(w for w in answer.what if w not in ("look", "speech", "mode", "mood", "place", "blink"))
    verb = tr("Plays {what}", what=what) if what else VERBS.get(str(ask.__struct_config__.tag), tr("Plays"))
    if answer.until is not None and answer.at < answer.until < 1e5:
        out = tr("{verb} from {at:.2f} to {until:.2f} s", verb=verb, at=answer.at, until=answer.until)
    else:
        out = tr("{verb} at {at:.2f} s", verb=verb, at=answer.at)
    return f"{out}{f': {why}' if why else ''}."


def describe_wanted(mark: RequestMark) -> str:
    """Return what was asked for, and when."""
    when = (
        tr("at {seconds:.2f} s", seconds=mark.at)
        if getattr(mark.ask, "stroke", None) is None
        else tr("stroke at {seconds:.2f} s", seconds=mark.at)
    )
    return f"{mark.words}, {when}" + (
        tr(", priority {priority}", priority=mark.ask.priority) if mark.ask.priority != 1 else ""
    )


def describe_mark(mark: RequestMark, editable: bool = True) -> str:
    """Return what to say about a mark: what was asked, what came of it, or why nothing did."""
    lines = [describe_wanted(mark), describe_outcome(mark.ask, mark.answer)]
    if editable:
        lines.append(
            tr("Drag to move it in time; Ctrl+drag copies it. Double-click to edit it; Delete withdraws it.")
        )
    return "\n".join(x for x in lines if x)


@lru_cache(maxsize=8192)
def measure_text_width(words: str, font: str) -> float:
    """Return how wide words are in a font, given as `QFont.toString` does."""
    return measure_font(font).horizontalAdvance(words)


@lru_cache(maxsize=8192)
def elide_text(text: str, font: str, width: int) -> str:
    """Return as much of a text as there is room for, from its beginning."""
    return measure_font(font).elidedText(text, Qt.TextElideMode.ElideRight, width)
