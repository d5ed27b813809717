"""What of a window can be told apart: the values of its widgets, of its actions, and of every object of ours
behind them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
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
    seen: set[int] = set()
    window.shell.actions.settle()
    parts = _parts(window, "window")
    for place, part in parts:
        seen.add(id(part))
        if isinstance(part, QWidget):
            out.update((f"{place}.{key}", repr(value)) for key, value in _shown(part))
        elif isinstance(part, QAction):
            what = (part.isEnabled(), part.isChecked(), part.isVisible(), part.text())
            out[f"{place}:{part.objectName() or part.text()}"] = repr(what)
        elif isinstance(part, QTimer) and not part.isSingleShot():
            out[place] = f"{part.isActive()}, every {part.interval()} ms"
    for place, part in parts:
        out.update(_values(part, place, seen))
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


def _parts(window: QObject, name: str) -> list[tuple[str, QObject]]:
    """Return an object and what belongs to it, each with its place; siblings of a class are counted. What is in
    a widget that is hidden is left out: it is filled when it is shown. So is a field's button, which fades.
    """
    out, todo = [], [(name, window)]
    while todo:
        place, part = todo.pop()
        out.append((place, part))
        if isinstance(part, QWidget) and (
            isinstance(part, QLineEdit) or (part.isHidden() and not part.isWindow())
        ):
            continue
        count: dict[str, int] = {}
        for child in part.children():
            if isinstance(child, QTabBar) and isinstance(part, QMainWindow):
                continue  # Qt hands them out anew; docks tell which is in front
            name = child.objectName() or type(child).__name__
            if name.startswith("qt_scrollarea_") and name.endswith("container"):
                continue  # scroll bars are set back, and those of what is behind another panel are laid out when it comes to the front
            n = count[name] = count.get(name, -1) + 1
            todo.append((f"{place}/{name}{n or ''}", child))
    return out


def _shown(w: QWidget) -> Iterator[tuple[str, object]]:
    yield "hidden", w.isHidden()
    if w.isHidden():
        return
    yield "enabled", w.isEnabled()
    if isinstance(w, QDockWidget):
        behind = w.visibleRegion().isEmpty()  # its tab is: it is laid out when it comes to the front
        yield "place", (w.isFloating(), None if behind else w.size().toTuple())
    if isinstance(w, QLabel | QLineEdit | QAbstractButton):
        yield "text", w.text()
    if isinstance(w, QAbstractButton):
        yield "checked", w.isChecked()
    if isinstance(w, QAbstractSpinBox):
        yield "text", w.text()
    if isinstance(w, QAbstractSlider):
        yield "value", w.value()
    if isinstance(w, QComboBox):
        yield "entries", (w.currentIndex(), [w.itemText(n) for n in range(w.count())])
    if isinstance(w, QStackedWidget | QTabWidget | QTabBar):
        yield "current", w.currentIndex()
    if isinstance(w, QStatusBar):
        yield "says", w.currentMessage()


def _ours(value: object) -> bool:
    return type(value).__module__.startswith("app.")


def _values(part: object, place: str, seen: set[int]) -> Iterator[tuple[str, str]]:
    """Give the plain values an object of ours holds, and those of the objects of ours that it alone holds."""
    if not _ours(part):
        return
    held = (
        {f.name: getattr(part, f.name) for f in fields(part)}
        if is_dataclass(part)
        else dict(getattr(part, "__dict__", {}))
    )
    for name, value in held.items():
        if name in PASSING:
            continue
        if isinstance(value, QObject):
            continue
        if _plain(value):
            yield f"{place}.{name}", repr(value)
        elif _ours(value) and id(value) not in seen:
            seen.add(id(value))
            yield from _values(value, f"{place}.{name}", seen)
        elif isinstance(value, list | tuple | set | frozenset | dict):
            yield f"{place}.{name}", f"{len(value)} of {type(value).__name__}"


def _plain(value: object) -> bool:
    if isinstance(value, PLAIN):
        return True
    if isinstance(value, dict):
        return all(_plain(k) and _plain(v) for k, v in value.items())
    return isinstance(value, list | tuple | set | frozenset) and all(map(_plain, value))
