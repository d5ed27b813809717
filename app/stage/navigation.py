"""What a mouse, a touchpad or a pen does to the camera, as in the program that the user is used to."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from PySide6.QtCore import QSettings, Qt

from app.translation import tr_noop

Move = Literal["orbit", "pan", "zoom"]
Drag = tuple[Qt.MouseButton, Qt.KeyboardModifier]

KEY = "navigation"
_LEFT, _MIDDLE, _RIGHT = Qt.MouseButton.LeftButton, Qt.MouseButton.MiddleButton, Qt.MouseButton.RightButton
_NONE, _SHIFT = Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.ShiftModifier
_CTRL, _ALT = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.AltModifier
_HELD = _SHIFT | _CTRL | _ALT


@dataclass(frozen=True)
class Navigation:
    """`drags` says what a drag with a button and held keys does. With `scroll_orbits` two fingers on a
    touchpad turn the camera, with Shift they move it, and with Ctrl they zoom. `words` describe all of it.
    """

    id: str
    title: str
    words: str
    drags: Mapping[Drag, Move]
    scroll_orbits: bool = False

    def move_of(self, buttons: Qt.MouseButton, held: Qt.KeyboardModifier) -> Move | None:
        """Return what a drag does; None for nothing."""
        held &= _HELD
        found = (move for (button, keys), move in self.drags.items() if buttons & button and keys == held)
        return next(found, None)


# The sources are the manuals of Blender, Maya and Unreal Engine. A drag with the left button orbits wherever
# those programs select with it, since nothing is selected here.
NAVIGATIONS: Mapping[str, Navigation] = {
    one.id: one
    for one in (
        Navigation(
            "usual",
            tr_noop("Default"),
            tr_noop("Drag to orbit, right-drag to pan, wheel to zoom, double-click to frame"),
            {
                (_LEFT, _NONE): "orbit",
                (_LEFT, _SHIFT): "pan",
                (_RIGHT, _NONE): "pan",
                (_MIDDLE, _NONE): "pan",
            },
        ),
        Navigation(
            "blender",
            "Blender",
            tr_noop(
                "Drag with the middle button to orbit, with Shift to pan, with Ctrl to zoom. Double-click to "
                "frame"
            ),
            {
                (_MIDDLE, _NONE): "orbit",
                (_MIDDLE, _SHIFT): "pan",
                (_MIDDLE, _CTRL): "zoom",
                (_LEFT, _ALT): "orbit",
                (_LEFT, _NONE): "orbit",
            },
        ),
        Navigation(
            "maya",
            "Maya",
            tr_noop("Hold Alt and drag: left to orbit, middle to pan, right to zoom. Double-click to frame"),
            {
                (_LEFT, _ALT): "orbit",
                (_MIDDLE, _ALT): "pan",
                (_RIGHT, _ALT): "zoom",
                (_LEFT, _NONE): "orbit",
                (_MIDDLE, _NONE): "pan",
            },
        ),
        Navigation(
            "unreal",
            "Unreal",
            tr_noop(
                "Right-drag or Alt and left-drag to orbit, middle-drag to pan, Alt and right-drag to zoom. "
                "Double-click to frame"
            ),
            {
                (_RIGHT, _NONE): "orbit",
                (_LEFT, _ALT): "orbit",
                (_MIDDLE, _NONE): "pan",
                (_MIDDLE, _ALT): "pan",
                (_RIGHT, _ALT): "zoom",
                (_LEFT, _NONE): "orbit",
            },
        ),
        Navigation(
            "touchpad",
            tr_noop("Touchpad"),
            tr_noop(
                "Scroll with two fingers to orbit, with Shift to pan, with Ctrl to zoom. Double-click to "
                "frame"
            ),
            {(_LEFT, _NONE): "orbit", (_LEFT, _SHIFT): "pan", (_LEFT, _CTRL): "zoom"},
            scroll_orbits=True,
        ),
        Navigation(
            "pen",
            tr_noop("Pen"),
            tr_noop(
                "Drag with the tip to orbit, with Shift or the lower button to pan, with Ctrl or the upper "
                "button to zoom. Tap twice to frame"
            ),
            {
                (_LEFT, _NONE): "orbit",
                (_LEFT, _SHIFT): "pan",
                (_LEFT, _CTRL): "zoom",
                (_RIGHT, _NONE): "pan",
                (_MIDDLE, _NONE): "zoom",
            },
        ),
    )
}


def get_navigation() -> Navigation:
    """Return what the user chose."""
    return NAVIGATIONS.get(str(QSettings().value(KEY)), NAVIGATIONS["usual"])


def choose_navigation(ident: str) -> None:
    """Keep what the user chose. Raises KeyError if there is none with that id."""
    QSettings().setValue(KEY, NAVIGATIONS[ident].id)
