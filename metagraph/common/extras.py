"""Extras: packages that are too large to bring along. A bundle installs them into the user's own folder."""

from __future__ import annotations

import importlib
import os
import shutil
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from metagraph.common.programs import ROOT, make_own, make_python_command, run_program
from metagraph.common.user_folders import find_user_folder
from metagraph.common.wording import phrase


@dataclass(frozen=True)
class Extra:
    """A package that some jobs need. module: what is imported. wants: what pip is asked for. brings: what it
    is for, in words. megabytes: on disk, with what it needs, about.
    """

    module: str
    wants: tuple[str, ...]
    brings: str
    megabytes: int
    licence: str


CPU = ("--extra-index-url", "https://download.pytorch.org/whl/cpu")
EXTRAS: Mapping[str, Extra] = {
    "compiled": Extra(
        "numba",
        ("numba>=0.60",),
        phrase("building and searching motion graphs in seconds instead of minutes"),
        210,
        "BSD-2-Clause",
    ),
    "fbx": Extra("ufbx", ("ufbx>=0.0.5",), phrase("reading FBX files"), 6, "MIT"),
    "train": Extra(
        "torch", ("torch>=2.4", *CPU), phrase("training models of motion from takes"), 750, "BSD-3-Clause"
    ),
    "lab": Extra("pylsl", ("pylsl>=1.16",), phrase("markers for lab recorders (LSL)"), 5, "MIT"),
}
MINUTES = 30.0  # the longest that pip may take


class ExtraError(RuntimeError):
    """An extra could not be installed or removed; the message says why and what to do."""


def is_bundle() -> bool:
    """Return whether this is a bundle, which brings its own Python."""
    return (ROOT / "bundled").exists()


def find_extras_folder() -> Path | None:
    """Return where a bundle keeps the extras of this Python; None if nobody's home is known."""
    data = find_user_folder("data")
    version = f"{sys.version_info[0]}.{sys.version_info[1]}"
    return data / "Metagraph" / f"extras-{version}" if data is not None else None


def is_installed(name: str) -> bool:
    """Return whether an extra can be imported. Raises KeyError for a name that is no extra's."""
    return find_spec(EXTRAS[name].module) is not None


def install_extra(name: str) -> None:
    """Install an extra into the user's folder, so that it can be imported at once; it takes minutes. Raises
    ExtraError, and KeyError for a name that is no extra's.
    """
    extra = EXTRAS[name]
    place = find_extras_folder()
    if not is_bundle() or place is None:
        raise ExtraError(
            phrase(
                "Install it with the Python that Metagraph was installed with: {command}",
                command=f'"{sys.executable}" -m pip install "metagraph-studio[{name}]"',
            )
        )
    if not make_own(place):
        raise ExtraError(phrase("{folder} cannot be written to", folder=place))
    # Into a folder of its own first: what fails half way leaves nothing.
    fresh = place.parent / f"{place.name}-{name}-new"
    shutil.rmtree(fresh, ignore_errors=True)
    command = make_python_command(
        "pip", "install", "--quiet", "--target", str(fresh), "--only-binary", ":all:"
    )
    try:
        code, words = run_program(
            [*command, *extra.wants], MINUTES * 60, env={"PIP_RETRIES": os.environ.get("PIP_RETRIES", "2")}
        )
        if code != 0:
            said = [line for line in words.splitlines() if "ERROR" in line] or words.splitlines()[-1:]
            raise ExtraError(
                phrase(
                    "It could not be installed ({why}). Check the network and try again.",
                    why=" ".join(said).strip() or f"pip ended with {code}",
                )
            )
        for part in fresh.iterdir():
            if (ROOT / part.name).exists():  # the bundle has it, and its own comes first
                shutil.rmtree(part) if part.is_dir() else part.unlink()
        target = place / name
        shutil.rmtree(target, ignore_errors=True)
        fresh.replace(target)
    except (OSError, TimeoutError) as error:
        raise ExtraError(str(error)) from None
    finally:
        shutil.rmtree(fresh, ignore_errors=True)
    add_extras()


def remove_extra(name: str) -> bool:
    """Remove an extra from the user's folder; return whether it was there. It goes with the next start."""
    place = find_extras_folder()
    if place is None or name not in EXTRAS or not (place / name).is_dir():
        return False
    shutil.rmtree(place / name)
    return True


def add_extras() -> None:
    """Have Python find the extras that the user installed, after its own packages."""
    importlib.invalidate_caches()
    place = find_extras_folder()
    for name in EXTRAS if place is not None and place.is_dir() else ():
        folder = str(place / name) if place is not None else ""
        if Path(folder).is_dir() and folder not in sys.path:
            sys.path.append(folder)
