"""What is dragged on the timeline holds to what is near: markers, words, beginnings, strokes and ends of what
plays, requests, the playhead, the ruler's seconds.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass

from PySide6.QtCore import QSettings

from app.look.names import make_readable_name
from app.stage.performance import StagePerformance
from app.translation import format_number, make_lazy_texts, tr
from app.widgets.lane_geometry import LaneScale, RequestMark
from metagraph.playback.timing.phases import find_phases

WORDS = make_lazy_texts(lambda: {"in": tr("start of the loop range"), "out": tr("end of the loop range")})
REACH = 8.0  # pixels from which something is drawn to a line; ours
WIDE = 24.0  # pixels of a gesture from which its stroke is a line of its own
SETTING = "timeline/magnet"


@dataclass(frozen=True)
class SnapLine:
    """A moment that others hold to, and what it is. weak: only if nothing else is near."""

    at: float
    what: str
    weak: bool = False


def find_nearest_line(seconds: float, lines: Iterable[SnapLine], within: float) -> SnapLine | None:
    """Return the line nearest to a time, at most so many seconds away; a weak one if there is no other."""
    near = [line for line in lines if abs(line.at - seconds) <= within]
    return min(near, key=lambda line: (line.weak, abs(line.at - seconds)), default=None)


def snap_lines(
    performance: StagePerformance,
    marks: Sequence[RequestMark],
    words: Sequence[tuple[float, float, str]],
    scale: LaneScale,
    width: float,
    but: Collection[str] = (),
) -> list[SnapLine]:
    """Return the lines in sight. words: first and last second and text. but: ids of requests and markers that
    are dragged themselves, and "in", "out" of the range.
    """
    begin, end = scale.seconds(0), scale.seconds(width)
    shown, noted = performance.shown, performance.timeline.now
    out = [SnapLine(m.at, tr("marker {name}", name=m.name).strip()) for m in noted.markers if m.id not in but]
    if noted.range is not None:
        ends = zip(("in", "out"), noted.range, strict=True)
        out += [SnapLine(at, WORDS[name]) for name, at in ends if name not in but]
    out += [SnapLine(m.at, m.words) for m in marks if m.ask.id not in but]
    for first, last, text in words:
        out += [SnapLine(first, f"'{text}'"), SnapLine(last, tr("end of '{word}'", word=text))]
    for of in shown.plan.layers.values():
        for cue in of.cues:
            if cue.end < begin or cue.start > end or cue.meta.partition("+")[0] in but:
                continue
            name = make_readable_name(cue.action.name)
            out += [
                SnapLine(cue.start, tr("start of {name}", name=name)),
                SnapLine(cue.end, tr("end of {name}", name=name)),
            ]
            if cue.action.kind == "gesture" and (cue.end - cue.start) * scale.each >= WIDE:
                stroke = find_phases(shown.project, cue.action).stroke
                if cue.entry <= stroke <= cue.once.last:
                    out.append(
                        SnapLine(
                            cue.start + (stroke - cue.entry) / cue.tempo, tr("stroke of {name}", name=name)
                        )
                    )
    out.append(SnapLine(performance.session.transport.seconds, tr("playhead")))
    if performance.ends:
        out.append(SnapLine(shown.length, tr("end")))
    step = scale.step() / (5 if scale.step() * scale.each > 200 else 1)
    first = int(max(0.0, begin) // step)
    out += [
        SnapLine(round(n * step, 3), f"{format_number(n * step, 'g')} s", True)
        for n in range(first, int(end / step) + 2)
    ]
    return [line for line in out if begin - 1 <= line.at <= end + 1]


class Magnet:
    """Whether what is dragged snaps, and to which line it holds now. held_off: the key for without is
    held.
    """

    def __init__(self) -> None:
        self.on = QSettings().value(SETTING, "true") != "false"
        self.held_off = False
        self.line: SnapLine | None = None
        self._lines: list[SnapLine] = []

    def set_on(self, on: bool) -> None:
        self.on = on
        QSettings().setValue(SETTING, "true" if on else "false")

    def begin(self, lines: list[SnapLine]) -> None:
        self._lines, self.line = lines, None

    def end(self) -> None:
        self._lines, self.line = [], None

    def snap(self, seconds: float, each: float) -> float:
        """Return where a time goes. each: pixels a second."""
        free = self.held_off or not self.on
        self.line = None if free else find_nearest_line(seconds, self._lines, REACH / each)
        return seconds if self.line is None else max(0.0, self.line.at)
