"""Show a reference video beside or behind the character, at the playhead's time plus an offset. A thread
reads its pictures. The user's settings store which video belongs to which project.
"""

from __future__ import annotations

import json
import threading
from pathlib import Path

import numpy as np
from PySide6.QtCore import QObject, QRectF, QSettings, Qt, Signal
from PySide6.QtGui import QColor, QImage, QMouseEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QHBoxLayout, QLabel, QToolButton, QWidget

from app.features.character.overlay_host import OverlayHost
from app.look import icons
from app.look.theme import get_theme
from app.translation import tr, tr_error, tr_noop
from app.widgets.making import make_widget
from app.widgets.quiet_fields import ComboBox, DoubleSpinBox
from metagraph.errors import FileError

KEY = "reference"
KEPT = 50  # projects whose videos are remembered
DRAGGED = 0.01  # seconds of offset for each pixel a picture is dragged
FILES = tr_noop("Videos and pictures (*.mp4 *.mov *.mkv *.webm *.avi *.m4v *.png *.jpg *.jpeg)")


class _Reader(QObject):
    """Reads pictures of a file on a thread; of what is requested meanwhile only the last. came: a picture.
    failed: why there is none, in words.
    """

    came = Signal(object)
    failed = Signal(str)

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.path = path
        self._wanted: float | None = None
        self._over = False
        self._turn = threading.Condition()
        self._thread = threading.Thread(target=self._read, daemon=True)

    def start(self) -> None:
        """Start. Call it after the signals are connected."""
        self._thread.start()

    def ask(self, seconds: float) -> None:
        with self._turn:
            self._wanted = seconds
            self._turn.notify()

    def stop(self) -> None:
        """Stop after the picture that is being read."""
        with self._turn:
            self._over = True
            self._turn.notify()
        self._thread.join(5)

    def _read(self) -> None:
        from preview.video_reading import VideoPictures

        video = None
        try:
            video = VideoPictures(self.path)
            last = None
            while True:
                with self._turn:
                    while self._wanted is None and not self._over:
                        self._turn.wait()
                    if self._over:
                        return
                    seconds, self._wanted = self._wanted, None
                picture = video.at(seconds or 0.0)
                if picture is not last:
                    last = picture
                    self.came.emit(picture)
        except FileError as error:
            self.failed.emit(tr_error(error))
        finally:
            if video is not None:
                video.close()


class Reference(QObject):
    """The reference video. changed: signals another video or place. pictured: signals another picture.
    picture: uint8 `[H, W, 3]`, or None. trouble: in words why there is no picture.
    """

    changed = Signal()
    pictured = Signal()

    def __init__(self, panel: OverlayHost) -> None:
        super().__init__(panel.view)
        self.panel = panel
        self.path: Path | None = None
        self.offset, self.behind = 0.0, False
        self.picture: np.ndarray | None = None
        self.trouble = ""
        self._reader: _Reader | None = None
        panel.session.transport.moved.connect(self._ask)
        panel.performance.document.loaded.connect(self._opened)

    def choose(self, path: Path) -> None:
        """Show a video, or a picture, from now on."""
        self._show(path, self.offset if path == self.path else 0.0, self.behind)
        self._keep()

    def close(self) -> None:
        """Show none."""
        self._show(None, 0.0, self.behind)
        self._keep()

    def set_offset(self, seconds: float) -> None:
        """Show the video this many seconds after the playhead."""
        if seconds != self.offset:
            self.offset = seconds
            self._keep()
            self._ask()
            self.changed.emit()

    def set_behind(self, on: bool) -> None:
        if on != self.behind:
            self.behind = on
            self._keep()
            self.changed.emit()

    def stop(self) -> None:
        """Stop reading, when the window closes."""
        if self._reader is not None:
            self._reader.stop()
            self._reader = None

    def _show(self, path: Path | None, offset: float, behind: bool) -> None:
        self.stop()
        self.path, self.offset, self.behind = path, offset, behind
        self.picture, self.trouble = None, ""
        if path is not None and not path.is_file():
            self.trouble = tr(
                "{name} is missing. Put the file back, or choose it again where it is now.", name=path.name
            )
        elif path is not None:
            self._reader = _Reader(path)
            self._reader.came.connect(self._came)
            self._reader.failed.connect(self._failed)
            self._reader.start()
            self._ask()
        self.changed.emit()

    def _ask(self, *_: object) -> None:
        if self._reader is not None:
            self._reader.ask(self.panel.session.transport.seconds + self.offset)

    def _came(self, picture: np.ndarray) -> None:
        if self.sender() is self._reader:
            self.picture = picture
            self.pictured.emit()
            if self.behind:
                self.panel.view.update()

    def _failed(self, words: str) -> None:
        if self.sender() is self._reader:
            self.stop()
            self.picture, self.trouble = None, words
            self.changed.emit()

    # --- kept by project

    def _project(self) -> str:
        path = self.panel.performance.document.path
        return str(path) if path is not None else ""

    def _opened(self, *_: object) -> None:
        found = _kept().get(self._project()) if self._project() else None
        if found is not None:
            self._show(Path(str(found[0])), float(found[1]), bool(found[2]))
        elif self.path is not None:
            self._show(None, 0.0, self.behind)

    def _keep(self) -> None:
        name, kept = self._project(), _kept()
        if not name:
            return
        kept.pop(name, None)
        if self.path is not None:
            kept[name] = [str(self.path), self.offset, self.behind]
        QSettings().setValue(KEY, json.dumps(dict(list(kept.items())[-KEPT:])))


def _kept() -> dict[str, list[str | float | bool]]:
    """Return by project: file, offset and whether it is behind. What cannot be read is left out."""
    try:
        found = json.loads(str(QSettings().value(KEY) or "{}"))
        return {k: v for k, v in found.items() if isinstance(v, list) and len(v) == 3}
    except (ValueError, AttributeError):
        return {}


class ReferencePicture(QWidget):
    """The picture beside the view. A drag to the left or right changes its time."""

    def __init__(self, reference: Reference, parent: QWidget) -> None:
        super().__init__(parent)
        self.reference = reference
        self._from: tuple[float, float] | None = None  # where a drag began, and the offset then
        self.setMinimumSize(120, 100)
        self.setCursor(Qt.CursorShape.SizeHorCursor)
        self.setToolTip(tr("Drag left or right to shift the video in time relative to the character"))
        self.setAccessibleName(tr("Reference video"))
        reference.changed.connect(self._follow)
        reference.pictured.connect(self.update)
        self._follow()

    def _follow(self) -> None:
        self.setVisible(self.reference.path is not None and not self.reference.behind)
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        look = get_theme(self.reference.panel.session.look.name)
        painter = QPainter(self)
        painter.fillRect(self.rect(), QColor(look.ground))
        picture = self.reference.picture
        if picture is not None:
            high, wide = picture.shape[:2]
            image = QImage(picture.data, wide, high, 3 * wide, QImage.Format.Format_RGB888)
            scale = min(self.width() / wide, self.height() / high)
            room = QRectF(0, 0, wide * scale, high * scale)
            room.moveCenter(QRectF(self.rect()).center())
            painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
            painter.drawImage(room, image)
        else:
            painter.setPen(QColor(look.text))
            words = self.reference.trouble or tr("Reading…")
            room = QRectF(self.rect()).adjusted(12, 12, -12, -12)
            painter.drawText(room, Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap, words)
        painter.end()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self._from = event.position().x(), self.reference.offset

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._from is not None:
            moved = (event.position().x() - self._from[0]) * DRAGGED
            self.reference.set_offset(round(self._from[1] + moved, 2))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self._from = None


class ReferenceBar(QWidget):
    """A row below the view with the video's name, offset and place, and a button that closes it."""

    def __init__(self, reference: Reference, parent: QWidget) -> None:
        super().__init__(parent)
        self.reference = reference
        row = QHBoxLayout(self)
        row.setContentsMargins(12, 2, 8, 2)
        self.words = QLabel(self)
        self.words.setProperty("dim", True)
        self.words.setMinimumWidth(20)
        self.offset = DoubleSpinBox(self, minimum=-36000, maximum=36000, decimals=2, singleStep=0.04)
        self.offset.setSuffix(" s")
        self.offset.setPrefix(tr("offset "))
        self.offset.setAccessibleName(tr("Offset of the reference video"))
        self.offset.setToolTip(tr("How far the video runs ahead of the playhead"))
        self.offset.valueChanged.connect(reference.set_offset)
        self.place = ComboBox(self, toolTip=tr("Where the video is shown"))
        self.place.setAccessibleName(tr("Position of the reference video"))
        self.place.addItems([tr("Beside"), tr("Behind")])
        self.place.activated.connect(lambda n: reference.set_behind(n == 1))
        self.gone = make_widget(QToolButton, self, toolTip=tr("Close the reference video"))
        self.gone.setAccessibleName(tr("Close the reference video"))
        self.gone.clicked.connect(reference.close)
        row.addWidget(self.words, 1)
        for part in (self.offset, self.place, self.gone):
            part.setFocusPolicy(
                Qt.FocusPolicy.StrongFocus if part is self.offset else Qt.FocusPolicy.TabFocus
            )
            row.addWidget(part)
        reference.changed.connect(self._follow)
        self._follow()

    def _follow(self) -> None:
        reference = self.reference
        self.setVisible(reference.path is not None and not reference.panel.bare)
        if reference.path is None:
            return
        self.gone.setIcon(icons.make_icon("remove", get_theme(reference.panel.session.look.name).text))
        told = "⚠ " + reference.trouble if reference.trouble and reference.behind else reference.path.name
        metrics = self.words.fontMetrics()
        self.words.setText(
            metrics.elidedText(told, Qt.TextElideMode.ElideMiddle, max(60, self.words.width()))
        )
        self.words.setToolTip(reference.trouble or str(reference.path))
        self.place.setCurrentIndex(int(reference.behind))
        if not self.offset.hasFocus() or self.offset.value() != reference.offset:
            self.offset.blockSignals(True)
            self.offset.setValue(reference.offset)
            self.offset.blockSignals(False)
