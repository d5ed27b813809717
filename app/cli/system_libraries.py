"""Libraries of a Linux system that every desktop has and a bare server may lack."""

from __future__ import annotations

import ctypes
import sys

# Library -> Debian's package. Qt, drawing, the X11 window and sound load them.
PACKAGES = {
    "libglib-2.0.so.0": "libglib2.0-0",
    "libgssapi_krb5.so.2": "libgssapi-krb5-2",
    "libdbus-1.so.3": "libdbus-1-3",
    "libfontconfig.so.1": "libfontconfig1",
    "libfreetype.so.6": "libfreetype6",
    "libEGL.so.1": "libegl1",
    "libGL.so.1": "libgl1",
    "libX11.so.6": "libx11-6",
    "libX11-xcb.so.1": "libx11-xcb1",
    "libxcb.so.1": "libxcb1",
    "libasound.so.2": "libasound2",
}


def find_missing_packages() -> list[str]:
    """Return the Debian packages of the libraries that this system lacks; none on other systems."""
    if not sys.platform.startswith("linux"):
        return []
    return [package for library, package in PACKAGES.items() if not _loads(library)]


def describe_missing_library(error: ImportError) -> str:
    """Return what is missing and the remedy, if an import failed because of a library of the system; else
    an empty text.
    """
    library = str(error).partition(": cannot open shared object file")[0]
    if library == str(error):
        return ""
    packages = find_missing_packages()
    remedy = f"; on Debian or Ubuntu: apt install {' '.join(packages)}" if packages else ""
    return f"this system lacks the library {library}. Install it{remedy}."


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True
