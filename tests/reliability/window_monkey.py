"""A monkey at the window: xvfb-run -a -s "-screen 0 1680x1050x24" python tests/reliability/window_monkey.py
[--events 20000] [--seed 1] [--width 1280] [--height 720]

Clicks, drags, wheels and keys at random, in every workspace of the sample project, in dialogs and menus too.
It prints each fault with the last events before it, events that took longer than two seconds, and how many
events went where. Exit code 1 where there was a fault. What would leave the window, such as files and the
network, is answered with "nothing".
"""

from __future__ import annotations

import argparse
import os
import random
import sys
import tempfile
import time
from collections import Counter, deque
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
HOME = tempfile.mkdtemp(prefix="metagraph-monkey-")
for name in ("HOME", "XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_CACHE_HOME", "METAGRAPH_DATA"):
    os.environ[name] = HOME
os.environ.setdefault("QT_QPA_PLATFORM", "xcb")

from PySide6.QtCore import QPoint, Qt, QTimer  # noqa: E402
from PySide6.QtGui import QDesktopServices, QDrag  # noqa: E402
from PySide6.QtTest import QTest  # noqa: E402
from PySide6.QtWidgets import QApplication, QFileDialog, QMessageBox, QWidget  # noqa: E402
from shiboken6 import isValid  # noqa: E402

from app import faults  # noqa: E402
from app.features.character import character_panel  # noqa: E402
from app.features.labelling import review_stage  # noqa: E402
from app.main import make_window, prepare_application  # noqa: E402
from app.project.files import SAMPLE  # noqa: E402
from app.shell.workspaces import WORKSPACES  # noqa: E402
from app.stage import gl_view  # noqa: E402

Key, Held, Button = Qt.Key, Qt.KeyboardModifier, Qt.MouseButton
KEYS = [Key(code) for code in (*range(0x20, 0x5B), *range(0x01000030, 0x0100003B))] + [
    Key.Key_Escape, Key.Key_Tab, Key.Key_Backtab, Key.Key_Backspace, Key.Key_Return, Key.Key_Enter,
    Key.Key_Insert, Key.Key_Delete, Key.Key_Home, Key.Key_End, Key.Key_Left, Key.Key_Up, Key.Key_Right,
    Key.Key_Down,
    Key.Key_PageUp, Key.Key_PageDown, Key.Key_Menu,
]  # fmt: skip
HELD = [Held.NoModifier] * 6 + [
    Held.ShiftModifier, Held.ControlModifier, Held.AltModifier, Held.ControlModifier | Held.ShiftModifier,
    Held.ControlModifier | Held.AltModifier, Held.KeypadModifier,
]  # fmt: skip
LEFT_OUT = {
    "quit",
    "extras",
    "news",
    "camera",
    "mimic_camera",
    "live",
    "language",
    "studio",
    "new",
    "generate_motion",
}
SLOW = 2.0  # seconds
TURN = 300  # events in a workspace
LONG_IN_DIALOG = 60  # events after which a dialog is left


class Monkey:
    """Does one event after another. A timer of its own for each, so that it goes on in menus and dialogs."""

    def __init__(self, window: QWidget, events: int, seed: int) -> None:
        self.window, self.left, self.random = window, events, random.Random(seed)
        self.done = 0
        self.last: deque[str] = deque(maxlen=12)
        self.slow: list[str] = []
        self.went: Counter[str] = Counter()
        self.in_dialog = 0
        self.begun, self.said = 0.0, 0

    def go_on(self) -> None:
        if self.left <= 0:
            QApplication.exit(0)
            return
        QTimer.singleShot(
            0, self.go_on
        )  # first: what follows may open a menu, and return when that is closed
        self.left -= 1
        self.done += 1
        begun = time.perf_counter()
        self.event()
        took = time.perf_counter() - begun
        if took > SLOW and self.in_dialog == 0 and QApplication.activeModalWidget() is None:
            self.slow.append(f"event {self.done}: {took:.1f} s, {self.last[-1] if self.last else ''}")
        if self.done % 1000 == 0 and self.done > self.said:
            self.said = self.done
            print(f"{self.done} events, {time.perf_counter() - self.begun:.0f} s", flush=True)

    def event(self) -> None:
        shell = self.window.shell
        if self.done % TURN == 0:
            self.leave()
            shell.workspaces.choose(self.random.choice(WORKSPACES).id)
            if not shell.document.project.clips:
                shell.document.undo_stack.setIndex(0)
        top = QApplication.activePopupWidget() or QApplication.activeModalWidget() or self.window
        if top is not self.window:
            self.in_dialog += 1
            if self.in_dialog > LONG_IN_DIALOG:
                self.leave()
                return
        else:
            self.in_dialog = 0
        parts = [w for w in top.findChildren(QWidget) if w.isVisible() and w.width() > 4 and w.height() > 4]
        part = self.random.choice([top, *parts]) if parts else top
        if not isValid(part) or not part.isVisible():
            return
        if self.random.random() < 0.35:
            key, held = self.random.choice(KEYS), self.random.choice(HELD)
            target = QApplication.focusWidget() or top
            self.note(f"key {key.name} {held.name or ''} to {type(target).__name__}", target)
            QTest.keyClick(target, key, held)
        else:
            self.point(part)

    def point(self, part: QWidget) -> None:
        """Click, double-click, drag or wheel somewhere on a widget."""
        at = QPoint(self.random.randrange(part.width()), self.random.randrange(part.height()))
        held = self.random.choice(HELD[:8])
        kind = self.random.choices(["click", "right", "double", "drag", "wheel", "move"], [5, 1, 1, 3, 1, 1])[
            0
        ]
        self.note(f"{kind} {at.x()},{at.y()} on {type(part).__name__}", part)
        if kind == "click":
            QTest.mouseClick(part, Button.LeftButton, held, at)
        elif kind == "right":
            QTest.mouseClick(part, Button.RightButton, held, at)
        elif kind == "double":
            QTest.mouseDClick(part, Button.LeftButton, held, at)
        elif kind == "wheel":
            QTest.wheelEvent(part.window().windowHandle(), part.mapTo(part.window(), at), QPoint(0, 120))
        elif kind == "move":
            QTest.mouseMove(part, at)
        else:
            QTest.mousePress(part, Button.LeftButton, held, at)
            for _ in range(4):
                if isValid(part):
                    at += QPoint(self.random.randint(-60, 60), self.random.randint(-40, 40))
                    QTest.mouseMove(part, at)
            if isValid(part):
                QTest.mouseRelease(part, Button.LeftButton, held, at)

    def note(self, words: str, part: QWidget) -> None:
        self.last.append(words)
        self.went[type(part.window()).__name__] += 1

    def leave(self) -> None:
        """Leave every menu and dialog."""
        self.in_dialog = 0
        for _ in range(6):
            top = QApplication.activePopupWidget() or QApplication.activeModalWidget()
            if top is None:
                break
            top.close()
        for top in QApplication.topLevelWidgets():
            if top is not self.window and top.isVisible() and top.isWindow():
                top.close()


def answer_nothing() -> None:
    """Let whatever would leave the window return as if it was cancelled."""
    for name in ("getOpenFileName", "getSaveFileName"):
        setattr(QFileDialog, name, staticmethod(lambda *a, **k: ("", "")))
    QFileDialog.getOpenFileNames = staticmethod(lambda *a, **k: ([], ""))
    QFileDialog.getExistingDirectory = staticmethod(lambda *a, **k: "")
    for name in ("question", "warning"):
        setattr(QMessageBox, name, staticmethod(lambda *a, **k: QMessageBox.StandardButton.Cancel))
    QDesktopServices.openUrl = staticmethod(lambda *a: False)
    QDrag.exec = lambda *a: Qt.DropAction.IgnoreAction  # a drag of the system waits for the real mouse


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--events", type=int, default=20_000)
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--width", type=int, default=1280)
    options.add_argument("--height", type=int, default=720)
    given = options.parse_args()
    answer_nothing()
    # In software each picture takes long: fewer and coarser ones leave time for events.
    character_panel.FRAME = character_panel.SOFT_FRAME = review_stage.FRAME = 80
    gl_view.ImageView.coarse = 3
    app = prepare_application()
    app.setQuitOnLastWindowClosed(False)
    window = make_window()
    window.closeEvent = lambda event: event.ignore()  # type: ignore[method-assign]
    window.shell.actions.allowed = lambda command: command.id not in LEFT_OUT
    window.resize(given.width, given.height)
    window.show()
    window.shell.files.open(SAMPLE, template=True)
    monkey = Monkey(window, given.events, given.seed)
    found: list[str] = []

    def tell(fault: faults.UncaughtError | Exception) -> None:
        trace = "".join(getattr(fault, "trace", ())) or repr(fault)
        words = f"FAULT after event {monkey.done}: {getattr(fault, 'what', fault)}\n{trace}"
        found.append(words)
        print(words, "last:", *monkey.last, sep="\n  ", flush=True)

    faults.listeners.append(tell)
    faults.install(Path(HOME) / "faults")
    monkey.begun = time.perf_counter()
    QTimer.singleShot(6000, monkey.go_on)
    app.exec()
    print(f"seed {given.seed}: {monkey.done} events, {len(found)} faults, {len(monkey.slow)} slow")
    print("where:", dict(monkey.went))
    print(*monkey.slow[:20], sep="\n")
    sys.stdout.flush()
    os._exit(1 if found else 0)  # what the monkey left running is nobody's concern


if __name__ == "__main__":
    main()
