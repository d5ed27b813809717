"""Show what crashes left, each with a name, a time and a picture, to recover, copy, keep or discard."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen, QWheelEvent
from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QGridLayout,
    QLabel,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from app.look.plural import count_clips
from app.look.theme import get_theme, strengthen
from app.project.leftovers import FoundJournal
from app.project.questions import describe_moment
from app.translation import make_lazy_texts, tr, tr_plural
from metagraph.common.files import is_file
from metagraph.errors import FileError
from metagraph.formats.project.journal_records import LostEdit
from metagraph.formats.project.journal_search import project_of
from metagraph.formats.recovery import Left
from metagraph.formats.store import read_project
from metagraph.graph.model import KINDS, LAYERS, Project
from metagraph.motion.clip import Clip
from preview.joints import find_drawn_joints, find_nearest_above

Choice = Literal["recover", "copy", "later", "discard"]
WORDS: dict[Choice, str] = make_lazy_texts(
    lambda: {
        "recover": tr("Recover"),
        "copy": tr("Save as a copy beside the project"),
        "later": tr("Keep for later"),
        "discard": tr("Discard"),
    }
)
PICTURE = QSize(132, 76)  # pixels
LOST = 5  # damaged edits that are named
SHOWN = 4  # sittings that are visible at once


def describe_left(left: Left, saved: Path | None) -> tuple[str, str]:
    """Return the name of a sitting, and what to know about it. `saved` is the project that is being opened;
    None if all sittings are listed.
    """
    named = saved or project_of(left.path)
    name = named.name if named is not None else left.project.name or tr("untitled")
    count = sum(1 for _ in left.project.actions())
    actions = tr_plural("{count:,} action", "{count:,} actions", count)
    words = [
        tr_plural(
            "{count:,} unsaved edit, made at {moment}",
            "{count:,} unsaved edits, the last at {moment}",
            left.edits,
            moment=describe_moment(left.written),
        ),
        f"{count_clips(len(left.project.clips))}, {actions}",
    ]
    if saved is not None and left.saved is not None and left.saved.name != saved.name:
        words.append(tr("Made when the project file was named {name}", name=left.saved.name))
    if saved is None and named is not None:
        words.append(tr("In {folder}", folder=named.parent))
    if named is not None and not is_file(named):
        words.append(tr("The project file no longer exists. Its text is kept with the edits."))
    elif named is not None and left.behind and is_junk(named):
        words.append(tr("The project file can no longer be read. Its text is kept with the edits."))
    elif left.behind:
        words.append(tr("Someone else has saved the file since then. The two versions can be merged."))
    if left.worked_in:
        words.append(tr("The file has changed since then. The edits are merged into its current state."))
    words += describe_lost(left)
    return name if named is not None else tr("{name}, never saved", name=name), "\n".join(words)


def describe_lost(left: Left) -> list[str]:
    """Return what a damaged journal cannot give back, one line each; nothing for a complete one."""
    words = []
    if left.lost:
        words.append(
            tr_plural(
                "{count:,} edit is damaged and cannot be recovered:",
                "{count:,} edits are damaged and cannot be recovered:",
                len(left.lost),
            )
        )
        words += [_lost_edit(lost) for lost in left.lost[:LOST]]
        if len(left.lost) > LOST:
            words.append(tr("and {count} more", count=len(left.lost) - LOST))
    if left.doubtful:
        words.append(
            tr(
                "The project that the edits start from is damaged, too, so one of its values may be "
                "wrong. Check it."
            )
        )
    return words


def _lost_edit(lost: LostEdit) -> str:
    step = tr("'{step}'", step=lost.step) if lost.step else tr("an edit whose name is damaged, too")
    if lost.at is None:
        return step
    return tr("{step}, at {moment}", step=step, moment=describe_moment(lost.at))


def is_junk(path: Path) -> bool:
    """Return whether a project file cannot be read."""
    try:
        read_project(path, [])
    except FileError:
        return True
    return False


def ask_recover(window: QWidget, found: FoundJournal, saved: Path | None) -> tuple[Choice, ...] | None:
    """Ask what becomes of each sitting; None if the user postpones it. At most one is recovered."""
    dialog = RecoverDialog(found, saved, window)
    taken = dialog.exec() == QDialog.DialogCode.Accepted
    choices = dialog.choices()
    dialog.deleteLater()
    return choices if taken else None


class ChoiceField(QComboBox):
    """Chooses what becomes of a sitting; scrolling never changes it."""

    def wheelEvent(self, event: QWheelEvent) -> None:
        event.ignore()


class RecoverDialog(QDialog):
    """A row for each sitting that a crash ended, the latest first."""

    def __init__(self, found: FoundJournal, saved: Path | None, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle(tr("Recover edits?"))
        layout = QVBoxLayout(self)
        layout.setContentsMargins(16, 14, 16, 14)
        layout.setSpacing(10)
        title = (
            tr("{name} was not closed properly", name=saved.name) if saved is not None else tr("Unsaved work")
        )
        heading = QLabel(title, self)
        heading.setProperty("heading", True)
        layout.addWidget(heading)
        rows = QWidget(self)
        grid = QGridLayout(rows)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(14)
        grid.setVerticalSpacing(10)
        grid.setColumnStretch(1, 1)
        self.fields: list[ChoiceField] = []
        offered: list[Choice] = ["recover", "copy", "later", "discard"]
        if saved is None:
            offered.remove("copy")  # there is no project file to save it beside
        for n, left in enumerate(found.left):
            name, words = describe_left(left, saved)
            grid.addWidget(SittingPicture(left.project, found.poses.get(left.path), rows), n, 0)
            told = QLabel(f"<b>{_escaped(name)}</b><br>{_escaped(words)}", rows)
            told.setTextFormat(Qt.TextFormat.RichText)
            told.setWordWrap(True)
            told.setMinimumWidth(300)
            grid.addWidget(told, n, 1)
            field = ChoiceField(rows)
            for choice in offered:
                field.addItem(WORDS[choice], choice)
            field.setCurrentIndex(0 if n == 0 else offered.index("later"))
            field.setAccessibleName(tr("What to do with {name}", name=name))
            field.activated.connect(lambda _, chosen=field: self._only(chosen))
            grid.addWidget(field, n, 2)
            self.fields.append(field)
        layout.addWidget(_scrolled(rows, len(found.left), self), 1)
        if found.notes:
            notes = QLabel("\n".join(found.notes), self)
            notes.setWordWrap(True)
            notes.setProperty("dim", True)
            layout.addWidget(notes)
        buttons = QDialogButtonBox(self)
        go = buttons.addButton(tr("Continue"), QDialogButtonBox.ButtonRole.AcceptRole)
        put_off = tr("Cancel") if saved is not None else tr("Not now")
        buttons.addButton(put_off, QDialogButtonBox.ButtonRole.RejectRole).setToolTip(
            tr("Everything stays as it is")
        )
        strengthen(go)
        go.setDefault(True)
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        layout.addWidget(buttons)

    def choices(self) -> tuple[Choice, ...]:
        """Return the choice for each sitting, in the given order."""
        return tuple(field.currentData() for field in self.fields)

    def _only(self, chosen: ChoiceField) -> None:
        """Let a window recover only one of them."""
        if chosen.currentData() == "recover":
            for field in self.fields:
                if field is not chosen and field.currentData() == "recover":
                    field.setCurrentIndex(field.findData("later"))


def _scrolled(rows: QWidget, count: int, parent: QWidget) -> QWidget:
    if count <= SHOWN:
        return rows
    area = QScrollArea(parent)
    area.setWidget(rows)
    area.setWidgetResizable(True)
    area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
    area.setMinimumSize(rows.sizeHint().width() + 24, SHOWN * (PICTURE.height() + 12))
    return area


def _escaped(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace("\n", "<br>")


class SittingPicture(QWidget):
    """The figure in its first pose, beside the content of the layers, to recognise a sitting at a glance."""

    def __init__(self, project: Project, clip: Clip | None, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.project = project
        self._figure = _figure(clip) if clip is not None else None
        self.setFixedSize(PICTURE)
        self.setAccessibleName(tr("Preview of its contents"))

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        box = QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5)
        painter.setPen(QPen(self.palette().mid().color(), 1))
        painter.setBrush(self.palette().base())
        painter.drawRoundedRect(box, 5, 5)
        if self._figure is not None:
            self._paint_figure(painter, QRectF(8, 8, 44, box.height() - 16))
        left = 62.0 if self._figure is not None else 10.0
        self._paint_layers(painter, QRectF(left, 10, box.width() - left - 9, box.height() - 20))
        painter.end()

    def _paint_figure(self, painter: QPainter, room: QRectF) -> None:
        assert self._figure is not None
        low, high = self._figure.min((0, 1)), self._figure.max((0, 1))
        scale = min(room.width() / max(high[0] - low[0], 1e-6), room.height() / max(high[1] - low[1], 1e-6))
        x, y = room.center().x(), room.bottom()
        middle = (low[0] + high[0]) / 2
        painter.setPen(
            QPen(self.palette().text().color(), 1.6, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap)
        )
        for bone in self._figure.tolist():
            painter.drawLine(*(QPointF(x + scale * (a - middle), y - scale * (b - low[1])) for a, b in bone))

    def _paint_layers(self, painter: QPainter, room: QRectF) -> None:
        """Paint a bar for each layer, in the colours of what is on it."""
        look = get_theme("dark" if self.palette().window().color().lightness() < 128 else "light")
        high = room.height() / len(LAYERS)
        counts = {
            layer: {k: sum(a.kind == k for a in self.project.graphs[layer].actions.values()) for k in KINDS}
            for layer in LAYERS
        }
        most = max(max(sum(some.values()) for some in counts.values()), 1)
        painter.setPen(Qt.PenStyle.NoPen)
        for n, layer in enumerate(LAYERS):
            bar = QRectF(room.left(), room.top() + n * high + 3, room.width(), high - 6)
            painter.setBrush(QColor(look.hover))
            painter.drawRoundedRect(bar, 2, 2)
            for kind in KINDS:
                bar.setWidth(room.width() * counts[layer][kind] / most)
                painter.setBrush(look.fill(kind))
                painter.drawRect(bar)
                bar.moveLeft(bar.right())


def _figure(clip: Clip) -> np.ndarray | None:
    """Return the bones of a clip's first pose, as in the preview's stick figure: where each begins and ends,
    across and up `[B, 2, 2]`. None if there are none.
    """
    skeleton = clip.skeleton
    if len(skeleton) < 2 or not clip.frames:
        return None
    places = skeleton.globals(clip.poses()[:1])[1][0]
    if not np.isfinite(places).all():
        return None
    shown = find_drawn_joints(skeleton)
    starts = find_nearest_above(skeleton, shown)
    ends = np.flatnonzero(shown & (starts >= 0))
    turned = np.stack([0.88 * places[:, 0] + 0.47 * places[:, 2], places[:, 1]], -1)
    return turned[np.stack([starts[ends], ends], -1)] if len(ends) else None
