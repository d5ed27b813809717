"""What a drag carries, and the label that goes under the pointer."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from PySide6.QtCore import QMimeData, QRectF, Qt
from PySide6.QtGui import QFontMetricsF, QImage, QPainter, QPixmap
from PySide6.QtWidgets import QWidget

from app.look.shortening import shorten_middle
from app.project.load import ANNOTATIONS, Load
from app.project.speech_files import sort_speech_files
from metagraph.formats.clip_readers import list_clip_suffixes

PICTURE, WIDEST = 84, 200.0  # pixels of what is carried: its picture, its name
CLIPS = "application/x-metagraph-clips"
ACTIONS = "application/x-metagraph-actions"


def make_mime(clips: Sequence[str] = (), actions: Sequence[str] = ()) -> QMimeData:
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
    ends = (*list_clip_suffixes(), ANNOTATIONS)
    return Load(
        clips, actions, tuple(f for f in files if "." not in f.rsplit("/", 1)[-1] or f.lower().endswith(ends))
    )


def read_sound_paths(data: QMimeData) -> tuple[Path, ...]:
    """Return the sounds that mime data carries, and their transcripts after them; nothing if no sound is
    among them.
    """
    sounds, transcripts = sort_speech_files([Path(u.toLocalFile()) for u in data.urls() if u.isLocalFile()])
    return (*sounds, *transcripts) if sounds else ()


def drag_picture(text: str, widget: QWidget, picture: QImage | None = None) -> QPixmap:
    """Return what is carried under the pointer: a card with a picture, where there is one, over a name."""
    metrics = QFontMetricsF(widget.font())
    ratio = widget.devicePixelRatioF()
    text = shorten_middle(text, WIDEST, metrics.horizontalAdvance)
    wide = max(metrics.horizontalAdvance(text) + 24, PICTURE + 16 if picture is not None else 0)
    high = 28 + (PICTURE if picture is not None else 0)
    out = QPixmap(round(wide * ratio), round(high * ratio))
    out.setDevicePixelRatio(ratio)
    out.fill(Qt.GlobalColor.transparent)
    painter = QPainter(out)
    painter.setRenderHints(QPainter.RenderHint.Antialiasing | QPainter.RenderHint.SmoothPixmapTransform)
    painter.setBrush(widget.palette().toolTipBase())
    painter.setPen(widget.palette().mid().color())
    painter.drawRoundedRect(QRectF(0.5, 0.5, wide - 1, high - 1), 6, 6)
    if picture is not None:
        painter.drawImage(QRectF((wide - PICTURE) / 2, 4, PICTURE, PICTURE), picture)
    painter.setPen(widget.palette().text().color())
    painter.setFont(widget.font())
    painter.drawText(QRectF(0, high - 28, wide, 28), Qt.AlignmentFlag.AlignCenter, text)
    painter.end()
    return out
