"""Puts docks into the areas of a workspace, and gives each area its share."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDockWidget, QMainWindow

from app.shell.workspaces import Split, Workspace

Filled = Mapping[str, Sequence[QDockWidget]]  # the docks of each area, the one in front first


def arrange(
    window: QMainWindow, docks: Sequence[QDockWidget], workspace: Workspace, filled: Filled, shown: set[str]
) -> None:
    """Put all docks where a workspace has them. docks: all. filled: where each belongs. shown: the object
    names of those that are to be seen; the others keep a place for when they are opened.
    """
    for dock in docks:
        dock.setFloating(False)
        window.removeDockWidget(dock)
    first = _corner(workspace.tree, filled)
    if first is None:
        return
    window.addDockWidget(Qt.DockWidgetArea.LeftDockWidgetArea, first)
    _divide(window, workspace.tree, filled)
    for there in filled.values():
        for before, dock in pairwise(there):
            window.tabifyDockWidget(before, dock)
    for dock in docks:
        dock.setVisible(dock.objectName() in shown)
    for there in filled.values():
        front = next((d for d in there if d.objectName() in shown), None)
        if front is not None:
            front.raise_()


def share(window: QMainWindow, workspace: Workspace, filled: Filled) -> None:
    """Give each area its usual share of the window."""
    _share(window, workspace.tree, filled)


def _corner(part: str | Split, filled: Filled) -> QDockWidget | None:
    """Return the first dock of a part."""
    if isinstance(part, str):
        return next(iter(filled.get(part, ())), None)
    return next((d for inner, _ in part.parts if (d := _corner(inner, filled)) is not None), None)


def _divide(window: QMainWindow, part: str | Split, filled: Filled) -> None:
    """Split a part whose first dock is in place."""
    if isinstance(part, str):
        return
    along = Qt.Orientation.Vertical if part.down else Qt.Orientation.Horizontal
    there = [(inner, d) for inner, _ in part.parts if (d := _corner(inner, filled)) is not None]
    for (_, before), (_, dock) in pairwise(there):
        window.splitDockWidget(before, dock, along)
    for inner, _ in there:
        _divide(window, inner, filled)


def _share(window: QMainWindow, part: str | Split, filled: Filled) -> None:
    if isinstance(part, str):
        return
    along = Qt.Orientation.Vertical if part.down else Qt.Orientation.Horizontal
    whole = window.height() if part.down else window.width()
    seen = [(d, size) for inner, size in part.parts if (d := _handle(inner, filled, part.down)) is not None]
    total = sum(size for _, size in seen)
    if len(seen) > 1:
        window.resizeDocks([d for d, _ in seen], [whole * size // total for _, size in seen], along)
    for inner, _ in part.parts:
        _share(window, inner, filled)


def _handle(part: str | Split, filled: Filled, down: bool) -> QDockWidget | None:
    """Return a dock that is as wide (or as high) as a whole part: one that is not split again that way."""
    if isinstance(part, str):
        return next((d for d in filled.get(part, ()) if not d.isHidden()), None)
    if part.down == down:
        alone = [x for x, _ in part.parts if _handle(x, filled, down) is not None]
        return _handle(alone[0], filled, down) if len(alone) == 1 else None
    return next((d for inner, _ in part.parts if (d := _handle(inner, filled, down)) is not None), None)
