"""What keys do on the timeline."""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeyEvent

from app.translation import tr
from app.widgets.lane_geometry import LEFT

Key, Held = Qt.Key, Qt.KeyboardModifier
NUDGE, FAR = 0.1, 1.0  # seconds an arrow key moves what is selected, and with Shift
ZOOM = 1.2
WHOLE = 0.8  # of the width a page turns


class LaneKeys:
    """view: the widget of the lanes."""

    def __init__(self, view: Any) -> None:
        self.view = view

    def wants(self, event: QKeyEvent) -> bool:
        """Return whether a key is meant for the timeline and not for the window's commands."""
        view, key, held = self.view, event.key(), event.modifiers()
        if key == Key.Key_Escape:
            timeline = view.performance.timeline
            return (
                view.hand.gesture is not None
                or bool(view.session.onstage.requests)
                or timeline.marker is not None
            )
        if key == Key.Key_M and held == Held.NoModifier:
            return True
        if held == Held.ControlModifier and key in (Key.Key_C, Key.Key_X):
            return bool(view.session.onstage.requests)
        if held == Held.ControlModifier and key == Key.Key_V:
            return bool(view.session.onstage.mode == "meta")
        if held == Held.NoModifier and Key.Key_0 <= key <= Key.Key_9:
            return view.cameras.talk is not None
        if key == Key.Key_Delete and held == Held.ShiftModifier:
            return bool(view.session.onstage.requests)
        if key in (Key.Key_Left, Key.Key_Right) and view.performance.timeline.marker is not None:
            return True
        mine = (Key.Key_Left, Key.Key_Right, Key.Key_Return)
        return bool(view.session.onstage.requests) and key in mine

    def press(self, event: QKeyEvent) -> bool:
        """Do what a key does; False for one that does nothing here."""
        key, held = Key(event.key()), event.modifiers()
        if key == Key.Key_Escape and self._leave():
            return True
        if self.view.hand.gesture is not None:
            return key != Key.Key_Shift  # what is held is not edited by keys as well
        return self._edit(key, held) or self._mark(key, held) or self._cut(key, held) or self._look(key)

    def _leave(self) -> bool:
        """Break off what is held, or select no request or marker."""
        view, timeline = self.view, self.view.performance.timeline
        if view.break_off():
            return True
        if view.session.onstage.requests:
            view.session.onstage.select_requests(())
        elif timeline.marker is not None:
            timeline.select(None)
        else:
            return False
        return True

    def _edit(self, key: Qt.Key, held: Qt.KeyboardModifier) -> bool:
        """Edit the selected requests, or paste some."""
        view, requests = self.view, self.view.performance.requests
        chosen = view.session.onstage.requests
        can = bool(chosen) and requests.editable
        if can and key in (Key.Key_Left, Key.Key_Right):
            self._nudge(key, held)
        elif can and key == Key.Key_D and held & Held.ControlModifier:
            requests.copy(chosen, FAR)
        elif held == Held.ControlModifier and key == Key.Key_V:
            requests.paste()
        elif can and held == Held.ControlModifier and key in (Key.Key_C, Key.Key_X):
            requests.to_clipboard(chosen, key == Key.Key_X)
        elif can and key == Key.Key_Delete and held == Held.ShiftModifier:
            requests.close_up(chosen, view.performance.shown.plan)
        elif chosen and key in (Key.Key_Return, Key.Key_Enter):
            view.edit(chosen[0])
        else:
            return False
        return True

    def _mark(self, key: Qt.Key, held: Qt.KeyboardModifier) -> bool:
        """Add a marker, choose a request, or move the selected marker."""
        view, timeline = self.view, self.view.performance.timeline
        if key == Key.Key_M and held == Held.NoModifier:
            if view.session.transport.show == "plan":
                timeline.add_marker()
            else:
                view.performance.document.failed.emit(
                    tr("Only a performance can have markers. Press Esc to go back to the performance.")
                )
        elif key in (Key.Key_Up, Key.Key_Down):
            self._choose(1 if key == Key.Key_Down else -1)
        elif timeline.selected is not None and key in (Key.Key_Left, Key.Key_Right):
            by = FAR if held & Held.ShiftModifier else NUDGE
            marker = timeline.selected
            timeline.move_marker(marker.id, marker.at + (by if key == Key.Key_Right else -by), "nudge")
        else:
            return False
        return True

    def _cut(self, key: Qt.Key, held: Qt.KeyboardModifier) -> bool:
        """Cut the camera of a conversation."""
        cameras = self.view.cameras
        digit = held == Held.NoModifier and Key.Key_0 <= key <= Key.Key_9
        if not digit or cameras.talk is None:
            return False
        if key == Key.Key_0:
            cameras.remove_seen()
        else:
            cameras.key(key - Key.Key_0)
        return True

    def _look(self, key: Qt.Key) -> bool:
        """Ask for something here, zoom, or turn a page."""
        view = self.view
        if key == Key.Key_Insert:
            view.ask_here()
        elif key in (Key.Key_Plus, Key.Key_Equal, Key.Key_Minus):
            x = min(max(LEFT, view.scale().x(view.session.transport.seconds)), view.width())
            view.zoom(1 / ZOOM if key == Key.Key_Minus else ZOOM, x)
        elif key == Key.Key_Backslash:
            view.zoom_all()
        elif key in (Key.Key_PageUp, Key.Key_PageDown):
            page = WHOLE * (view.width() - LEFT) / view.each
            view.go_to(view.first + (page if key == Key.Key_PageDown else -page))
        else:
            return False
        return True

    def _nudge(self, key: Qt.Key, held: Qt.KeyboardModifier) -> None:
        by = FAR if held & Held.ShiftModifier else NUDGE
        self.view.performance.requests.move(
            self.view.session.onstage.requests, by if key == Key.Key_Right else -by, merge="nudge"
        )

    def _choose(self, step: int) -> None:
        """Select the request before or after the selected one, in time; without one, the first from the
        playhead on.
        """
        order = sorted(self.view.marks(), key=lambda m: m.at)
        if not order:
            return
        session = self.view.session
        chosen = session.onstage.requests
        place = next((n for n, m in enumerate(order) if chosen and m.ask.id == chosen[-1]), None)
        if place is None:
            place = next(
                (n for n, m in enumerate(order) if m.at >= session.transport.seconds), len(order) - 1
            )
        else:
            place = min(max(0, place + step), len(order) - 1)
        self.view.reveal(order[place].ask.id)
