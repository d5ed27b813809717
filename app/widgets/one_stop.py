"""Buttons that stand together as one stop of the Tab key: arrows go from one to the next."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QAbstractButton

STEPS = {Qt.Key.Key_Left: -1, Qt.Key.Key_Right: 1}


class OneStop(QObject):
    """Tab comes to the button that had the keyboard last, at first to `first` or the first of those given;
    Left and Right go to the others. The mouse presses each as ever.
    """

    def __init__(
        self, buttons: Sequence[QAbstractButton], parent: QObject, first: QAbstractButton | None = None
    ) -> None:
        super().__init__(parent)
        self.buttons: list[QAbstractButton] = []
        self.show(buttons)
        self._stop_at(first or next(iter(buttons), None))

    def show(self, buttons: Sequence[QAbstractButton]) -> None:
        """Take other buttons, in their order."""
        for button in buttons:
            if button not in self.buttons:
                button.installEventFilter(self)
        stop = next((b for b in self.buttons if b in buttons and _stops(b)), None)
        self.buttons = list(buttons)
        self._stop_at(stop or next(iter(buttons), None))

    def _stop_at(self, chosen: QAbstractButton | None) -> None:
        for button in self.buttons:
            policy = Qt.FocusPolicy.TabFocus if button is chosen else Qt.FocusPolicy.NoFocus
            button.setFocusPolicy(policy)  # after a click the space bar still plays

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if isinstance(event, QKeyEvent) and watched in self.buttons:
            key = Qt.Key(event.key())
            plain = event.modifiers() == Qt.KeyboardModifier.NoModifier
            if plain and key in STEPS:
                if event.type() == QEvent.Type.ShortcutOverride:
                    event.accept()
                    return True
                if event.type() == QEvent.Type.KeyPress:
                    self._go(watched, key)
                    return True
        return super().eventFilter(watched, event)

    def _go(self, now: QObject, key: Qt.Key) -> None:
        there = [b for b in self.buttons if b.isVisible() and b.isEnabled()]
        place = next((n for n, b in enumerate(there) if b is now), 0)
        to = there[(place + STEPS[key]) % len(there)]
        self._stop_at(to)
        to.setFocus(Qt.FocusReason.OtherFocusReason)


def _stops(button: QAbstractButton) -> bool:
    return button.focusPolicy() == Qt.FocusPolicy.TabFocus
