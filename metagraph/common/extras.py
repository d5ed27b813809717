"""Extras: packages that are too large to bring along. A bundle installs them into the user's own folder; so
does any installation with those that live apart from the program's own packages.
"""

from __future__ import annotations

import importlib
import os
import shutil
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from metagraph.common.programs import ROOT, is_own, make_own, make_python_command, run_program
from metagraph.common.user_folders import find_user_folder
from metagraph.common.wording import phrase


@dataclass(frozen=True)
class Extra:
    """A package that some jobs need. module: what is imported. wants: what pip is asked for. brings: what it
    is for, in words. megabytes: on disk, with what it needs, about. holds: for an extra that lives apart, the
    files that it must bring; only a process of its own imports it, from `find_extra_folder`, and `wants` is
    all that it needs. newest: the newest Python, 3.x, that there are packages for; None for any.
    """

    module: str
    wants: tuple[str, ...]
    brings: str
    megabytes: int
    licence: str
    holds: tuple[str, ...] = ()
    newest: int | None = None


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
    # Packages from 0.10.30 on have neither `solutions` nor a model in them. What it asks for beside these
    # (OpenCV, JAX, Matplotlib, SentencePiece) is for drawing and for other models than the body's.
    "camera": Extra(
        "mediapipe",
        ("mediapipe>=0.10.14,<0.10.22", "numpy>=1.26,<2", "protobuf>=4.25.3,<5", "absl-py>=2"),
        phrase("finding the joints of a person in a video or before a camera"),
        150,
        "Apache-2.0",
        (
            "mediapipe/modules/pose_detection/pose_detection.tflite",
            "mediapipe/modules/pose_landmark/pose_landmark_full.tflite",
            "mediapipe/python/solutions/pose.py",
        ),
        12,
    ),
}
MINUTES = 30.0  # the longest that pip may take


class ExtraError(RuntimeError):
    """An extra could not be installed or removed; the message says why and what to do."""


def is_bundle() -> bool:
    """Return whether this is a bundle, which brings its own Python."""
    return (ROOT / "bundled").exists()


def find_extras_folder() -> Path | None:
    """Return where a bundle keeps the extras of this Python, and any installation those that live apart; None
    if nobody's home is known.
    """
    data = find_user_folder("data")
    version = f"{sys.version_info[0]}.{sys.version_info[1]}"
    return data / "Metagraph" / f"extras-{version}" if data is not None else None


def is_installed(name: str) -> bool:
    """Return whether an extra can be imported. Raises KeyError for a name that is no extra's."""
    if EXTRAS[name].holds:
        return find_extra_folder(name) is not None
    return find_spec(EXTRAS[name].module) is not None


def find_extra_folder(name: str) -> Path | None:
    """Return the folder of an extra that lives apart; None if it is not installed, or others can write to
    it. Raises KeyError for a name that is no extra's.
    """
    place = find_extras_folder()
    if place is None or not _holds_all(place / name, EXTRAS[name]) or not is_own(place / name):
        return None
    return place / name


def _holds_all(folder: Path, extra: Extra) -> bool:
    return all((folder / file).is_file() for file in extra.holds)


def install_extra(name: str) -> None:
    """Install an extra into the user's folder, so that it can be imported at once; it takes minutes. Raises
    ExtraError, and KeyError for a name that is no extra's.
    """
    extra = EXTRAS[name]
    place = find_extras_folder()
    if extra.newest is not None and sys.version_info[:2] > (3, extra.newest):
        raise ExtraError(
            phrase(
                "Its packages are made for Python 3.{newest} and older. Metagraph runs with Python {version} "
                "here. Use a Metagraph that brings its own Python, or install it with Python 3.{newest}.",
                newest=extra.newest,
                version=f"{sys.version_info[0]}.{sys.version_info[1]}",
            )
        )
    if extra.holds and place is None:
        raise ExtraError(phrase("The user's folder for data is not known: set HOME"))
    if place is None or not (is_bundle() or extra.holds):
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
    ) + (["--no-deps"] if extra.holds else [])
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
        if not _holds_all(fresh, extra):
            raise ExtraError(phrase("The package that was loaded lacks the files that Metagraph needs."))
        for part in () if extra.holds else fresh.iterdir():
            if (ROOT / part.name).exists():  # the bundle has it, and its own comes first
                shutil.rmtree(part) if part.is_dir() else part.unlink()
        target = place / name
        shutil.rmtree(target, ignore_errors=True)
        fresh.replace(target)
        make_own(target)  # whatever the user's mask is, others cannot write there
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
    for name, extra in EXTRAS.items() if place is not None and place.is_dir() else ():
        if extra.holds:
            continue
        folder = str(place / name) if place is not None else ""
        if Path(folder).is_dir() and folder not in sys.path:
            sys.path.append(folder)
