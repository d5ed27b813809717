"""Handle the keyboard: commands have their keys in every field, also those of the number pad, and a dialog
returns the focus.
"""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt, QTimer
from PySide6.QtGui import QAction, QKeyEvent, QKeySequence
from PySide6.QtWidgets import QApplication, QDialog, QMainWindow, QWidget
from shiboken6 import isValid

from app.shell.actions import Actions, Standard

# Keys for a field's own text stay with the field.
EDITING = (
    Standard.Undo, Standard.Redo, Standard.Cut, Standard.Copy, Standard.Paste, Standard.SelectAll,
    Standard.Delete, Standard.DeleteStartOfWord, Standard.DeleteEndOfWord, Standard.Backspace,
    Standard.MoveToNextWord, Standard.MoveToPreviousWord, Standard.SelectNextWord,
    Standard.SelectPreviousWord, Standard.MoveToStartOfDocument, Standard.MoveToEndOfDocument,
)  # fmt: skip
HELD = (
    Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier | Qt.KeyboardModifier.MetaModifier
)


class Keyboard(QObject):
    """Watches the focus, and the window for keys that nothing in it handles."""

    def __init__(self, window: QMainWindow, actions: Actions) -> None:
        super().__init__(window)
        self.window, self.actions = window, actions
        self._last: QWidget | None = None
        self._watched: QWidget | None = None
        self._dialogs: set[QDialog] = set()
        application = QApplication.instance()
        assert isinstance(application, QApplication)
        application.focusChanged.connect(self._moved)
        window.installEventFilter(self)

    def _moved(self, old: QWidget | None, new: QWidget | None) -> None:
        left = self._watched
        if left is not None and left is not self.window and isValid(left):  # the window is always watched
            left.removeEventFilter(self)
        self._watched = None
        if new is None:
            return
        over = new.window()
        if isinstance(over, QDialog):
            if over not in self._dialogs and self._of_this(over):
                self._dialogs.add(over)
                over.installEventFilter(self)
        elif self._of_this(over):
            self._last = self._watched = new
            new.installEventFilter(self)

    def _of_this(self, over: QWidget) -> bool:
        """Return whether a window is this one, or belongs to it."""
        at: QWidget | None = over
        while at is not None and at is not self.window:
            at = at.parentWidget()
        return at is not None

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if watched is self.window and event.type() == QEvent.Type.ShortcutOverride:
            self.actions.settle()  # a key may come right after the change that enables its command
            if isinstance(event, QKeyEvent) and self._pad_action(event) is not None:
                event.accept()  # else Qt would take "Num+1" for the plain digit's command
                return True
        if watched is self._watched and event.type() == QEvent.Type.ShortcutOverride:
            return isinstance(event, QKeyEvent) and self._ours(event)
        if watched is self.window and isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            return self._number_pad(event)
        if event.type() == QEvent.Type.Hide and isinstance(watched, QDialog):
            self._dialogs.discard(watched)
            watched.removeEventFilter(self)
            QTimer.singleShot(0, self, self._give_back)
        return False

    def _number_pad(self, event: QKeyEvent) -> bool:
        """Run the command of a number pad's key that nothing in the window handled: on X11, Qt only checks
        shortcuts for the plain digit, never for "Num+3".
        """
        action = self._pad_action(event)
        if action is not None and action.isEnabled():
            action.trigger()
        return action is not None

    def _pad_action(self, event: QKeyEvent) -> QAction | None:
        """Return the command that a key of the number pad belongs to, whether or not it is enabled now."""
        if not event.modifiers() & Qt.KeyboardModifier.KeypadModifier:
            return None
        wanted = QKeySequence(event.keyCombination())
        return next((a for a in self.actions.by_id.values() if wanted in a.shortcuts()), None)

    def _ours(self, event: QKeyEvent) -> bool:
        """Keep a command's key from a field that would use it itself: Ctrl+E goes to the end of a line on
        some systems, and exports here.
        """
        key, held = event.key(), event.modifiers() & HELD
        function = Qt.Key.Key_F1 <= key <= Qt.Key.Key_F35
        if (not held and not function) or any(event.matches(k) for k in EDITING):
            return False
        wanted = QKeySequence(event.keyCombination())
        ours = any(wanted in a.shortcuts() and a.isEnabled() for a in self.actions.by_id.values())
        if ours:
            event.ignore()
        return ours

    def _give_back(self) -> None:
        """Return the focus to the widget that had it before a dialog opened."""
        if not isValid(self.window) or not self.window.isVisible():
            return
        if QApplication.activeModalWidget() is not None or QApplication.activePopupWidget() is not None:
            return
        over = QApplication.activeWindow()
        if isinstance(over, QDialog) and over.isVisible():
            return  # another dialog is used now
        self.window.activateWindow()
        last = self._last
        if last is not None and isValid(last) and last.isVisible() and not last.hasFocus():
            last.setFocus()
