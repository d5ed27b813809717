"""Panes that lie over a view, which lets them be drawn whenever it is drawn itself."""

from __future__ import annotations

from PySide6.QtWidgets import QWidget

from app.stage.gl_view import GLView, ImageView


def lie_over(pane: QWidget, view: GLView | ImageView) -> None:
    """Keep a pane over a view that was drawn. What lies over an image is drawn with it: to ask for it would
    draw the image once more, and so on for ever.
    """
    if pane.geometry() != view.rect():
        pane.setGeometry(view.rect())
    if isinstance(view, GLView):
        pane.update()
