"""Put docks into the areas of a workspace, and give each area its share."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDockWidget, QMainWindow

from app.shell.workspaces import Split, Workspace

Filled = Mapping[str, Sequence[QDockWidget]]  # the docks of each area, the one in front first


def arrange_docks(
    window: QMainWindow, docks: Sequence[QDockWidget], workspace: Workspace, filled: Filled, shown: set[str]
) -> None:
    """Put all docks where a workspace has them. `filled` has the docks of each area. `shown` has the object
    names of those that are visible; the others keep a place for when they are opened.
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


def share_window(workspace: Workspace, filled: Filled) -> dict[str, tuple[float, float]]:
    """Return by name the share of the window's width and height for each dock that is not hidden. The share
    of an empty area goes to those beside it.
    """
    out: dict[str, tuple[float, float]] = {}
    _share(workspace.tree, filled, 1.0, 1.0, out)
    return out


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


def _share(
    part: str | Split, filled: Filled, width: float, height: float, out: dict[str, tuple[float, float]]
) -> None:
    if isinstance(part, str):
        out.update((d.objectName(), (width, height)) for d in filled.get(part, ()) if not d.isHidden())
        return
    there = [(inner, size) for inner, size in part.parts if _seen(inner, filled)]
    total = sum(size for _, size in there)
    for inner, size in there:
        across, down = (1.0, size / total) if part.down else (size / total, 1.0)
        _share(inner, filled, width * across, height * down, out)


def _seen(part: str | Split, filled: Filled) -> bool:
    """Return whether anything of a part is visible."""
    if isinstance(part, str):
        return any(not d.isHidden() for d in filled.get(part, ()))
    return any(_seen(inner, filled) for inner, _ in part.parts)
