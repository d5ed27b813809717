"""List the kinds of clip files: how each is recognised by its first bytes, and what reads it.

A reader is imported when the first file of its kind is read.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass
from pathlib import Path

from metagraph.common.wording import Phrase, phrase
from metagraph.formats.face_exports import is_face_json, is_face_table
from metagraph.formats.live_link_face import is_live_link
from metagraph.formats.markers.marker_reading import is_c3d, is_trc
from metagraph.motion.clip import Clip

HEAD = 4096  # bytes that show what a file is
_MOTION = "skeleton and motion"
_FACED = "skeleton, motion and blend shapes"
_GLTF = (".glb", ".gltf")
_MARKERS = "joint centres between the markers of the usual sets, and motion from them"


@dataclass(frozen=True)
class KnownTool:
    """A program whose files are read, as the manual's table shows it (`docs/readers_page.py`).

    versions: which of it, or how it names them. holds: what is read. by_tool: whether this was checked with a
    file that the tool itself made; else with one that follows its published description. endings: of its
    files, if they are not all of the reader's.
    """

    name: str
    versions: str
    holds: str
    by_tool: bool = False
    endings: tuple[str, ...] = ()


@dataclass(frozen=True)
class ClipReader:
    """A kind of clip file.

    `name` says for people what such a file is. `suffixes` are in lower case. `begins` returns whether the
    first bytes are of this kind; it gets them as they are, and without what may precede text. `read` returns
    the takes of a file; its second argument are repairs (`takes.REPAIRS`) not to make. `tools` write such
    files.
    """

    name: str
    suffixes: tuple[str, ...]
    begins: Callable[[bytes, bytes], bool]
    read: Callable[[Path, Collection[str]], list[Clip]]
    tools: tuple[KnownTool, ...] = ()


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
    phrase("a recording of Live Link Face"),
    (".csv",),
    lambda head, text: is_live_link(head),
    _read_live_link,
    (KnownTool("Live Link Face", "CSV, commas or semicolons", "52 face curves, head and eyes"),),
)
FACE_TABLE = ClipReader(
    phrase("a face of Audio2Face"),
    (".csv",),
    lambda head, text: is_face_table(head),
    _read_face_export,
    (KnownTool("NVIDIA Audio2Face-3D", "CSV", "52 face curves"),),
)
FACE_JSON = ClipReader(
    phrase("a face of Audio2Face or Azure"),
    (".json",),
    lambda head, text: is_face_json(head),
    _read_face_export,
    (
        KnownTool("NVIDIA Audio2Face", "JSON", "52 face curves"),
        KnownTool(
            "Azure Speech", "JSON of its blend shape events", "52 face curves; no turns of head or eyes"
        ),
    ),
)
FACE_READERS = (LIVE_LINK, FACE_TABLE, FACE_JSON)
# The first reader that recognises the beginning of a file reads it.
READERS = [
    ClipReader(
        phrase("a BVH file"),
        (".bvh",),
        lambda head, text: text[:9].upper() == b"HIERARCHY",
        _read_bvh,
        (
            KnownTool("Any", "any order of channels, centimetres, metres or inches", _MOTION, True),
            KnownTool("Xsens MVN", "positions of all joints, YXZ", _MOTION),
            KnownTool("Perception Neuron (Axis)", "positions of all joints, YXZ, or none", _MOTION),
            KnownTool("Rokoko Studio", "positions relative to OFFSET", _MOTION),
        ),
    ),
    FACE_JSON,
    ClipReader(
        phrase("a glTF file"),
        (".glb", ".gltf", ".vrm", ".vrma"),
        lambda head, text: head.startswith(b"glTF") or text.startswith(b"{"),
        _read_gltf,
        (
            KnownTool("Any", "2.0; quantized, meshopt or KHR_animation_pointer too", _FACED, True, _GLTF),
            KnownTool(
                "Blender, Cascadeur",
                "slotted actions: a body's and a face's animation",
                "both as one take if they are equally long",
                endings=_GLTF,
            ),
            KnownTool("VRM", "0.x, 1.0", _FACED, endings=(".vrm",)),
            KnownTool("VRM animation", "1.0", "skeleton, motion, expressions", endings=(".vrma",)),
        ),
    ),
    ClipReader(
        phrase("an FBX file"),
        (".fbx",),
        _is_fbx,
        _read_fbx,
        (KnownTool("Any", "6.x, 7.x, binary or text", f"{_FACED}, at the file's frame rate", True),),
    ),
    LIVE_LINK,
    FACE_TABLE,
    ClipReader(
        phrase("an AMC file"),
        (".amc",),
        lambda head, text: b":FULLY-SPECIFIED" in head.upper() or text.startswith(b"#!OML:ASF"),
        _read_amc,
        (KnownTool("Acclaim (CMU)", "AMC, with the ASF beside it", _MOTION),),
    ),
    ClipReader(
        phrase("SMPL parameters (AMASS, BEAT2)"),
        (".npz",),
        lambda head, text: head.startswith(b"PK\x03\x04") and b".npy" in head[:300],
        _read_smpl,
        (
            KnownTool("AMASS", "SMPL-H, SMPL-X", "motion, on a figure of ours"),
            KnownTool("BEAT2", "SMPL-X 2020", "motion and the jaw, on a figure of ours; no expressions"),
            KnownTool("SMPL, SMPL-H, SMPL-X", "`.npz` with poses of 22 to 55 joints", "motion, as above"),
        ),
    ),
    ClipReader(
        phrase("markers (TRC)"),
        (".trc",),
        lambda head, text: is_trc(head),
        _read_markers,
        (KnownTool("OpenSim, OpenCap, Cortex", "TRC", _MARKERS),),
    ),
    ClipReader(
        phrase("markers (C3D)"),
        (".c3d",),
        lambda head, text: is_c3d(head),
        _read_markers,
        (KnownTool("Vicon, OptiTrack, Qualisys", "C3D", _MARKERS),),
    ),
]


def find_reader(head: bytes) -> ClipReader | None:
    """Return the reader of files with this beginning; None if there is none."""
    text = head.lstrip(b"\xef\xbb\xbf \t\r\n")
    return next((reader for reader in READERS if reader.begins(head, text)), None)


def find_reader_for(suffix: str) -> ClipReader | None:
    """Return the reader of files with this extension, in lower case; None if there is none."""
    return next((reader for reader in READERS if suffix in reader.suffixes), None)


def describe_clip_files() -> Phrase:
    """Return a sentence that says which files are clips."""
    return phrase("Clips are {endings} files.", endings=", ".join(list_clip_suffixes()))


def list_clip_suffixes() -> tuple[str, ...]:
    """Return the extensions of clip files, in lower case; without .json, which most often is something else:
    there only the content tells.
    """
    return tuple(dict.fromkeys(s for reader in READERS if reader is not FACE_JSON for s in reader.suffixes))
