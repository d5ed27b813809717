"""Panes over a view, which are drawn whenever the view is drawn."""

from __future__ import annotations

from PySide6.QtWidgets import QWidget

from app.stage.gl_view import GLView, ImageView


def lie_over(pane: QWidget, view: GLView | ImageView) -> None:
    """Keep a pane over a view. The pane is drawn with the view's image: an update of the pane would draw the
    image again, endlessly.
    """
    if pane.geometry() != view.rect():
        pane.setGeometry(view.rect())
    if isinstance(view, GLView):
        pane.update()
