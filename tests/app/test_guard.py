"""An error in a method that Qt calls is reported, and the program goes on."""

from __future__ import annotations

import importlib
import pkgutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QSize
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QPushButton, QWidget

import app
from app.guard import has_known_answer, is_guarded, is_overridden

ROOT = Path(__file__).resolve().parents[2]
NOT_PYTHON = ("staticMetaObject",)


def classes() -> Iterator[type]:
    """Every class of ours that is made of one of Qt's."""
    from shiboken6 import Shiboken

    for module in pkgutil.walk_packages(app.__path__, "app."):
        if not module.name.endswith("__main__"):
            importlib.import_module(module.name)
    waiting = type.__subclasses__(Shiboken.Object)
    seen = set()
    while waiting:
        cls = waiting.pop()
        waiting += [sub for sub in type.__subclasses__(cls) if sub not in seen]
        if cls not in seen and cls.__module__.startswith("app."):
            yield cls
        seen.add(cls)


def test_every_override_of_ours_is_guarded_and_has_an_answer():
    found = 0
    for cls in classes():
        for name, function in vars(cls).items():
            if is_overridden(cls, name) and name not in NOT_PYTHON:
                found += 1
                assert is_guarded(function), (
                    f"{cls.__qualname__}.{name}: was its class made before the guard?"
                )
                assert has_known_answer(name), (
                    f"say in app/guard.py what {cls.__qualname__}.{name} answers when it fails"
                )
    assert found > 200


FAULTS = """
import sys
import app
from PySide6.QtCore import QAbstractListModel, QModelIndex, QRunnable, QSize, QThreadPool
from PySide6.QtGui import QPainter, QUndoCommand, QUndoStack
from PySide6.QtWidgets import QApplication, QListView, QPushButton, QStyledItemDelegate, QWidget
import numpy as np

def fault():
    kind = sys.argv[1]
    if kind == "zero": 1 / 0
    if kind == "int": int("x")
    if kind == "numpy": np.zeros(3)[7]
    if kind == "raised": raise ValueError("plain")
    if kind == "none": None.x

where, told = "", []
sys.excepthook = lambda *a: told.append(a[0].__name__)

class W(QWidget):
    def paintEvent(self, event):
        painter = QPainter(self)
        painter.drawLine(0, 0, 5, 5)
        if where == "paint": fault()
    def resizeEvent(self, event):
        if where == "resize": fault()
    def sizeHint(self):
        if where == "hint": fault()
        return QSize(5, 5)
    def event(self, event):
        if where == "event": fault()
        return super().event(event)

class M(QAbstractListModel):
    def rowCount(self, parent=QModelIndex()):
        return 3
    def data(self, index, role=0):
        if where == "data": fault()
        return "x" if role == 0 else None

class D(QStyledItemDelegate):
    def paint(self, painter, option, index):
        if where == "delegate": fault()
        super().paint(painter, option, index)

class U(QUndoCommand):
    def redo(self):
        if where == "redo": fault()

class R(QRunnable):
    def run(self):
        if where == "run": fault()

application = QApplication(["x", "-platform", "offscreen"])
w, view, model, stack = W(), QListView(), M(), QUndoStack()
view.setModel(model); view.setItemDelegate(D(view))
b = QPushButton()
b.clicked.connect(lambda: fault() if where == "slot" else None)
for where in ("paint", "resize", "hint", "event", "data", "delegate", "redo", "run", "slot"):
    told.clear()
    print(where, end=" ", flush=True)
    for n in range(3):
        w.resize(30 + n, 30); w.adjustSize(); w.grab(); w.show(); view.show(); view.grab(); b.click()
        stack.push(U()); QThreadPool.globalInstance().start(R()); QThreadPool.globalInstance().waitForDone()
        application.processEvents()
    print("told" if told else "missed", flush=True)
"""


@pytest.mark.parametrize("kind", ["zero", "int", "numpy", "raised", "none"])
def test_an_error_beneath_a_call_into_qt_is_told_and_the_program_goes_on(kind):
    """Each was the end of the program, or could be, without the guard."""
    done = subprocess.run(
        [sys.executable, "-c", FAULTS, kind],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, (done.stdout, done.stderr[-500:])
    assert done.stdout.split()[1::2] == ["told"] * 9, done.stdout


class Broken(QWidget):
    def sizeHint(self):
        raise KeyError("x")

    def paintEvent(self, event):
        self.painter_was = QPainter(self).isActive()
        raise IndexError


class Dialog(QWidget):
    taken = 0

    def closeEvent(self, event, more=3, *, last=4):
        self.taken = (more, last)

    def leaveEvent(self, event=None):
        self.taken += 1


def test_qt_gets_an_answer_and_the_hook_what_was_raised(qtbot, monkeypatch):
    told = []
    monkeypatch.setattr(sys, "excepthook", lambda *a: told.append(a[0]))
    widget = Broken()
    qtbot.addWidget(widget)
    assert widget.sizeHint() == QSize() and told == [KeyError]
    widget.grab()
    assert widget.painter_was and told[-1] is IndexError


def test_a_guarded_method_takes_what_it_took_before(qtbot):
    dialog = Dialog()
    qtbot.addWidget(dialog)
    dialog.closeEvent(None, last=7)
    assert dialog.taken == (3, 7)
    dialog.taken = 0
    button = QPushButton(dialog)
    button.clicked.connect(dialog.leaveEvent)  # `checked` is given, as to any slot that takes one
    button.pressed.connect(dialog.leaveEvent)
    button.click()
    assert dialog.taken == 2


def test_what_is_meant_to_end_the_program_is_let_through(qtbot):
    class Ends(QWidget):
        def sizeHint(self):
            raise KeyboardInterrupt

    widget = Ends()
    qtbot.addWidget(widget)
    with pytest.raises(KeyboardInterrupt):
        widget.sizeHint()
