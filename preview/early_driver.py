"""Load the driver of the graphics card, or the software renderer, before it is needed."""

from __future__ import annotations

import ctypes
import sys
from ctypes import POINTER, byref, c_int, c_uint, c_void_p
from threading import Thread

_DEVICE = 0x313F  # EGL_PLATFORM_DEVICE_EXT: where `preview.offscreen` draws, without a display


def load_soon() -> None:
    """Load on a thread what the first context of this process will need. This is a quarter of the time to
    make it, and does not hold Python's lock.

    Nothing happens if there is no EGL: the error comes from the context.
    """
    if sys.platform.startswith("linux"):
        Thread(target=_load, name="driver", daemon=True).start()


def _load() -> None:
    try:
        egl = ctypes.CDLL("libEGL.so.1")
        address = egl.eglGetProcAddress
        initialize = egl.eglInitialize
    except (OSError, AttributeError):
        return
    address.restype = c_void_p
    query, display_of = address(b"eglQueryDevicesEXT"), address(b"eglGetPlatformDisplayEXT")
    if not query or not display_of:
        return
    device, count = c_void_p(), c_int()
    if not ctypes.CFUNCTYPE(c_uint, c_int, POINTER(c_void_p), POINTER(c_int))(query)(
        1, byref(device), byref(count)
    ):
        return
    if count.value < 1:
        return
    display = ctypes.CFUNCTYPE(c_void_p, c_uint, c_void_p, c_void_p)(display_of)(_DEVICE, device, None)
    if display:
        # EGL stays initialized: the context uses the same display, and initializing it again takes no time.
        initialize.argtypes = [c_void_p, c_void_p, c_void_p]
        initialize(display, None, None)
