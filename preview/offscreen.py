"""Draw pictures without a window or a display."""

from __future__ import annotations

import contextlib
import sys
from types import TracebackType
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import phrase
from preview.camera import Camera
from preview.renderer import Renderer
from preview.scene import DARK, Scene, SceneTheme


class OpenGLError(RuntimeError):
    """Raised if there is no OpenGL 3.3. The message says what to install."""


def describe_missing_opengl(reasons: str) -> OpenGLError:
    """Return the error to raise if OpenGL 3.3 is missing. `reasons` is what the system says."""
    remedy = {
        "linux": phrase("Install Mesa's software renderer, on Debian or Ubuntu: apt install libegl1 libgl1"),
        "darwin": phrase("Sign in to a graphical session; macOS gives no OpenGL without one"),
    }.get(sys.platform, phrase("Install the graphics card's driver"))
    return OpenGLError(
        phrase("There is no OpenGL 3.3 ({reasons}). {remedy}.", reasons=reasons, remedy=remedy)
    )


def make_standalone_context() -> moderngl.Context:
    """Return a context of OpenGL 3.3 that belongs to no window. Raises OpenGLError."""
    tries: list[dict[str, Any]] = [{}]
    if sys.platform.startswith("linux"):
        # By their names first: searching for them starts another program twice.
        named = {"libgl": "libGL.so.1", "libegl": "libEGL.so.1"}
        tries = [{"backend": "egl", **named}, {"backend": "egl"}, {}]
    reasons = []
    for options in tries:
        try:
            return moderngl.create_context(standalone=True, require=330, **options)
        except Exception as error:  # each backend raises its own kinds
            reasons.append(f"{options.get('backend', 'system')}: {error}")
    raise describe_missing_opengl("; ".join(dict.fromkeys(reasons)))


class Offscreen:
    """A picture of `width` by `height` pixels to draw into, with its own context and renderer.

    Use it in a `with` block or call `release()`, and use it from one thread only. `render` accepts any size
    and resizes the picture. `beside` is another picture of the same scenes whose context and meshes are used;
    it has to be released last.
    """

    def __init__(
        self, width: int, height: int, samples: int | None = None, beside: Offscreen | None = None
    ) -> None:
        self._beside = beside
        self._ctx: moderngl.Context = make_standalone_context() if beside is None else beside._ctx
        with self._ctx:
            self.renderer: Renderer = Renderer(
                self._ctx, samples, None if beside is None else beside.renderer
            )
        self._held: list[Any] = []
        self._released = False
        self.resize(width, height)

    @property
    def description(self) -> str:
        """The name of the graphics card or of the software renderer that draws."""
        with self._ctx:
            return str(self._ctx.info["GL_RENDERER"])

    def render(
        self,
        scene: Scene,
        camera: Camera,
        theme: SceneTheme = DARK,
        size: tuple[int, int] | None = None,
        into: NDArray[np.uint8] | None = None,
    ) -> NDArray[np.uint8]:
        """Return the picture `[H, W, 4]` uint8, sRGB, first row at the top, alpha premultiplied. `into` is an
        array of that shape to fill and return; new memory takes longer than the copy.
        """
        if size is not None and (max(1, size[0]), max(1, size[1])) != self.size:
            self.resize(*size)
        width, height = self.size
        with self._ctx:
            self.renderer.draw(scene, camera, self.size, self._fbo, theme)
            self._fbo.read_into(self._read, components=4, alignment=1)
        picture = self._read.reshape(height, width, 4)[::-1]
        if into is None:
            return picture.copy()
        into[...] = picture
        return into

    def draw(self, scene: Scene, camera: Camera, theme: SceneTheme = DARK) -> None:
        """Draw to the end without reading the picture: this measures the time of a window's frame."""
        with self._ctx:
            self.renderer.draw(scene, camera, self.size, self._fbo, theme)
            self._ctx.finish()

    def resize(self, width: int, height: int) -> None:
        self.size = (max(1, width), max(1, height))
        with self._ctx:
            self._give_back()
            # Made one by one: a simple framebuffer does not release what it holds.
            color, depth = self._ctx.renderbuffer(self.size, 4), self._ctx.depth_renderbuffer(self.size)
            self._fbo = self._ctx.framebuffer([color], depth)
            self._held = [color, depth, self._fbo]
        self._read = np.empty(4 * self.size[0] * self.size[1], np.uint8)  # pixels are read into this first

    def _give_back(self) -> None:
        while self._held:
            self._held.pop().release()

    def release(self) -> None:
        """Release the context. Safe to call twice."""
        if self._released:
            return
        self._released = True
        if self._beside is not None and self._beside._released:
            return  # the other has released everything
        with contextlib.suppress(Exception), self._ctx:  # a lost context has nothing left to release
            self.renderer.release()
            self._give_back()
        if self._beside is None:
            self._ctx.release()

    def __enter__(self) -> Offscreen:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.release()
