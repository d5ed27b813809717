"""Draw the picture of the character: one painter for two widgets, an OpenGL widget and, if there is no
OpenGL, an image.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np
from PySide6.QtCore import QPointF, QSettings, Qt, Signal
from PySide6.QtGui import (
    QGuiApplication,
    QImage,
    QMouseEvent,
    QOffscreenSurface,
    QOpenGLContext,
    QPainter,
    QPaintEvent,
    QWheelEvent,
)
from PySide6.QtOpenGLWidgets import QOpenGLWidget
from PySide6.QtWidgets import QLabel, QLayout, QPushButton, QVBoxLayout, QWidget

from app.stage.navigation import Move, get_navigation
from app.stage.software_drawing import can_choose_software, choose_software, has_software_opengl
from app.translation import tr, tr_error
from preview.camera import Camera
from preview.renderer import Renderer
from preview.scene import DARK, Scene, SceneTheme

Compose = Callable[[], Scene]
GL_RENDERER = 0x1F01
ROOM = 160  # pixels of height from which a button fits below the reason for an empty view
ZOOMED = 16.0  # notches of the wheel for a drag as long as the view is high
NOTCH = 4.0  # parts of an angle delta to a pixel, where a touchpad tells none
_Base: Any = QWidget if TYPE_CHECKING else object


class CameraMouse(_Base):
    """Moves the camera with the mouse as the user has chosen, for any widget that has `frame_wanted`."""

    camera: Camera
    failed: Any

    def _init_camera(self) -> None:
        self.camera = Camera()
        self.moved_by_hand = False
        self._last: QPointF | None = None

    def _cannot_draw(self, error: Exception) -> None:
        """Say in the middle of the view why it stays empty, and emit it; offer to draw in software."""
        words = QLabel(tr_error(error), self, wordWrap=True, alignment=Qt.AlignmentFlag.AlignCenter)
        words.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        words.setAutoFillBackground(True)  # otherwise an OpenGL widget's background is black
        words.setContentsMargins(24, 24, 24, 24)
        words.lower()  # buttons over the view stay visible
        room = QVBoxLayout(self)
        room.setSizeConstraint(QLayout.SizeConstraint.SetNoConstraint)
        room.addWidget(words, 1)
        if can_choose_software() and self.height() >= ROOM:
            words.setAlignment(Qt.AlignmentFlag.AlignHCenter | Qt.AlignmentFlag.AlignBottom)
            room.addWidget(self._make_software_button(words), 0, Qt.AlignmentFlag.AlignHCenter)
            room.addStretch(1)
        self.failed.emit(words.text())

    def _make_software_button(self, words: QLabel) -> QPushButton:
        """Return a button that tries the system's software renderer and chooses it for the next start."""
        button = QPushButton(tr("Draw without the graphics card"), self)
        button.setMinimumWidth(1)  # a view is as narrow as the user likes

        def choose() -> None:
            QGuiApplication.setOverrideCursor(Qt.CursorShape.WaitCursor)
            found = has_software_opengl()
            QGuiApplication.restoreOverrideCursor()
            if found:
                choose_software(QSettings(), True)
                words.setText(
                    tr("Close Metagraph and open it again. It then draws without the graphics card.")
                )
            else:
                words.setText(tr("OpenGL 3.3 does not work in software either. {what}", what=words.text()))
            button.hide()

        button.clicked.connect(choose)
        return button

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self._last = event.position()
        event.accept()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._last is None or not event.buttons():
            return
        delta = event.position() - self._last
        self._last = event.position()
        self._move(get_navigation().move_of(event.buttons(), event.modifiers()), delta)

    def _move(self, move: Move | None, delta: QPointF) -> None:
        """Move the camera by a drag in pixels."""
        height = max(1, self.height())
        right, down = delta.x() / height, delta.y() / height
        if move == "orbit":
            self.camera = self.camera.orbit(right, down)
        elif move == "pan":
            self.camera = self.camera.pan(right, down)
        elif move == "zoom":
            self.camera = self.camera.zoom((right - down) * ZOOMED)
        else:
            return
        self.moved_by_hand = True
        self.update()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self._last = None

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        self.frame_wanted.emit()

    def wheelEvent(self, event: QWheelEvent) -> None:
        event.accept()
        held, fingers = event.modifiers(), event.pixelDelta()
        if get_navigation().scroll_orbits and not held & Qt.KeyboardModifier.ControlModifier:
            by = QPointF(fingers) if not fingers.isNull() else QPointF(event.angleDelta()) / NOTCH
            self._move("pan" if held & Qt.KeyboardModifier.ShiftModifier else "orbit", by)
            return
        self.camera = self.camera.zoom(event.angleDelta().y() / 120)
        self.moved_by_hand = True
        self.update()


class GLView(CameraMouse, QOpenGLWidget):
    """Draws the scene with OpenGL into the widget. `painted` has the milliseconds that issuing a
    frame took.
    """

    painted = Signal(float)
    frame_wanted = Signal()
    failed = Signal(str)

    def __init__(self, compose: Compose, parent: QWidget | None = None) -> None:
        QOpenGLWidget.__init__(self, parent)
        self._init_camera()
        self._compose = compose
        self._renderer: Renderer | None = None
        self._ctx: moderngl.Context | None = None
        self.theme: SceneTheme = DARK
        self.setFocusPolicy(Qt.FocusPolicy.ClickFocus)

    def initializeGL(self) -> None:
        from preview.offscreen import describe_missing_opengl

        try:
            self._ctx = moderngl.create_context(require=330)
            self._renderer = Renderer(self._ctx)
        except Exception as error:
            self._cannot_draw(describe_missing_opengl(str(error)))
            return
        self.context().aboutToBeDestroyed.connect(self._lost)

    def _lost(self) -> None:
        self.makeCurrent()
        if self._renderer is not None:
            self._renderer.release()
        self._renderer = None
        self.doneCurrent()

    def paintGL(self) -> None:
        if self._renderer is None or self._ctx is None:
            return
        ratio = self.devicePixelRatioF()
        size = (max(1, round(self.width() * ratio)), max(1, round(self.height() * ratio)))
        target = self._ctx.detect_framebuffer(self.defaultFramebufferObject())
        self._renderer.draw(self._compose(), self.camera, size, target, self.theme)
        self.painted.emit(0.0)


class ImageView(CameraMouse, QWidget):
    """Draws the same picture through an offscreen context, for platforms without OpenGL widgets.

    `coarse` is how many times wider and higher the picture's pixels are than the widget's; it is more than 1
    if nobody looks. `beside` is another view of the same scenes, which is painted first and lives longer.
    """

    coarse = 1
    painted = Signal(float)
    frame_wanted = Signal()
    failed = Signal(str)

    def __init__(
        self, compose: Compose, parent: QWidget | None = None, beside: ImageView | None = None
    ) -> None:
        QWidget.__init__(self, parent)
        self._init_camera()
        self._beside = beside
        self._compose = compose
        self._offscreen: Any = None
        self._pixels: np.ndarray | None = None
        self._drawn: tuple[object, Scene, QImage] | None = None  # the last picture, and what it shows
        self._contexts: list[Any] = []  # nothing else releases a context when the widget is deleted
        self.destroyed.connect(lambda *_, made=self._contexts: [each.release() for each in made])
        self.theme: SceneTheme = DARK
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self.setFocusPolicy(Qt.FocusPolicy.ClickFocus)

    def paintEvent(self, event: QPaintEvent) -> None:
        ratio = self.devicePixelRatioF() / self.coarse
        size = (max(1, round(self.width() * ratio)), max(1, round(self.height() * ratio)))
        if self._offscreen is None:
            from preview.offscreen import Offscreen, OpenGLError

            try:
                near = self._beside._offscreen if self._beside is not None else None
                self._offscreen = Offscreen(*size, beside=near or None)
                self._contexts.append(self._offscreen)
            except OpenGLError as error:
                self._offscreen = False
                self._cannot_draw(error)
        painter = QPainter(self)
        if self._offscreen:
            painter.setCompositionMode(QPainter.CompositionMode.CompositionMode_Source)  # also what is clear
            scene = self._compose()  # this may move the camera
            look = self.camera, self.theme, size, ratio
            drawn = self._drawn
            if drawn is None or drawn[0] != look or not drawn[1].same(scene):
                drawn = self._drawn = look, scene, self._fresh(scene, size)
                drawn[2].setDevicePixelRatio(ratio)
            painter.drawImage(0, 0, drawn[2])
        else:
            painter.fillRect(self.rect(), self.palette().window())
        painter.end()
        self.painted.emit(0.0)

    def _fresh(self, scene: Scene, size: tuple[int, int]) -> QImage:
        """Draw, and return the image. Its pixels use the same memory as those of the previous one."""
        if self._pixels is None or self._pixels.shape[:2] != size[::-1]:
            self._pixels = np.empty((size[1], size[0], 4), np.uint8)
        self._offscreen.render(scene, self.camera, self.theme, size, self._pixels)
        return QImage(self._pixels.data, *size, size[0] * 4, QImage.Format.Format_RGBA8888_Premultiplied)


def make_beside(view: GLView | ImageView, compose: Compose, parent: QWidget) -> GLView | ImageView:
    """Return another view of the scene in a view, of the same kind."""
    return ImageView(compose, parent, view) if isinstance(view, ImageView) else GLView(compose, parent)


def make_view(compose: Compose, parent: QWidget | None = None) -> GLView | ImageView:
    """Return the right widget here: OpenGL in the widget with a graphics card, a drawn image otherwise.

    An OpenGL widget makes Qt compose the whole window through OpenGL; in software that takes longer than the
    picture.
    """
    without = {"offscreen", "minimal", "vnc", "linuxfb", "minimalegl", "eglfs"}
    image = QGuiApplication.platformName() in without or (sys.platform.startswith("linux") and _in_software())
    view = (ImageView if image else GLView)(compose, parent)
    view.setAccessibleName(tr("Character"))
    view.setAccessibleDescription(tr(get_navigation().words))
    return view


def _in_software() -> bool:
    """Return whether the window system's OpenGL runs without a graphics card."""
    if not any(any(Path("/dev").glob(name)) for name in ("dri/card*", "dri/render*", "nvidia*", "dxg")):
        return True  # there is none, and asking OpenGL takes long
    context, surface = QOpenGLContext(), QOffscreenSurface()
    if not context.create():
        return True
    surface.setFormat(context.format())
    surface.create()
    if not context.makeCurrent(surface):
        return True
    name = str(context.functions().glGetString(GL_RENDERER)).lower()
    context.doneCurrent()
    return any(word in name for word in ("llvmpipe", "softpipe", "swrast", "software"))


def to_image(picture: np.ndarray) -> QImage:
    """Return a QImage of `[H, W, 4]` uint8, premultiplied; it owns its pixels."""
    height, width = picture.shape[:2]
    data = np.ascontiguousarray(picture)
    return QImage(data.data, width, height, width * 4, QImage.Format.Format_RGBA8888_Premultiplied).copy()
