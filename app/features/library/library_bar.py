"""The strip below the clips: cards or columns, and how large."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QToolButton, QWidget

from app.features.library.clip_sizes import Style, list_sizes
from app.look import icons
from app.look.theme import get_theme
from app.look.theme_choice import ThemeChoice
from app.translation import make_lazy_texts, tr
from app.widgets.making import make_widget
from app.widgets.one_stop import OneStop
from app.widgets.quiet_fields import Scrub

BUTTONS: dict[Style, tuple[str, str, str]] = make_lazy_texts(
    lambda: {
        "cards": (
            "grid",
            tr("Cards"),
            tr("Show pictures. The slider sets their size; at the smallest, each clip is a line."),
        ),
        "columns": (
            "list",
            tr("Columns"),
            tr("Show a list. Click a column title to sort; right-click it to choose columns."),
        ),
    }
)


class LibraryBar(QWidget):
    """changed: a style and a size were chosen."""

    changed = Signal(str, int)

    def __init__(self, look: ThemeChoice, parent: QWidget) -> None:
        super().__init__(parent)
        self.look = look
        self.style_of: Style = "cards"
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 2, 4, 4)
        row.setSpacing(2)
        self.buttons: dict[Style, QToolButton] = {}
        for style, (_, words, tip) in BUTTONS.items():
            button = make_widget(QToolButton, self, toolTip=tip, checkable=True)
            button.setAccessibleName(words)
            button.setIconSize(QSize(16, 16))
            button.setProperty("tight", True)
            button.clicked.connect(lambda _=False, style=style: self.changed.emit(style, -1))
            self.buttons[style] = button
            row.addWidget(button)
        OneStop(tuple(self.buttons.values()), self)
        self.told = QLabel(self)
        self.told.setProperty("dim", True)
        row.addWidget(self.told, 1)
        self.slider = Scrub(Qt.Orientation.Horizontal, self)
        self.slider.setAccessibleName(tr("Clip size"))
        self.slider.setToolTip(
            tr("Set how large clips are shown (Ctrl+wheel; Ctrl++ and Ctrl+- in the list)")
        )
        self.slider.setMinimumWidth(60)
        self.slider.setMaximumWidth(130)
        self.slider.setPageStep(1)
        self.slider.valueChanged.connect(self._slid)
        row.addWidget(self.slider, 1)
        look.changed.connect(self._restyle)
        self._restyle()

    def show_choice(self, style: Style, side: int) -> None:
        """Report what is chosen."""
        self.style_of = style
        for each, button in self.buttons.items():
            button.setChecked(each == style)
        sizes = list_sizes(style)
        self.slider.blockSignals(True)
        self.slider.setRange(0, len(sizes) - 1)
        self.slider.setValue(sizes.index(side))
        self.slider.blockSignals(False)

    def step(self, by: int) -> None:
        """Go to the next size."""
        self.slider.setValue(self.slider.value() + by)

    def _slid(self, place: int) -> None:
        self.changed.emit(self.style_of, list_sizes(self.style_of)[place])

    def _restyle(self) -> None:
        for style, (name, _, _) in BUTTONS.items():
            self.buttons[style].setIcon(icons.make_icon(name, get_theme(self.look.name).text, 16))
