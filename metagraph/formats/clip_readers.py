"""List the kinds of clip files: how each is recognised by its first bytes, and what reads it.

A reader is imported when the first file of its kind is read.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass
from pathlib import Path

from metagraph.common.wording import phrase
from metagraph.formats.face_exports import is_face_json, is_face_table
from metagraph.formats.live_link_face import is_live_link
from metagraph.formats.markers.marker_reading import is_c3d, is_trc
from metagraph.motion.clip import Clip

HEAD = 4096  # bytes that show what a file is


@dataclass(frozen=True)
class ClipReader:
    """A kind of clip file.

    `name` says for people what such a file is. `suffixes` are in lower case. `begins` returns whether the
    first bytes are of this kind; it gets them as they are, and without what may precede text. `read` returns
    the takes of a file; its second argument are repairs (`takes.REPAIRS`) not to make.
    """

    name: str
    suffixes: tuple[str, ...]
    begins: Callable[[bytes, bytes], bool]
    read: Callable[[Path, Collection[str]], list[Clip]]


def _read_bvh(path: Path, as_is: Collection[str]) -> list[Clip]:
    from metagraph.formats.bvh.file import read_bvh

    return [read_bvh(path, as_is=as_is)]


def _read_gltf(path: Path, as_is: Collection[str]) -> list[Clip]:
    from metagraph.formats.gltf.reader import read_gltf_clips

    return read_gltf_clips(path, as_is)


def _read_fbx(path: Path, as_is: Collection[str]) -> list[Clip]:
    from metagraph.formats.fbx.reader import read_fbx_clips

    return read_fbx_clips(path, as_is=as_is)


def _read_live_link(path: Path, as_is: Collection[str]) -> list[Clip]:
    from metagraph.formats.live_link_face import read_live_link

    return [read_live_link(path)]


def _read_smpl(path: Path, as_is: Collection[str]) -> list[Clip]:
    from metagraph.formats.smpl import read_smpl

    return [read_smpl(path)]


def _read_amc(path: Path, as_is: Collection[str]) -> list[Clip]:
    from metagraph.formats.acclaim import read_amc

    return [read_amc(path)]


def _read_face_export(path: Path, as_is: Collection[str]) -> list[Clip]:
    from metagraph.formats.face_exports import read_face_export

    return [read_face_export(path)]


def _read_markers(path: Path, as_is: Collection[str]) -> list[Clip]:
    from metagraph.formats.markers.marker_clips import read_marker_clip

    return [read_marker_clip(path)]


def _is_fbx(head: bytes, text: bytes) -> bool:
    return (
        head.startswith(b"Kaydara FBX Binary") or text.startswith(b"; FBX") or b"FBXHeaderExtension" in head
    )


LIVE_LINK = ClipReader(
    phrase("a recording of Live Link Face"), (".csv",), lambda head, text: is_live_link(head), _read_live_link
)
FACE_TABLE = ClipReader(
    phrase("a face of Audio2Face"), (".csv",), lambda head, text: is_face_table(head), _read_face_export
)
FACE_JSON = ClipReader(
    phrase("a face of Audio2Face or Azure"),
    (".json",),
    lambda head, text: is_face_json(head),
    _read_face_export,
)
FACE_READERS = (LIVE_LINK, FACE_TABLE, FACE_JSON)
# The first reader that recognises the beginning of a file reads it.
READERS = [
    ClipReader(
        phrase("a BVH file"), (".bvh",), lambda head, text: text[:9].upper() == b"HIERARCHY", _read_bvh
    ),
    FACE_JSON,
    ClipReader(
        phrase("a glTF file"),
        (".glb", ".gltf", ".vrm", ".vrma"),
        lambda head, text: head.startswith(b"glTF") or text.startswith(b"{"),
        _read_gltf,
    ),
    ClipReader(phrase("an FBX file"), (".fbx",), _is_fbx, _read_fbx),
    LIVE_LINK,
    FACE_TABLE,
    ClipReader(
        phrase("an AMC file"),
        (".amc",),
        lambda head, text: b":FULLY-SPECIFIED" in head.upper() or text.startswith(b"#!OML:ASF"),
        _read_amc,
    ),
    ClipReader(
        phrase("SMPL parameters (AMASS, BEAT2)"),
        (".npz",),
        lambda head, text: head.startswith(b"PK\x03\x04") and b".npy" in head[:300],
        _read_smpl,
    ),
    ClipReader(phrase("markers (TRC)"), (".trc",), lambda head, text: is_trc(head), _read_markers),
    ClipReader(phrase("markers (C3D)"), (".c3d",), lambda head, text: is_c3d(head), _read_markers),
]


def find_reader(head: bytes) -> ClipReader | None:
    """Return the reader of files with this beginning; None if there is none."""
    text = head.lstrip(b"\xef\xbb\xbf \t\r\n")
    return next((reader for reader in READERS if reader.begins(head, text)), None)


def find_reader_for(suffix: str) -> ClipReader | None:
    """Return the reader of files with this extension, in lower case; None if there is none."""
    return next((reader for reader in READERS if suffix in reader.suffixes), None)


def list_clip_suffixes() -> tuple[str, ...]:
    """Return the extensions of clip files, in lower case; without .json, which most often is something else:
    there only the content tells.
    """
    return tuple(dict.fromkeys(s for reader in READERS if reader is not FACE_JSON for s in reader.suffixes))
