"""The entry of an unpacked bundle in the desktop's menu, and its type for project files.

A bundle that Debian's package installed has both already. What is written lies in the user's own folder.
"""

from __future__ import annotations

import shutil
import sys
from contextlib import suppress
from pathlib import Path

from metagraph.common.extras import is_bundle
from metagraph.common.programs import find_system_program, run_program
from metagraph.common.user_folders import find_user_folder

NAME = "metagraph.desktop"
DESKTOP = "python/share/metagraph"  # where a bundle has them
# What lies in a bundle, and the folder that desktops look for it in, below the user's for data.
FILES = {
    NAME: "applications",
    "metagraph.xml": "mime/packages",
    "metagraph.svg": "icons/hicolor/scalable/apps",
}
SECONDS = 20.0  # that a desktop's list of types may take to be made again


def find_unpacked_bundle() -> Path | None:
    """Return the folder of this bundle if it was unpacked by hand; None for one that a package installed and
    where this is no bundle.
    """
    folder = Path(sys.prefix).parent
    return folder if is_bundle() and (folder / DESKTOP / NAME).exists() else None


def is_in_menu(bundle: Path) -> bool:
    """Return whether the desktop's menu starts this bundle, and not one in another folder."""
    data = find_user_folder("data")
    try:
        return data is not None and _entry(bundle) == (data / FILES[NAME] / NAME).read_text("utf-8")
    except OSError:
        return False


def add_to_menu(bundle: Path) -> None:
    """Add the entry, the type of projects and the icon. Raises OSError."""
    data = find_user_folder("data")
    if data is None:
        raise FileNotFoundError("nobody's home is known")
    for name, place in FILES.items():
        (data / place).mkdir(parents=True, exist_ok=True)
        if name == NAME:
            (data / place / name).write_text(_entry(bundle), "utf-8")
        else:
            shutil.copyfile(bundle / DESKTOP / name, data / place / name)
    _tell_desktop(data)


def remove_from_menu() -> None:
    """Remove what `add_to_menu` wrote. Raises OSError."""
    data = find_user_folder("data")
    if data is not None:
        for name, place in FILES.items():
            (data / place / name).unlink(missing_ok=True)
        _tell_desktop(data)


def _entry(bundle: Path) -> str:
    """Return the menu entry that starts a bundle by its whole path, if it is still there."""
    program = str(bundle / "metagraph")
    quoted = "".join(f"\\{c}" if c in '"`$\\' else c for c in program).replace("%", "%%")
    start = f'"{quoted}" window %F'.replace("\\", "\\\\")  # quoted as an argument, then as a text
    lines = []
    for line in (bundle / DESKTOP / NAME).read_text("utf-8").splitlines():
        if line.startswith("Exec="):
            lines += ["TryExec=" + program.replace("\\", "\\\\"), f"Exec={start}"]
        else:
            lines.append(line)
    return "\n".join(lines) + "\n"


def _tell_desktop(data: Path) -> None:
    """Have the desktop read its types and entries again, where it keeps lists of them."""
    for name, folder in (("update-mime-database", "mime"), ("update-desktop-database", "applications")):
        program = find_system_program(name)
        if program is not None:
            with suppress(OSError, TimeoutError):
                run_program([str(program), str(data / folder)], timeout=SECONDS)
