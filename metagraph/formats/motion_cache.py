"""What was read of clip files, kept in the user's folder for such things: opening a project again takes a
tenth of the time, whatever the files' format.

Kept under what a file holds, its name, what was left as it is, and the programs that read it: when any of
these is another, it is read again. What cannot be read back, whatever is wrong with it, is read again as
well, so losing it costs time alone. METAGRAPH_MOTION_CACHE names another folder; empty, nothing is kept.
"""

from __future__ import annotations

import hashlib
import os
import struct
import zlib
from collections.abc import Collection, Iterable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from metagraph.common.disk_cache import DiskCache, cache_folder
from metagraph.formats.clips import read_clips
from metagraph.motion.clip import Clip, Repair
from metagraph.motion.skeleton import Skeleton

Array = NDArray[Any]

MOST = 1 << 29  # bytes that are kept
LARGEST = 1 << 27  # bytes of one file's motion
MARK = b"metagraph motion 1"
_HEAD = struct.Struct("<18sI")

_skeletons: dict[bytes, Skeleton] = {}  # what was read lately: clips of a project share theirs
_SKELETONS = 64


class KeptSkeleton(msgspec.Struct, array_like=True):
    """A skeleton, its arrays as bytes: parents int32, rest rotations and translations float64."""

    names: tuple[str, ...]
    parents: bytes
    rotations: bytes
    translations: bytes


class KeptClip(msgspec.Struct, array_like=True):
    """A clip, its arrays as bytes, float32. skeleton: which of its file's."""

    name: str
    skeleton: int
    fps: float
    frames: int
    rotations: memoryview
    translations: memoryview
    translated: tuple[int, ...]
    morphs: tuple[str, ...]
    weights: memoryview
    notes: tuple[str, ...]
    repairs: tuple[tuple[str, str, bool, int | None], ...]
    brought_from: str
    face_of: str


class KeptFile(msgspec.Struct, array_like=True):
    """What a file holds. skeletons: each encoded by itself, so that the same one is made once."""

    skeletons: tuple[bytes, ...]
    clips: tuple[KeptClip, ...]


def read_or_kept(path: Path, digest: str, as_is: Collection[str]) -> list[Clip]:
    """Return what `read_clips` does, from what is kept if that is of the same content. digest: of the file.
    Raises FileError as `read_clips` does.
    """
    kept, key = _cache(find_motion_cache_folder()), _key(path, digest, as_is)
    content = kept.read(key)
    if content is not None:
        with suppress(Exception):  # whatever is wrong with it, the file itself is there
            return _decoded(content)
    clips = read_clips(path, as_is)
    if kept.folder is not None and _self_contained(path):
        _writer().submit(_keep, kept, key, clips)
    return clips


@cache
def _cache(folder: Path | None) -> DiskCache:
    return DiskCache(folder, MOST, ".motion")


def find_motion_cache_folder() -> Path | None:
    """Return the folder it is kept in, None if nothing is."""
    told = os.environ.get("METAGRAPH_MOTION_CACHE")
    return cache_folder("motion") if told is None else Path(told) if told else None


def finish() -> None:
    """Return when all that was read so far is kept."""
    _writer().submit(int).result()


def _key(path: Path, digest: str, as_is: Collection[str]) -> str:
    # A clip without a name of its own bears its file's.
    asked = "\n".join((digest, path.name, *sorted(as_is)))
    return hashlib.sha256(f"{_readers()}\n{asked}".encode(errors="surrogatepass")).hexdigest()[:40]


@cache
def _readers() -> str:
    """Return what stands for the programs that read: files' names, sizes and times of theirs."""
    here = Path(__file__).parent
    found = sorted([*here.rglob("*.py"), *(here.parent / "motion").rglob("*.py")])
    told = [(str(p), (s := p.stat()).st_size, s.st_mtime_ns) for p in found]
    return hashlib.sha256(repr(told).encode()).hexdigest()


def _self_contained(path: Path) -> bool:
    """Whether a file's content is all that its motion comes from: glTF may name other files."""
    with path.open("rb") as file:
        head = file.read(20)
        if head.startswith(b"glTF") and len(head) == 20:
            return b'"uri"' not in file.read(min(int.from_bytes(head[12:16], "little"), LARGEST))
    return path.suffix.lower() != ".gltf" and not head.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"{")


def _encoded(clips: Iterable[Clip]) -> bytes:
    skeletons: dict[bytes, int] = {}
    kept = []
    for clip in clips:
        bones = clip.skeleton
        skeleton = msgspec.msgpack.encode(
            KeptSkeleton(
                bones.names,
                bones.parents.astype("<i4").tobytes(),
                bones.rest_rotations.astype("<f8").tobytes(),
                bones.rest_translations.astype("<f8").tobytes(),
            )
        )
        assert clip.weights is not None
        kept.append(
            KeptClip(
                clip.name,
                skeletons.setdefault(skeleton, len(skeletons)),
                float(clip.fps),
                clip.frames,
                _bytes(clip.rotations),
                _bytes(clip.translations),
                tuple(map(int, clip.translated)),
                clip.morphs,
                _bytes(clip.weights),
                tuple(map(str, clip.notes)),  # msgspec takes no text that knows its template
                tuple((r.name, str(r.words), r.made, r.take) for r in clip.repairs),
                clip.brought_from,
                clip.face_of,
            )
        )
    body = msgspec.msgpack.encode(KeptFile(tuple(skeletons), tuple(kept)))
    return _HEAD.pack(MARK, zlib.crc32(body)) + body


def _bytes(array: Array) -> memoryview:
    return memoryview(np.ascontiguousarray(array, "<f4").tobytes())


def _decoded(content: bytes) -> list[Clip]:
    """Raises ValueError, or what msgspec does, where it is not what was kept."""
    mark, checked = _HEAD.unpack_from(content)
    body = memoryview(content)[_HEAD.size :]
    if mark != MARK or zlib.crc32(body) != checked:
        raise ValueError("it is broken")
    kept = msgspec.msgpack.decode(body, type=KeptFile)
    skeletons = [_skeleton(each) for each in kept.skeletons]
    return [_clip(each, skeletons[each.skeleton]) for each in kept.clips]


def _skeleton(encoded: bytes) -> Skeleton:
    known = _skeletons.get(encoded)
    if known is None:
        kept = msgspec.msgpack.decode(encoded, type=KeptSkeleton)
        known = Skeleton(
            kept.names,
            np.frombuffer(kept.parents, "<i4"),
            np.frombuffer(kept.rotations, "<f8").reshape(-1, 4),
            np.frombuffer(kept.translations, "<f8").reshape(-1, 3),
        )
        if len(_skeletons) >= _SKELETONS:
            _skeletons.clear()
        _skeletons[encoded] = known
    return known


def _clip(kept: KeptClip, skeleton: Skeleton) -> Clip:
    return Clip(
        kept.name,
        skeleton,
        kept.fps,
        np.frombuffer(kept.rotations, "<f4").reshape(kept.frames, len(skeleton), 4),
        np.frombuffer(kept.translations, "<f4").reshape(kept.frames, len(kept.translated), 3),
        kept.translated,
        kept.morphs,
        np.frombuffer(kept.weights, "<f4").reshape(kept.frames, len(kept.morphs)),
        kept.notes,
        tuple(Repair(*repair) for repair in kept.repairs),
        kept.brought_from,
        kept.face_of,
    )


@cache
def _writer() -> ThreadPoolExecutor:
    """Who writes beside whoever reads on."""
    return ThreadPoolExecutor(1, thread_name_prefix="motion cache")


def _keep(kept: DiskCache, key: str, clips: list[Clip]) -> None:
    if sum(clip.rotations.nbytes for clip in clips) <= LARGEST:
        kept.write(key, _encoded(clips))
