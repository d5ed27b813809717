"""Extras: packages that are too large to bring along, and how this Metagraph gets them. `extra_steps`
installs and removes them.

Some live apart: packages that do not go with Metagraph's own, in a folder of the user's, whichever way
Metagraph itself was installed. Only a process of their own imports them.
"""

from __future__ import annotations

import importlib
import subprocess
import sys
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, distribution, version
from importlib.util import find_spec
from pathlib import Path
from typing import Literal

from metagraph.common.programs import ROOT, is_own
from metagraph.common.user_folders import find_user_folder
from metagraph.common.wording import Phrase, phrase


@dataclass(frozen=True)
class Extra:
    """A package that some jobs need. module: what is imported. wants: what pip is asked for. brings: what it
    is for, in words. download, megabytes: to load and on disk with what it needs, in MB, about. packages:
    what removing it takes away. beside: packages of Metagraph's own that it works with. holds: for an extra
    that lives apart, the files that it must bring; `wants` is then all that it needs. newest: the newest
    Python, 3.x, that there are packages for; None for any.
    """

    module: str
    wants: tuple[str, ...]
    title: str
    brings: str
    download: int
    megabytes: int
    licence: str
    packages: tuple[str, ...]
    beside: tuple[str, ...] = ()
    holds: tuple[str, ...] = ()
    newest: int | None = None


CPU = ("--extra-index-url", "https://download.pytorch.org/whl/cpu")
EXTRAS: Mapping[str, Extra] = {
    "compiled": Extra(
        "numba",
        ("numba>=0.60",),
        phrase("Fast motion graphs (numba)"),
        phrase("building and searching motion graphs in seconds instead of minutes"),
        60,
        210,
        "BSD-2-Clause",
        ("numba", "llvmlite"),
        ("numpy",),
    ),
    "fbx": Extra(
        "ufbx", ("ufbx>=0.0.5",), phrase("FBX (ufbx)"), phrase("reading FBX files"), 2, 6, "MIT", ("ufbx",)
    ),
    "train": Extra(
        "torch",
        ("torch>=2.4", *CPU),
        phrase("Training (PyTorch)"),
        phrase("training models of motion from takes"),
        200,
        750,
        "BSD-3-Clause",
        ("torch",),
    ),
    "lab": Extra(
        "pylsl",
        ("pylsl>=1.16",),
        phrase("Lab recorders (LSL)"),
        phrase("streams to and from devices of laboratories (LSL)"),
        1,
        5,
        "MIT",
        ("pylsl",),
        ("numpy",),
    ),
    "studies": Extra(
        "scipy",
        ("scipy>=1.11",),
        phrase("Statistics of studies (SciPy)"),
        phrase("planning and reporting studies"),
        35,
        145,
        "BSD-3-Clause",
        ("scipy",),
        ("numpy",),
    ),
    # Packages from 0.10.30 on have neither `solutions` nor a model in them. What it asks for beside these
    # (OpenCV, JAX, Matplotlib, SentencePiece) is for drawing and for other models than the body's.
    "camera": Extra(
        "mediapipe",
        ("mediapipe>=0.10.14,<0.10.22", "numpy>=1.26,<2", "protobuf>=4.25.3,<5", "absl-py>=2"),
        phrase("Videos and cameras (MediaPipe)"),
        phrase("finding the joints of a person in a video or before a camera"),
        55,
        150,
        "Apache-2.0",
        ("mediapipe",),
        (),
        (
            "mediapipe/modules/pose_detection/pose_detection.tflite",
            "mediapipe/modules/pose_landmark/pose_landmark_full.tflite",
            "mediapipe/python/solutions/pose.py",
        ),
        12,
    ),
}
Way = Literal["bundle", "run.py", "pipx", "uv", "pip"]
NAME = "metagraph-studio"
_MISSING = phrase(
    "{what} needs {module} (the extra '{extra}'), which is not installed: {download} MB to "
    "download, {megabytes} MB on disk. Choose Help > Extras, or run: {command}"
).template


def is_bundle() -> bool:
    """Return whether this is a bundle, which brings its own Python."""
    return (ROOT / "bundled").exists()


def find_way() -> Way:
    """Return how this Metagraph was installed, by the files that installers leave."""
    place = Path(sys.prefix)
    if is_bundle():
        return "bundle"
    if (ROOT / "run.py").exists() and any((place / x).exists() for x in (".installed", ".installed-test")):
        return "run.py"
    if (place / "uv-receipt.toml").exists():
        return "uv"
    return "pipx" if (place / "pipx_metadata.json").exists() else "pip"


def is_in_own_folder(name: str) -> bool:
    """Return whether an extra is kept in a folder of its own: each of a bundle, and those that live apart."""
    return is_bundle() or bool(EXTRAS[name].holds)


def can_install(name: str) -> bool:
    """Return whether Metagraph itself may install an extra: into a folder or an environment of its own."""
    return is_in_own_folder(name) or find_way() == "run.py"


def find_extras_folder() -> Path | None:
    """Return where extras with folders of their own are, for this Python; None if nobody's home is known."""
    data = find_user_folder("data")
    return data / "Metagraph" / f"extras-{_python_version()}" if data is not None else None


def _python_version() -> str:
    return f"{sys.version_info[0]}.{sys.version_info[1]}"


def is_installed(name: str) -> bool:
    """Return whether an extra can be imported, or used by a process of its own. Raises KeyError for a name
    that is no extra's.
    """
    if EXTRAS[name].holds:
        return find_extra_folder(name) is not None
    return find_spec(EXTRAS[name].module) is not None


def find_extra_folder(name: str) -> Path | None:
    """Return the folder of an extra that lives apart; None if it is not installed, or others can write to
    it. Raises KeyError for a name that is no extra's.
    """
    place = find_extras_folder()
    if place is None or not holds_all(place / name, EXTRAS[name]) or not is_own(place / name):
        return None
    return place / name


def holds_all(folder: Path, extra: Extra) -> bool:
    """Return whether a folder has the files that an extra must bring."""
    return all((folder / file).is_file() for file in extra.holds)


def is_removable(name: str) -> bool:
    """Return whether Metagraph itself may remove an extra: it installed it, and it did not come with it."""
    place = find_extras_folder()
    if is_in_own_folder(name):
        return place is not None and (place / name).is_dir()
    return can_install(name) and is_installed(name)


def measure_extra(name: str) -> int:
    """Return the bytes on disk that removing an extra would free; 0 if it is not there."""
    place = find_extras_folder()
    if is_in_own_folder(name):
        folder = place / name if place is not None else None
        return sum(f.stat().st_size for f in folder.rglob("*") if f.is_file()) if folder is not None else 0
    size = 0
    for package in EXTRAS[name].packages:
        with suppress(PackageNotFoundError, OSError):
            files = [Path(str(file.locate())) for file in distribution(package).files or ()]
            size += sum(file.stat().st_size for file in files if file.is_file())
    return size


def find_wants(name: str) -> tuple[str, ...]:
    """Return what pip is asked for, with the versions of Metagraph's own packages that it has to fit."""
    extra = EXTRAS[name]
    with suppress(PackageNotFoundError):
        return (*extra.wants, *(f"{package}=={version(package)}" for package in extra.beside))
    return extra.wants


def make_install_command(name: str) -> str:
    """Return the line that installs an extra, for a terminal of this system."""
    extra, way = EXTRAS[name], find_way()
    if is_in_own_folder(name):
        return f"metagraph extras add {name}"
    if way == "pipx":
        return join_command(["pipx", "inject", NAME, extra.wants[0]])
    if way == "uv":  # a tool is made again with all that is wished
        wished = [x.wants[0] for other, x in _list_shared() if other == name or is_installed(other)]
        return join_command(["uv", "tool", "install", NAME, *(w for one in wished for w in ("--with", one))])
    return join_command([sys.executable, "-m", "pip", "install", *extra.wants])


def _list_shared() -> list[tuple[str, Extra]]:
    """Return the extras that share an environment with Metagraph."""
    return [(name, extra) for name, extra in EXTRAS.items() if not extra.holds]


def make_remove_command(name: str) -> str:
    """Return the line that removes an extra, for a terminal of this system."""
    extra, way = EXTRAS[name], find_way()
    if is_in_own_folder(name):
        return f"metagraph extras remove {name}"
    if way == "pipx":
        return join_command(["pipx", "uninject", NAME, *extra.packages])
    if way == "uv":
        left = [x.wants[0] for other, x in _list_shared() if other != name and is_installed(other)]
        return join_command(["uv", "tool", "install", NAME, *(w for one in left for w in ("--with", one))])
    return join_command([sys.executable, "-m", "pip", "uninstall", *extra.packages])


def make_download_command(name: str) -> str:
    """Return the line that loads an extra's files on another computer, with any Python, for this system and
    this Python; into the folder `metagraph-NAME`.
    """
    options = ["--only-binary", ":all:", "--python-version", _python_version(), "--implementation", "cp"]
    for tag in _list_platform_tags():
        options += ["--platform", tag]
    options += ["--no-deps"] if EXTRAS[name].holds else []
    command = ["python3", "-m", "pip", "download", "--dest", f"metagraph-{name}", *options]
    return join_command([*command, *find_wants(name)])


def make_offline_command(name: str) -> str:
    """Return the line that installs an extra from the folder of files that `make_download_command` loaded."""
    folder = f"metagraph-{name}"
    if is_in_own_folder(name):
        return f"metagraph extras add {name} --from {folder}"
    wants = [word for word in EXTRAS[name].wants if word not in CPU]
    pip = [sys.executable, "-m", "pip", "install", "--no-index", "--find-links", folder, *wants]
    if find_way() == "uv":  # its tools have no pip
        pip = ["uv", "pip", "install", "--python", sys.executable, *pip[4:]]
    if find_way() == "pipx":
        return join_command(["pipx", "inject", NAME, *wants, "--pip-args", make_pip_options(folder)])
    return join_command(pip)


def make_pip_options(folder: str) -> str:
    """Return the options with which pip takes what it needs from a folder alone."""
    return f"--no-index --find-links {folder}"


def join_command(words: Sequence[str]) -> str:
    """Return a command as one line for a terminal of this system."""
    if sys.platform == "win32":
        return subprocess.list2cmdline(words)
    return " ".join(f'"{w}"' if any(c in w for c in " <>=&;()") else w for w in words)


def _list_platform_tags() -> list[str]:
    """Return the tags of wheels that this system takes, as pip's --platform wants them."""
    import platform

    machine = platform.machine().lower()
    if sys.platform == "win32":
        return ["win_arm64" if "arm" in machine else "win_amd64"]
    if sys.platform == "darwin":
        return [f"macosx_14_0_{machine}", f"macosx_11_0_{machine}"]
    return [f"{name}_{machine}" for name in ("manylinux_2_28", "manylinux_2_17", "manylinux2014")]


def describe_missing_extra(name: str, what: str) -> Phrase:
    """Return that something needs an extra and how to get it; the window offers the extras where it shows
    this. what: a phrase, such as "reading FBX files".
    """
    extra = EXTRAS[name]
    return Phrase(
        _MISSING,
        {
            "what": what,
            "module": extra.module,
            "extra": name,
            "download": extra.download,
            "megabytes": extra.megabytes,
            "command": make_install_command(name),
        },
    )


def find_missing_extra(words: object) -> str | None:
    """Return the extra that a text of `describe_missing_extra` names, also deep in other phrases."""
    if isinstance(words, BaseException):
        words = words.args[0] if words.args else ""
    if not isinstance(words, Phrase):
        return None
    if words.template == _MISSING:
        return str(words.values["extra"])
    return next((found for value in words.values.values() if (found := find_missing_extra(value))), None)


def add_extras() -> None:
    """Have Python find the extras that the user installed, after its own packages."""
    importlib.invalidate_caches()
    place = find_extras_folder()
    for name, _ in _list_shared() if place is not None and place.is_dir() else ():
        folder = str(place / name) if place is not None else ""
        if Path(folder).is_dir() and folder not in sys.path:
            sys.path.append(folder)
