"""List where panels and their nodes are on the screen, to interpret an eye-tracking recording."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QPoint
from PySide6.QtWidgets import QWidget

from app.shell.places import PanelPlaces

if TYPE_CHECKING:
    from app.shell.context import Shell


def list_screen_areas(shell: Shell) -> dict[str, list[int]]:
    """Return name -> x, y, width, height on the screen, logical pixels, of all docks that are seen, and of
    what widgets in them name by `named_areas`.
    """
    out: dict[str, list[int]] = {}
    for ident, dock in shell.services[PanelPlaces].docks.items():
        if not dock.isVisible() or dock.visibleRegion().isEmpty():
            continue
        out[ident] = _on_screen(dock, 0, 0, dock.width(), dock.height())
        for widget in dock.findChildren(QWidget):
            layout = getattr(widget, "layout_now", None)
            areas = getattr(layout(), "areas", None) if layout is not None and widget.isVisible() else None
            if areas is not None:
                for name, rect in areas().items():
                    box = round(rect.x()), round(rect.y()), round(rect.width()), round(rect.height())
                    out[f"{ident} {name}"] = _on_screen(widget, *box)
    return out


def _on_screen(widget: QWidget, x: int, y: int, wide: int, high: int) -> list[int]:
    corner = widget.mapToGlobal(QPoint(x, y))
    return [corner.x(), corner.y(), wide, high]
