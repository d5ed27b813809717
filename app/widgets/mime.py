"""What a drag carries, and the label that goes under the pointer."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from PySide6.QtCore import QMimeData, QRectF, Qt
from PySide6.QtGui import QFontMetricsF, QPainter, QPixmap
from PySide6.QtWidgets import QWidget

from app.project.load import ANNOTATIONS, Load
from app.project.speech_files import kinds_of
from metagraph.formats.clips import SUFFIXES

CLIPS = "application/x-metagraph-clips"
ACTIONS = "application/x-metagraph-actions"


def mime(clips: Sequence[str] = (), actions: Sequence[str] = ()) -> QMimeData:
    """Return what a drag of clips or actions carries."""
    out = QMimeData()
    if clips:
        out.setData(CLIPS, "\n".join(clips).encode())
    if actions:
        out.setData(ACTIONS, "\n".join(actions).encode())
    return out


def load_of(data: QMimeData) -> Load:
    """Return what mime data carries; files that cannot be clips are left out, folders are kept."""
    clips = tuple(bytes(data.data(CLIPS).data()).decode().split("\n")) if data.hasFormat(CLIPS) else ()
    actions = tuple(bytes(data.data(ACTIONS).data()).decode().split("\n")) if data.hasFormat(ACTIONS) else ()
    files = tuple(u.toLocalFile() for u in data.urls() if u.isLocalFile()) if data.hasUrls() else ()
    ends = (*SUFFIXES, ANNOTATIONS)
    return Load(
        clips, actions, tuple(f for f in files if "." not in f.rsplit("/", 1)[-1] or f.lower().endswith(ends))
    )


def sounds_of(data: QMimeData) -> tuple[Path, ...]:
    """Return the sounds that mime data carries, and their transcripts after them; nothing where no sound is
    among them.
    """
    sounds, transcripts = kinds_of([Path(u.toLocalFile()) for u in data.urls() if u.isLocalFile()])
    return (*sounds, *transcripts) if sounds else ()


def drag_picture(text: str, widget: QWidget) -> QPixmap:
    """Return a small label to carry under the pointer."""
    metrics = QFontMetricsF(widget.font())
    ratio = widget.devicePixelRatioF()
    out = QPixmap(round((metrics.horizontalAdvance(text) + 24) * ratio), round(28 * ratio))
    out.setDevicePixelRatio(ratio)
    out.fill(Qt.GlobalColor.transparent)
    painter = QPainter(out)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setBrush(widget.palette().toolTipBase())
    painter.setPen(widget.palette().mid().color())
    rect = out.deviceIndependentSize()
    painter.drawRoundedRect(QRectF(0.5, 0.5, rect.width() - 1, rect.height() - 1), 6, 6)
    painter.setPen(widget.palette().text().color())
    painter.setFont(widget.font())
    painter.drawText(0, 0, round(rect.width()), round(rect.height()), Qt.AlignmentFlag.AlignCenter, text)
    painter.end()
    return out
