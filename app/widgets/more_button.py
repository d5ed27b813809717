"""The button with three dots, for the rarer commands of a panel."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QMenu, QToolButton, QWidget

from app.look import icons
from app.look.theme import get_theme
from app.look.theme_choice import ThemeChoice


class MoreButton(QToolButton):
    """menu: opened by a click. name: told where it cannot be seen. tip: what is in the menu. mark: another
    icon than the dots.
    """

    def __init__(self, look: ThemeChoice, name: str, tip: str, parent: QWidget, mark: str = "more") -> None:
        super().__init__(parent)
        self._mark = mark
        self.setText("…")
        self.setToolTip(tip)
        self.look = look
        self.menu_of = QMenu(self)
        self.menu_of.setToolTipsVisible(True)
        self.setAccessibleName(name)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)  # after a click the space bar still plays
        self.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonIconOnly)
        self.setProperty("tight", True)
        self.setMenu(self.menu_of)
        look.changed.connect(self._restyle)
        self._restyle()

    def show_words(self, words: str) -> None:
        """Stand for what was chosen in the menu, "" for the dots alone."""
        beside, alone = (
            Qt.ToolButtonStyle.ToolButtonTextBesideIcon,
            Qt.ToolButtonStyle.ToolButtonIconOnly,
        )
        self.setText(words or "…")
        self.setToolButtonStyle(beside if words else alone)

    def _restyle(self) -> None:
        self.setIcon(icons.make_icon(self._mark, get_theme(self.look.name).text))
