"""Paints the lane of words: the waveform of the voice, and each word under its time."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QPainter, QPen

from app.features.timeline.voices import Voices
from app.look.theme import WindowTheme
from app.widgets.lane_geometry import LEFT, LaneScale, measure_text_width
from app.widgets.waveforms import join_columns, paint_columns

TEXT = 15.0  # pixels of the words' line
LETTERS = 14  # pixels high
GAP = 5.0  # pixels between words at least
FADED, BEHIND = 0.62, 0.4  # of the waveform beside words, and behind them
LOW = 30.0  # pixels below which words stand over the waveform


def paint_voice(
    painter: QPainter,
    t: WindowTheme,
    lane: QRectF,
    scale: LaneScale,
    width: float,
    voices: Voices,
    ratio: float,
) -> None:
    """Paint waveform and words into a lane, or, where it is low, the words over the waveform. ratio: pixels
    of the screen to one of the widget.
    """
    low = lane.height() < LOW
    painter.save()
    painter.setClipRect(QRectF(LEFT, lane.top(), width - LEFT, lane.height()))
    below = 1.0 if low else TEXT + 2
    area = QRectF(LEFT, lane.top() + 2, width - LEFT, max(4.0, lane.height() - below - 2))
    painter.setOpacity(BEHIND if low else 1.0)
    _waves(painter, t, area, scale, width, voices, ratio)
    painter.setOpacity(1.0)
    font = QFont(painter.font())
    font.setPixelSize(LETTERS)
    painter.setFont(font)
    key, free = font.toString(), -1e9
    row = QRectF(0, lane.bottom() - TEXT - 1, 0, TEXT)
    if low:
        row.moveTop(lane.center().y() - TEXT / 2)
    tick = QColor(t.dim)
    for start, end, text in voices.words():
        left, right = scale.x(start), scale.x(end)
        if right < LEFT or left > width:
            continue
        if not low:
            painter.setPen(QPen(tick, 1))
            painter.drawLine(QPointF(left, row.top()), QPointF(left, row.top() + 3))
            painter.drawLine(QPointF(left, row.top()), QPointF(max(left, right - 1), row.top()))
        if left >= free:  # a word for which there is no room is left out, never cut
            painter.setPen(QColor(t.text))
            painter.drawText(
                QRectF(left + 1, row.top(), 400, TEXT),
                Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft,
                text,
            )
            free = left + measure_text_width(text, key) + GAP
    painter.restore()


def _waves(
    painter: QPainter,
    t: WindowTheme,
    area: QRectF,
    scale: LaneScale,
    width: float,
    voices: Voices,
    ratio: float,
) -> None:
    """Paint the waveform of each line that is said, where it is said."""
    color = QColor(t.dim)
    color.setAlphaF(FADED)
    shown = voices.performance.shown
    for speech in shown.plan.track.speeches:
        voice = voices.of(speech.line)
        left, right = max(float(LEFT), scale.x(speech.start)), min(width, scale.x(speech.end))
        if voice is None or voice.wave is None or right - left < 1:
            continue
        wide, high = int((right - left) * ratio), max(2, int(area.height() * ratio))
        first = scale.seconds(left) - speech.start
        low, top = voice.wave.columns(first, scale.each * ratio, wide)
        grow = (high / 2 - 1) / voice.loudest
        upper, lower = join_columns(high / 2 - top * grow, high / 2 - low * grow, 1.0 * ratio)
        picture = paint_columns(upper, lower, high, color)
        picture.setDevicePixelRatio(ratio)
        painter.drawImage(QPointF(left, area.top()), picture)
