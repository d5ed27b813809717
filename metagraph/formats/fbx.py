"""Read FBX motion through the optional ufbx library, in a process of its own: one file a process, so a crash
costs one file.
"""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
from collections.abc import Collection
from pathlib import Path

import numpy as np

from metagraph.errors import FileError
from metagraph.formats import fbx_child
from metagraph.formats.gltf_clips import read_clip
from metagraph.formats.gltf_file import parse_gltf
from metagraph.formats.gltf_skeleton import build_rig
from metagraph.formats.takes import unique_takes
from metagraph.motion.clip import Clip

TIMEOUT = 120.0  # seconds for one file
_AGAIN = "Export it again from the program that made it, as binary FBX 2014 or later, or as GLB."


def read_fbx_clips(path: str | Path, timeout: float = TIMEOUT, as_is: Collection[str] = ()) -> list[Clip]:
    """Return every take of an FBX file, sampled at 30 fps, in metres, Y up, on one Skeleton.

    Needs the extra `metagraph[fbx]`. Meshes and blend shapes are not read. Raises FileError, also when the
    library is missing, takes longer than `timeout` seconds or crashes on the file. as_is: repairs
    (`takes.REPAIRS`) not to make.
    """
    path = Path(path)
    if not path.is_file():
        raise FileError(
            path,
            "it cannot be read (no such file)",
            "on opening it",
            "Check that it exists and that you may read it.",
        )
    if importlib.util.find_spec("ufbx") is None:
        raise FileError(
            path,
            "reading FBX needs the ufbx library, which is not installed",
            "on opening it",
            "Run: pip install metagraph[fbx]",
        )
    data = _converted(path, timeout)
    gltf = parse_gltf(path, data)
    if not gltf.json.animations:
        raise FileError(
            path, "it holds no animation", "its animations", "Export it with its animation baked."
        )
    with np.errstate(all="ignore"):
        rig = build_rig(gltf, as_is)
        clips = [
            clip
            for i in range(len(gltf.json.animations))
            if (clip := read_clip(gltf, rig, i, as_is)) is not None
        ]
    if not clips:
        raise FileError(
            path,
            "none of its takes moves the skeleton",
            "its animations",
            "Export it with its animation baked.",
        )
    return unique_takes(clips)


def _converted(path: Path, timeout: float) -> bytes:
    """Return the file as binary glTF, made by a child process."""
    root = str(Path(__file__).resolve().parents[2])
    known = os.environ.get("PYTHONPATH")
    environment = {
        **os.environ,
        "PYTHONPATH": root if not known else os.pathsep.join((root, known)),
        "OMP_NUM_THREADS": "1",
    }
    command = [sys.executable, "-m", fbx_child.__name__, str(path.resolve())]
    try:
        done = subprocess.run(
            command,
            capture_output=True,
            timeout=timeout,
            env=environment,
            stdin=subprocess.DEVNULL,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise FileError(
            path, f"it could not be read within {timeout:.0f} s", "on reading it", _AGAIN
        ) from None
    except OSError as error:
        raise FileError(
            path,
            f"the reader of FBX files did not start ({error.strerror})",
            "on opening it",
            "Install Metagraph again.",
        ) from error
    if done.returncode == 0:
        return done.stdout
    said = done.stderr.decode("utf-8", "replace").strip().splitlines()
    if done.returncode == fbx_child.MISSING:
        raise FileError(
            path,
            "the ufbx library is installed but does not load",
            "on opening it",
            "Run: pip install --force-reinstall metagraph[fbx]",
        )
    if done.returncode == fbx_child.REFUSED:
        raise FileError(
            path,
            f"it is not a sound FBX file ({said[-1].strip(chr(34)) if said else 'no reason given'})",
            "its content",
            _AGAIN,
        )
    if done.returncode < 0:
        raise FileError(
            path, f"the FBX library crashed on it (signal {-done.returncode})", "its content", _AGAIN
        )
    raise FileError(
        path, f"it could not be converted ({said[-1] if said else 'no reason given'})", "its content", _AGAIN
    )
