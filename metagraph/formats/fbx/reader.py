"""Read FBX motion through the optional ufbx library, in separate processes, so that a crash affects only one
file.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Collection
from pathlib import Path

import numpy as np

from metagraph.common.budgets import MOTION_FILE
from metagraph.common.extras import describe_missing_extra
from metagraph.common.files import check_file
from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.fbx import child as fbx_child
from metagraph.formats.fbx.processes import ReaderError, convert
from metagraph.formats.gltf.clips import read_animations
from metagraph.formats.gltf.file import parse_gltf
from metagraph.formats.gltf.skeleton import build_rig
from metagraph.formats.takes import make_takes_unique
from metagraph.motion.clip import Clip

TIMEOUT = 120.0  # seconds for one file
_AGAIN = phrase("Export it again from the program that made it, as binary FBX 2014 or later, or as GLB.")


def read_fbx_clips(path: str | Path, timeout: float = TIMEOUT, as_is: Collection[str] = ()) -> list[Clip]:
    """Return every take of an FBX file, with the weights of its blend shapes, sampled at the file's own rate
    (30 fps if that is not from 10 to 240), in metres, Y up, on one Skeleton.

    Needs the extra `metagraph-studio[fbx]`. Meshes are not read. `as_is` names repairs (`takes.REPAIRS`) not
    to make. Raises FileError, also if the library is missing, takes longer than `timeout` seconds or crashes
    on the file.
    """
    path = check_file(path, MOTION_FILE)
    if importlib.util.find_spec("ufbx") is None:
        raise FileError(
            path,
            phrase("it is an FBX file"),
            phrase("on opening it"),
            describe_missing_extra("fbx", phrase("Reading FBX")),
        )
    data = _converted(path, timeout)
    gltf = parse_gltf(path, data)
    if not gltf.json.animations:
        raise FileError(
            path,
            phrase("it holds no animation"),
            phrase("its animations"),
            phrase("Export it with its animation baked."),
        )
    with np.errstate(all="ignore"):
        clips = read_animations(gltf, build_rig(gltf, as_is), as_is)
    if not clips:
        raise FileError(
            path,
            phrase("none of its takes moves the skeleton"),
            phrase("its animations"),
            phrase("Export it with its animation baked."),
        )
    return make_takes_unique(clips)


def _converted(path: Path, timeout: float) -> bytes:
    """Return the file as binary glTF, made by another process."""
    try:
        return convert(path, timeout)
    except OSError as error:
        raise FileError(
            path,
            phrase("the FBX reader did not start ({strerror})", strerror=error.strerror),
            phrase("on opening it"),
            phrase("Install Metagraph again."),
        ) from error
    except ReaderError as error:
        raise _told(path, error, timeout) from None


def _told(path: Path, error: ReaderError, timeout: float) -> FileError:
    code, words = error.code, error.words or "no reason given"
    if code is None:
        return FileError(
            path,
            phrase("it could not be read within {timeout:.0f} s", timeout=timeout),
            phrase("on reading it"),
            _AGAIN,
        )
    if code == fbx_child.MISSING:
        return FileError(
            path,
            phrase("the ufbx library is installed but does not load"),
            phrase("on opening it"),
            phrase("Remove the extra 'fbx' and install it again: Help > Extras"),
        )
    if code == fbx_child.REFUSED:
        return FileError(
            path, phrase("it is not a valid FBX file ({words})", words=words), phrase("its content"), _AGAIN
        )
    if code < 0:
        return FileError(
            path,
            phrase("the FBX library crashed on it (signal {value})", value=-code),
            phrase("its content"),
            _AGAIN,
        )
    return FileError(
        path, phrase("it could not be converted ({words})", words=words), phrase("its content"), _AGAIN
    )
