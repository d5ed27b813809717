"""Icons: a few 24 x 24 paths drawn in the theme's text colour. Enough for a toolbar, and no font to load at
start-up.
"""

from __future__ import annotations

from functools import cache

from PySide6.QtCore import QByteArray, Qt
from PySide6.QtGui import QIcon, QPainter, QPixmap
from PySide6.QtSvg import QSvgRenderer

# Stroked outlines; a leading "!" fills instead.
PATHS = {
    "play": "!M8 5.5v13l10.5-6.5z",
    "pause": "!M7 5.5h3.6v13H7zM13.4 5.5H17v13h-3.6z",
    "start": "!M6 5.5h2.4v13H6zM18.5 5.5v13L9.5 12z",
    "loop": "M17 3l3 3-3 3M4 11V9a3 3 0 0 1 3-3h13M7 21l-3-3 3-3M20 13v2a3 3 0 0 1-3 3H4",
    "undo": "M8 5L4 9l4 4M4 9h10a5.5 5.5 0 0 1 0 11h-4",
    "redo": "M16 5l4 4-4 4M20 9H10a5.5 5.5 0 0 0 0 11h4",
    "frame": "M4 9V5a1 1 0 0 1 1-1h4M15 4h4a1 1 0 0 1 1 1v4M20 15v4a1 1 0 0 1-1 1h-4M9 20H5a1 1 0 0 1-1-1v-4",
    "face": "M12 3.5a7 7 0 0 1 7 7c0 5-3 10-7 10s-7-5-7-10a7 7 0 0 1 7-7M9.5 11v.6M14.5 11v.6M9.8 15.6c1.4.9 "
    "3 .9 4.4 0",
    "bones": "M12 4.5v8M12 12.5l-4.5 7M12 12.5l4.5 7M6 8.5h12",
    "add": "M12 5v14M5 12h14",
    "remove": "M6 6l12 12M18 6L6 18",
    "folder": "M3.5 18.5v-12h6l2 2.5h9v9.5z",
    "save": "M5 4.5h11l3.5 3.5v11.5H4.5v-15zM8 4.5v5h7v-5M8 19.5v-6h8v6",
    "export": "M12 15V4M8 8l4-4 4 4M5 14v5.5h14V14",
    "search": "M10.5 4.5a6 6 0 1 1 0 12 6 6 0 0 1 0-12M15 15l5 5",
    "done": "M4.5 12.5l5 5 10-11",
    "warning": "M12 4l9 16H3zM12 10v4.5M12 17.2v.4",
    "hint": "M12 3.5a8.5 8.5 0 1 1 0 17a8.5 8.5 0 1 1 0-17M12 11v5.5M12 7.6v.4",
    "machine": "M5 5.5h5v4H5zM14 14.5h5v4h-5zM14 5.5h5v4h-5zM10 7.5h4M16.5 9.5v5M10 9l4.5 6",
    "theme": "M12 3.5a8.5 8.5 0 1 0 0 17zM12 3.5a8.5 8.5 0 0 1 0 17",
    "skeleton": "M12 3.5a2.5 2.5 0 1 1 0 5 2.5 2.5 0 0 1 0-5M12 8.5v6M7 10.5l5 1 5-1M12 14.5l-3 6M12 "
    "14.5l3 6",
    "pin": "M12 13v7.5M8 4h8l-1 5 2.5 4h-11L9 9z",
    "more": "!M5 10.5h3v3H5zM10.5 10.5h3v3h-3zM16 10.5h3v3h-3z",
    "grid": "M4.5 4.5h6v6h-6zM13.5 4.5h6v6h-6zM4.5 13.5h6v6h-6zM13.5 13.5h6v6h-6z",
    "list": "M4 6h2M9 6h11M4 12h2M9 12h11M4 18h2M9 18h11",
    "eye": "M3 12c3-5 6-6.5 9-6.5s6 1.5 9 6.5c-3 5-6 6.5-9 6.5S6 17 3 12"
    "M12 9.3a2.7 2.7 0 1 1 0 5.4 2.7 2.7 0 0 1 0-5.4",
    "mesh": "M9 4.5c.6 1.6 5.4 1.6 6 0l5 3-1.8 4-2.2-1v9H8v-9l-2.2 1L4 7.5z",
    "magnet": "M5.5 4v8a6.5 6.5 0 0 0 13 0V4h-4.5v8a2 2 0 0 1-4 0V4zM5.5 8h4.5M14 8h4.5",
    "ripple": "M4.5 5v14M9 12h11M15.5 7.5L20 12l-4.5 4.5M9 7h3M9 17h3",
    "ghosts": "M4 6h7M14 6h6M4 12h3M10 12h10M4 18h10M17 18h3",
    "left": "M14.5 6l-6 6 6 6",
    "right": "M9.5 6l6 6-6 6",
}


@cache
def make_icon(name: str, color: str, size: int = 18) -> QIcon:
    """Return an icon in a colour (#rrggbb), sharp up to 3 times its size; faded when disabled."""
    out, drawing = QIcon(), _drawing(name, color)
    for scale in (1, 2, 3):
        for mode, opacity in ((QIcon.Mode.Normal, 1.0), (QIcon.Mode.Disabled, 0.35)):
            picture = QPixmap(size * scale, size * scale)
            picture.fill(Qt.GlobalColor.transparent)
            painter = QPainter(picture)
            painter.setOpacity(opacity)
            drawing.render(painter)
            painter.end()
            picture.setDevicePixelRatio(scale)
            out.addPixmap(picture, mode)
    return out


def _drawing(name: str, color: str) -> QSvgRenderer:
    path = PATHS[name]
    filled = path.startswith("!")
    style = (
        f'fill="{color}"'
        if filled
        else f'fill="none" stroke="{color}" stroke-width="1.7" stroke-linecap="round" stroke-linejoin="round"'
    )
    svg = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 24 24"><path {style} '
        f'd="{path.lstrip("!")}"/></svg>'
    )
    return QSvgRenderer(QByteArray(svg.encode()))
