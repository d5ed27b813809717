"""Draw without the graphics card, where its driver has no OpenGL 3.3 but the system's software renderer has.

Mesa reads the variables when it loads, so a choice takes effect at the next start.
"""

from __future__ import annotations

import os
import sys

from PySide6.QtCore import QSettings

from metagraph.common.programs import make_python_command, run_program

KEY = "draw_in_software"
VARIABLES = {"LIBGL_ALWAYS_SOFTWARE": "1", "GALLIUM_DRIVER": "llvmpipe"}  # Mesa's own manual
PROBE_SECONDS = 30.0  # a first start from a slow disk takes long


def can_choose_software() -> bool:
    """Return whether this system has a renderer that variables switch to: Linux with Mesa."""
    return sys.platform.startswith("linux")


def has_software_opengl() -> bool:
    """Return whether OpenGL 3.3 works in software. It is tried in another process, which takes a second or
    two.
    """
    if not can_choose_software():
        return False
    try:
        status, _ = run_program(make_python_command("app.cli", "doctor"), PROBE_SECONDS, env=VARIABLES)
    except (OSError, TimeoutError):
        return False
    return status == 0


def is_software_chosen(settings: QSettings) -> bool:
    return settings.value(KEY, False, type=bool) is True


def choose_software(settings: QSettings, chosen: bool) -> None:
    """Remember whether to draw in software, from the next start on."""
    settings.setValue(KEY, chosen)


def apply_drawing_choice(settings: QSettings) -> None:
    """Have OpenGL load the software renderer if the user chose it; call it before anything is drawn."""
    if can_choose_software() and is_software_chosen(settings):
        os.environ.update(VARIABLES)
