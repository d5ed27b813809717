"""The menu of a request on the timeline."""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QMenu

from app.features.timeline.lane_keys import FAR
from app.translation import tr
from app.widgets.lane_geometry import RequestMark


def make_request_marks_menu(view: Any, mark: RequestMark) -> QMenu:
    """Return what can be done with a request, or with all that are selected with it."""
    ident = mark.ask.id
    if ident not in view.session.onstage.requests:
        view.session.onstage.select_requests((ident,))
    menu, chosen = QMenu(view), view.session.onstage.requests
    menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    menu.addAction(tr("Change…\tReturn"), lambda: view.edit(ident))
    requests = view.performance.requests
    menu.addAction(tr("Cut\tCtrl+X"), lambda: requests.to_clipboard(chosen, True))
    menu.addAction(tr("Copy\tCtrl+C"), lambda: requests.to_clipboard(chosen))
    menu.addAction(tr("Paste at the playhead\tCtrl+V"), requests.paste)
    menu.addAction(tr("Duplicate one second later\tCtrl+D"), lambda: requests.copy(chosen, FAR))
    menu.addSeparator()
    menu.addAction(
        tr("Remove request\tDel") if len(chosen) == 1 else tr("Remove requests\tDel"),
        lambda: view.performance.requests.withdraw(*chosen),
    )
    menu.addAction(
        tr("Remove and close the gap\tShift+Del"),
        lambda: view.performance.requests.close_up(chosen, view.performance.shown.plan),
    )
    return menu
