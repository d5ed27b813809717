"""Several views of the character at one time: the first as ever, and one or three beside it, each from a
side of its own, which is chosen in its corner. The pose is made once for all of them.
"""

from __future__ import annotations

import math
from dataclasses import replace

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QGridLayout, QMenu, QToolButton, QWidget

from app.features.character.looking import SIDES as ANGLES
from app.features.character.looking import Looking
from app.features.character.overlay_host import OverlayHost
from app.stage.gl_view import GLView, ImageView, make_beside
from app.stage.watch import SIDES
from app.translation import tr
from app.widgets.making import make_widget
from preview.camera import Camera
from preview.scene import Scene

LEAST = 240, 200  # pixels of one view
GAP = 2  # pixels between views
PLACES = {1: ((0, 0),), 2: ((0, 0), (0, 1)), 4: ((0, 0), (0, 1), (1, 0), (1, 1))}
SLOWER = 1.5  # how much longer a picture stands where the processor draws four


class Pane:
    """A view beside the first. number: its place among those, from 0."""

    def __init__(self, panes: Panes, number: int) -> None:
        self.panes, self.number = panes, number
        self._framed: tuple[object, ...] = ()
        self.view = make_beside(panes.panel.view, self._scene, panes)
        self.view.setMinimumSize(LEAST[0] // 2, LEAST[1] // 2)
        self.view.setToolTip(panes.panel.view.toolTip())
        self.view.theme = panes.panel.view.theme
        self.view.frame_wanted.connect(self.frame)
        self.view.installEventFilter(panes)
        self.button = make_widget(QToolButton, self.view, toolTip=tr("Which side this view shows"))
        self.button.setProperty("over", True)
        self.button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        menu = QMenu(self.button)
        menu.aboutToShow.connect(lambda: self._fill(menu))
        self.button.setMenu(menu)
        self.button.move(8, 8)
        self.name()

    @property
    def side(self) -> str:
        """What is shown, a key of `app.stage.watch.SIDES`."""
        return self.panes.panel.session.watch.now.sides.split()[self.number]

    def name(self) -> None:
        """Write in the corner which side it is."""
        self.button.setText(f"{tr(SIDES[self.side])} ▾")
        self.button.setAccessibleName(tr("View: {side}", side=tr(SIDES[self.side])))
        self.button.adjustSize()

    def _fill(self, menu: QMenu) -> None:
        menu.clear()
        for side, words in SIDES.items():
            action = QAction(words, menu, checkable=True)
            action.setChecked(side == self.side)
            action.triggered.connect(lambda _=False, s=side: self.choose(s))
            menu.addAction(action)

    def choose(self, side: str) -> None:
        """Show another side, framed again."""
        watch = self.panes.panel.session.watch
        sides = watch.now.sides.split()
        sides[self.number] = side
        watch.set(sides=" ".join(sides))
        self.frame()

    def frame(self) -> None:
        """Show all of its side."""
        self.view.moved_by_hand, self._framed = False, ()
        self.view.update()

    def _scene(self) -> Scene:
        """Return what the first view has drawn, which is made there; the camera is framed where it
        has to be."""
        panel, view = self.panes.panel, self.view
        scene, aspect = panel.composed, view.width() / max(1, view.height())
        solid = Scene(tuple(actor for actor in scene.actors if actor.opacity >= 1))
        framed = (self.side, round(aspect, 1), *(actor.figure for actor in solid.actors))
        if solid.actors and framed != self._framed and not view.moved_by_hand:
            self._framed = framed
            view.camera = self._camera(solid, aspect)
        return scene if scene.picture is None else replace(scene, picture=None)

    def _camera(self, solid: Scene, aspect: float) -> Camera:
        looking, side = self.panes.looking, self.side
        if side == "face":
            return self.panes.panel.face_camera(aspect) or Camera()
        yaw, pitch = (math.radians(x) for x in ANGLES["front" if side == "hands" else side])
        camera = Camera().facing(yaw + looking.heading, pitch)
        if side == "hands":
            return camera.frame(looking.hands() or solid.drawn_bounds(), aspect)
        camera = camera.frame(solid.drawn_bounds(), aspect)
        return camera if side == "quarter" else camera.flattened()


class Panes(QWidget):
    """Holds the first view and those beside it, which are made when they are wanted."""

    def __init__(self, panel: OverlayHost, looking: Looking) -> None:
        super().__init__(panel.view.parentWidget())
        self.panel, self.looking = panel, looking
        self.others: list[Pane] = []
        self._beside: QWidget | None = None
        self.active: GLView | ImageView = panel.view  # which was touched last: commands look from there
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(0, 0, 0, 0)
        self._grid.setSpacing(GAP)
        self._grid.addWidget(panel.view, 0, 0)
        panel.view.installEventFilter(self)
        panel.view.painted.connect(self._follow)
        panel.session.watch.changed.connect(self.arrange)
        panel.session.look.changed.connect(self.arrange)
        self.arrange()

    @property
    def slower(self) -> float:
        """How much longer each picture stands than where there is one view."""
        soft = isinstance(self.panel.view, ImageView)
        return SLOWER if soft and self.panel.session.watch.now.panes == 4 else 1.0

    def arrange(self) -> None:
        """Show as many views as are chosen, as they are lit."""
        watch = self.panel.session.watch.now
        while len(self.others) < watch.panes - 1:
            pane = Pane(self, len(self.others))
            self.others.append(pane)
            self._grid.addWidget(pane.view, *PLACES[4][len(self.others)])
        while len(self.others) > watch.panes - 1:
            gone = self.others.pop().view
            if self.active is gone:
                self.active = self.panel.view
            self._grid.removeWidget(gone)
            gone.hide()
            gone.deleteLater()
        if self._beside is not None:  # a second row would take its gap
            self._grid.addWidget(self._beside, 0, 2, 2 if watch.panes == 4 else 1, 1)
        for pane in self.others:
            pane.view.theme = self.panel.session.make_view_look()
            pane.name()
            pane.view.update()
        self.panel.view.setMinimumSize(*(LEAST if watch.panes == 1 else (LEAST[0] // 2, LEAST[1] // 2)))
        for k in range(2):
            self._grid.setColumnStretch(k, 1 if k == 0 or watch.panes > 1 else 0)
            self._grid.setRowStretch(k, 1 if k == 0 or watch.panes == 4 else 0)

    def put_beside(self, widget: QWidget) -> None:
        """Show a widget to the right of all views, as wide as one, while it is not hidden."""
        self._beside = widget
        self._grid.addWidget(widget, 0, 2)
        self._grid.setColumnStretch(2, 0 if widget.isHidden() else 1)
        widget.installEventFilter(self)

    def frame(self) -> None:
        """Show all of the character in each view beside the first."""
        for pane in self.others:
            pane.frame()

    def _follow(self, *_: object) -> None:
        for pane in self.others:
            if pane.view.isVisible():
                pane.view.update()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if watched is self._beside and event.type() in (QEvent.Type.ShowToParent, QEvent.Type.HideToParent):
            self._grid.setColumnStretch(2, int(event.type() == QEvent.Type.ShowToParent))
        elif event.type() == QEvent.Type.MouseButtonPress and isinstance(watched, (GLView, ImageView)):
            self.active = watched
        return False
