"""What marks, ghosts and views over the character know of the panel they belong to."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from PySide6.QtWidgets import QWidget

from app.stage.gl_view import GLView, ImageView
from app.stage.performance import StagePerformance
from app.stage.session import StageSession
from preview.camera import Camera
from preview.figure import MeshFigure
from preview.scene import Scene


class OverlayHost(Protocol):
    """view: the first view of the character. composed: what it drew last. bare: whether it is shown alone."""

    session: StageSession
    performance: StagePerformance
    view: GLView | ImageView
    composed: Scene
    bare: bool

    @property
    def drawn(self) -> tuple[MeshFigure, np.ndarray, np.ndarray] | None:
        """Figure, rotations `[J, 4]` and positions `[J, 3]` of what was drawn last."""

    @property
    def active_view(self) -> GLView | ImageView:
        """The view that was touched last, of several."""

    def face_camera(self, aspect: float) -> Camera | None:
        """Return what looks at the face, None while nobody is drawn."""

    def put_below_view(self, widget: QWidget) -> None:
        """Show a widget directly below the view."""

    def isVisible(self) -> bool: ...
