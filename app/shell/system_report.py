"""What this computer has of what Metagraph needs, for a report of a fault."""

from __future__ import annotations

import os
import platform
import sys
from collections.abc import Mapping
from importlib.metadata import PackageNotFoundError, version

from metagraph import __version__
from metagraph.common.disk_cache import cache_folder
from metagraph.common.extras import EXTRAS, find_extras_folder, is_bundle, is_installed
from metagraph.common.programs import ROOT

PACKAGES = ("PySide6_Essentials", "numpy", "moderngl", "pyqtgraph", "pyyaml", "av", "msgspec")


def make_system_report() -> dict[str, str]:
    """Return facts about this computer and installation, in words, by their names; nothing of a project."""
    report = {
        "Metagraph": f"{__version__}, {'a bundle' if is_bundle() else 'installed'} in {ROOT}",
        "Python": f"{platform.python_version()}, {sys.executable}",
        "System": f"{platform.platform()}, {platform.libc_ver()[0]} {platform.libc_ver()[1]}".rstrip(", "),
        "Cores": str(os.cpu_count()),
        "Screen": os.environ.get("WAYLAND_DISPLAY") or os.environ.get("DISPLAY") or "none",
        "OpenGL": _describe_opengl(),
        "Sound": _describe_sound(),
        "Caches": str(cache_folder("")),
        "Settings": _find_settings(),
        "Extras": ", ".join(name for name in EXTRAS if is_installed(name)) or "none",
        "Extras' folder": str(find_extras_folder()) if is_bundle() else "the environment of this Python",
    }
    for name in PACKAGES:
        try:
            report[name] = version(name)
        except PackageNotFoundError:
            report[name] = "missing"
    return report


def format_report(report: Mapping[str, str]) -> str:
    """Return a report as lines, with its facts below each other."""
    width = max(map(len, report))
    return "\n".join(f"{name:{width}}  {words}" for name, words in report.items())


def _find_settings() -> str:
    try:
        from PySide6.QtCore import QSettings
    except ImportError as error:  # a server may lack libraries that Qt needs
        return f"unknown: {error}"
    return QSettings("Metagraph", "Metagraph").fileName()


def _describe_opengl() -> str:
    from preview.offscreen import OpenGLError, make_standalone_context

    try:
        context = make_standalone_context()
        info = context.info
        context.release()
    except OpenGLError as error:
        return str(error)
    return f"3.3 or later: {info['GL_RENDERER']}, {info['GL_VERSION']}"


def _describe_sound() -> str:
    try:
        import sounddevice

        return str(sounddevice.query_devices(kind="output")["name"])
    except Exception as error:  # PortAudio is missing, or finds no device
        return f"none: {error}"
