"""What of a window can be distinguished: the values of its widgets, of its actions, and of every object of
ours behind them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import cache
from pathlib import Path
from typing import Any

from PySide6.QtCore import QObject, QSettings, QTimer
from PySide6.QtGui import QAction
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractSlider,
    QAbstractSpinBox,
    QComboBox,
    QDockWidget,
    QLabel,
    QLineEdit,
    QMainWindow,
    QStackedWidget,
    QStatusBar,
    QTabBar,
    QTabWidget,
    QWidget,
)

PLAIN = (bool, int, float, str, bytes, Path, Enum, type(None))
SIMPLE = frozenset((bool, int, float, str, bytes, type(None)))  # most values are of these very classes
CONTAINERS = (list, tuple, set, frozenset, dict)
# What differs without a difference: what is counted, kept for speed, or drawn from it when there is occasion.
PASSING = frozenset(
    """common frames owner painted pictures seconds sounds _beat _bodies _by_keys _came _clips _counted _curves
    _dialogs _era _guests _journal _known _last _layout _marks _matrices _missing _named _paths _places
    _drawn _waiting _colors _owns
    _held _listed _moved
    _plan_seconds _played _read _rest _rows _skinned _fitted _footings _still _voices _watched layout_of""".split()  # noqa: SIM905 - thirty quotes more to read
)


def state_of(window: Any) -> dict[str, str]:
    """Return by where it stands in the window everything that a test could have changed, in words."""
    out: dict[str, str] = {}
    window.shell.actions.settle()
    parts = _parts(window, "window")
    seen = {id(part) for _, part in parts}
    for place, part in parts:
        for kind in _kinds(type(part)):
            kind(part, place, out)
    for place, part in parts:
        if _ours(part):
            _values(part, place, seen, out)
    settings = QSettings()
    out["settings"] = repr({k: settings.value(k) for k in settings.allKeys()})
    return out


def differences(before: Mapping[str, str], after: Mapping[str, str]) -> list[str]:
    """Return what is another value now, and what is gone; more than there was may be there."""
    return [
        f"{key}: {value} -> {after.get(key, 'gone')}"
        for key, value in before.items()
        if after.get(key, "gone") != value
    ]


def _parts(window: QObject, name: str) -> list[tuple[str, Any]]:
    """Return an object and what belongs to it, each with its place; siblings of a class are counted. What is in
    a widget that is hidden is left out: it is filled when it is shown. So is a field's button, which fades.
    """
    out: list[tuple[str, Any]] = []
    todo: list[tuple[str, Any]] = [(name, window)]
    while todo:
        place, part = todo.pop()
        out.append((place, part))
        widget, field, main = _nature(type(part))
        if field or (widget and part.isHidden() and not part.isWindow()):
            continue
        children = part.children()
        if not children:
            continue
        count: dict[str, int] = {}
        for child in children:
            if main and isinstance(child, QTabBar):
                continue  # Qt hands them out again; docks tell which is in front
            name = child.objectName() or type(child).__name__
            if name.startswith("qt_scrollarea_") and name.endswith("container"):
                continue  # scroll bars are set back, and those of what is behind another panel are laid out when it comes to the front
            n = count[name] = count.get(name, -1) + 1
            todo.append((f"{place}/{name}{n or ''}", child))
    return out


@cache
def _nature(of: type) -> tuple[bool, bool, bool]:
    return issubclass(of, QWidget), issubclass(of, QLineEdit), issubclass(of, QMainWindow)


def _tell_action(action: QAction, place: str, out: dict[str, str]) -> None:
    what = (action.isEnabled(), action.isChecked(), action.isVisible(), action.text())
    out[f"{place}:{action.objectName() or what[-1]}"] = repr(what)


def _tell_timer(timer: QTimer, place: str, out: dict[str, str]) -> None:
    if not timer.isSingleShot():
        out[place] = f"{timer.isActive()}, every {timer.interval()} ms"


def _tell_widget(w: QWidget, place: str, out: dict[str, str]) -> None:
    hidden = w.isHidden()
    out[f"{place}.hidden"] = repr(hidden)
    if not hidden:
        out[f"{place}.enabled"] = repr(w.isEnabled())


def _dock_place(dock: QDockWidget) -> object:
    behind = dock.visibleRegion().isEmpty()  # its tab is: it is laid out when it comes to the front
    return (dock.isFloating(), None if behind else dock.size().toTuple())


# What is reported about a widget that is not hidden, by its class.
SHOWN: tuple[tuple[type | tuple[type, ...], str, Callable[[Any], object]], ...] = (
    (QDockWidget, "place", _dock_place),
    ((QLabel, QLineEdit, QAbstractButton), "text", lambda w: w.text()),
    (QAbstractButton, "checked", lambda w: w.isChecked()),
    (QAbstractSpinBox, "text", lambda w: w.text()),
    (QAbstractSlider, "value", lambda w: w.value()),
    (QComboBox, "entries", lambda w: (w.currentIndex(), [w.itemText(n) for n in range(w.count())])),
    ((QStackedWidget, QTabWidget, QTabBar), "current", lambda w: w.currentIndex()),
    (QStatusBar, "says", lambda w: w.currentMessage()),
)
Tell = Callable[[Any, str, dict[str, str]], None]


@cache
def _kinds(of: type) -> tuple[Tell, ...]:
    """Return what tells the values of a class of widgets, actions or timers."""
    if issubclass(of, QAction):
        return (_tell_action,)
    if issubclass(of, QTimer):
        return (_tell_timer,)
    if not issubclass(of, QWidget):
        return ()

    def one(key: str, get: Callable[[Any], object]) -> Tell:
        def tell(w: QWidget, place: str, out: dict[str, str]) -> None:
            if not w.isHidden():
                out[f"{place}.{key}"] = repr(get(w))

        return tell

    return (_tell_widget, *(one(key, get) for kind, key, get in SHOWN if issubclass(of, kind)))


@cache
def is_ours(of: type) -> bool:
    return of.__module__.startswith("app.")


def _ours(value: object) -> bool:
    return is_ours(type(value))


def _values(part: object, place: str, seen: set[int], out: dict[str, str]) -> None:
    """Note the plain values an object of ours holds, and those of the objects of ours that it alone holds."""
    held = (
        {f.name: getattr(part, f.name) for f in fields(part)}
        if is_dataclass(part)
        else getattr(part, "__dict__", {})
    )
    for name, value in held.items():
        if name in PASSING or isinstance(value, QObject):
            continue
        if _plain(value):
            out[f"{place}.{name}"] = repr(value)
        elif _ours(value):
            if id(value) not in seen:
                seen.add(id(value))
                _values(value, f"{place}.{name}", seen, out)
        elif isinstance(value, CONTAINERS):
            out[f"{place}.{name}"] = f"{len(value)} of {type(value).__name__}"


def _plain(value: object) -> bool:
    of = type(value)
    if of in SIMPLE or isinstance(value, PLAIN):
        return True
    if isinstance(value, dict):
        return all(_plain(k) and _plain(v) for k, v in value.items())
    return isinstance(value, CONTAINERS) and all(map(_plain, value))
