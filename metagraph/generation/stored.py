"""The model's file, `.mgmodel`: a zip of `model.json` and `weights/NAME.npy`. Nothing in it is ever run:
arrays are read as plain little-endian numbers, and their names, shapes and size are checked against what
`model.json` says before.
"""

from __future__ import annotations

import ast
import io
import platform
import struct
import zipfile
import zlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from math import prod
from pathlib import Path
from typing import Annotated, Any, BinaryIO

import msgspec
import numpy as np
from msgspec import Meta, Struct
from numpy.typing import NDArray

from metagraph.common.budgets import ARRAYS
from metagraph.common.files import check_file, guard_reader
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.generation.features import MARKS, MELS, PITCH, as_heard
from metagraph.generation.networks import (
    FPS,
    CvaeSizes,
    FlowSizes,
    Kind,
    MatchingSizes,
    Weights,
    list_weight_shapes,
)
from metagraph.generation.poses import NUMBERS, PoseError, PoseRig, Standardisation, find_rig
from metagraph.motion.skeleton import Skeleton

Array = NDArray[Any]

FORMAT = 4  # 2: pieces given by their neighbours, too; 3: Gaussian codes and guesses; 4: pitch and marks
SUFFIX = ".mgmodel"
MOST = 512 * 2**20  # bytes of all weights
MOST_TOLD = 16 * 2**20  # bytes of model.json
_JSON = "model.json"
_REMEDY = "Take it from where it came from again, or train it anew."
_TYPES = {"<f4": 4, "<f2": 2}
# What reading a broken archive raises beside its own errors.
_BROKEN = (EOFError, NotImplementedError, RuntimeError, ValueError, KeyError, IndexError, OverflowError)
_Numbers = tuple[float, ...]
_Text = Annotated[str, Meta(max_length=4000)]


class TakeCard(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A take that a model has seen. sha256: of its files, motion first."""

    name: _Text
    sha256: tuple[_Text, ...] = ()
    licence: _Text = ""
    seconds: float = 0.0
    mirrored: bool = False


class SkeletonCard(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Whose motion it is. roles: of the joints that move, as `PoseRig.roles`, with the hips. base: local
    rotations that poses are relative to, of all joints.
    """

    names: tuple[_Text, ...]
    parents: tuple[int, ...]
    rotations: tuple[tuple[float, float, float, float], ...]
    translations: tuple[tuple[float, float, float], ...]
    fingerprint: _Text
    roles: dict[str, int]
    base: tuple[tuple[float, float, float, float], ...]

    def rig(self) -> PoseRig:
        """Return the joints that move. Raises PoseError."""
        skeleton = Skeleton(
            self.names,
            np.array(self.parents, np.int32),
            np.array(self.rotations, np.float64),
            np.array(self.translations, np.float64),
        )
        return find_rig(skeleton, self.roles, np.array(self.base, np.float64))


class ModelCard(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What is reported about a model beside its weights. tracks: 1 hears both voices mixed, 2 apart. hours:
    of takes that were learned from. statistics: of the finished model.
    """

    format: int = FORMAT
    kind: Kind
    sizes: FlowSizes | CvaeSizes | MatchingSizes
    skeleton: SkeletonCard
    pose_mean: _Numbers
    pose_deviation: _Numbers
    audio_mean: _Numbers
    audio_deviation: _Numbers
    fps: float = FPS
    tracks: Annotated[int, Meta(ge=1, le=2)] = 1
    loss: _Text = ""
    seed: int = 0
    steps: int = 0
    hours: float = 0.0
    takes: tuple[TakeCard, ...] = ()
    held_out: tuple[TakeCard, ...] = ()
    versions: dict[str, str] = {}
    statistics: dict[str, float] = {}
    notes: tuple[_Text, ...] = ()


@dataclass(frozen=True, eq=False)
class Model:
    """A model, ready to be used. weights: as `networks.list_weight_shapes` names them, float32."""

    card: ModelCard
    weights: Weights

    @cached_property
    def rig(self) -> PoseRig:
        """The joints that it moves."""
        return self.card.skeleton.rig()

    @cached_property
    def poses(self) -> Standardisation:
        """What standardises poses."""
        return _scale(self.card.pose_mean, self.card.pose_deviation)

    @cached_property
    def audio(self) -> Standardisation:
        """What standardises what is heard beside who speaks."""
        return _scale(self.card.audio_mean, self.card.audio_deviation)

    def heard(self, features: Array) -> Array:
        """Return features `[T, audio + 4]` as networks hear them, see `features.as_heard`."""
        return as_heard(features, self.audio)


def _scale(mean: _Numbers, deviation: _Numbers) -> Standardisation:
    return Standardisation(np.array(mean, np.float32), np.array(deviation, np.float32))


def make_skeleton_card(rig: PoseRig) -> SkeletonCard:
    """Return what is kept of a skeleton."""
    skeleton = rig.skeleton
    above = int(skeleton.parents[rig.lines[0][0]])
    return SkeletonCard(
        names=skeleton.names,
        parents=tuple(int(p) for p in skeleton.parents),
        rotations=tuple(map(tuple, skeleton.rest_rotations.tolist())),
        translations=tuple(map(tuple, skeleton.rest_translations.tolist())),
        fingerprint=skeleton.fingerprint,
        roles={"hips": max(above, 0), **dict(zip(rig.roles, rig.joints, strict=True))},
        base=tuple(map(tuple, rig.base.tolist())),
    )


def list_versions() -> dict[str, str]:
    """Return what a model was made with."""
    return {"python": platform.python_version(), "numpy": np.__version__}


def check_model(model: Model) -> Model:
    """Return the model. Raises ValueError, in words, where its card and weights do not fit together."""
    card, weights = model.card, model.weights
    _check_card(card)
    expected = list_weight_shapes(card.sizes)
    if odd := sorted(set(weights) ^ set(expected)):
        raise ValueError(f"its weights are not those of its sizes ('{odd[0]}')")
    for name, shape in expected.items():
        if weights[name].shape != shape:
            raise ValueError(f"weight '{name}' is {weights[name].shape}, expected {shape}")
        if not np.isfinite(weights[name]).all():
            raise ValueError(f"weight '{name}' holds a value that is not a number")
    return model


def _check_card(card: ModelCard) -> None:
    sizes, rig_numbers = card.sizes, NUMBERS * (len(card.skeleton.roles) - 1)
    audio = sizes.audio if isinstance(sizes, MatchingSizes) else sizes.control.audio
    mels = card.tracks * MELS
    if audio not in (mels, mels + PITCH + MARKS):
        raise ValueError(f"it hears {audio} numbers a frame, {mels} are made of a sound")
    if card.fps != FPS:
        raise ValueError(f"it is for {card.fps:g} frames a second, {FPS:g} are made")
    if sizes.pose != rig_numbers:
        raise ValueError(f"its poses have {sizes.pose} numbers, its joints {rig_numbers}")
    for what, numbers, count in (
        ("poses' means", card.pose_mean, sizes.pose),
        ("poses' deviations", card.pose_deviation, sizes.pose),
        ("mels' means", card.audio_mean, audio),
        ("mels' deviations", card.audio_deviation, audio),
    ):
        if len(numbers) != count or not np.isfinite(numbers).all():
            raise ValueError(f"its {what} are {len(numbers)} numbers, expected {count} finite ones")
        if "deviations" in what and min(numbers) <= 0:
            raise ValueError(f"its {what} must be more than 0")
    told = card.skeleton
    if not len(told.names) == len(told.parents) == len(told.rotations) == len(told.translations):
        raise ValueError("its skeleton has lists of different lengths")
    if any(not 0 <= j < len(told.names) for j in told.roles.values()):
        raise ValueError("its skeleton has roles of joints that are not there")
    rig = Model(card, {}).rig  # raises where the skeleton is none
    if rig.numbers != sizes.pose or rig.skeleton.fingerprint != told.fingerprint:
        raise ValueError("its skeleton is not the one that it was made for")


# --- writing


def write_model(model: Model, path: str | Path, half: bool = False) -> None:
    """Write a model, whole or not at all. half: weights in 16 bits, a file half as large. Raises FileError,
    also for what no reader would accept.
    """
    path = Path(path)
    try:
        check_model(model)
        kept = np.dtype("<f2" if half else "<f4")
        size = sum(w.size for w in model.weights.values()) * kept.itemsize
        if size > MOST:
            raise ValueError(
                f"its weights take {size / 2**20:.0f} MiB, at most {MOST / 2**20:.0f} MiB are read"
                + ("" if half else "; 16 bits would halve them")
            )
        with np.errstate(over="ignore"):
            arrays = {
                n: np.ascontiguousarray(model.weights[n], kept) for n in list_weight_shapes(model.card.sizes)
            }
        if any(not np.isfinite(a).all() for a in arrays.values()):
            raise ValueError("a weight is too large for 16 bits")
    except (ValueError, PoseError) as error:
        raise FileError(path, f"the model cannot be kept: {error}", "on saving it") from None
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        archive.writestr(_member(_JSON), msgspec.json.format(msgspec.json.encode(model.card), indent=1))
        for name, array in arrays.items():
            content = io.BytesIO()
            np.lib.format.write_array(content, array, version=(1, 0), allow_pickle=False)
            archive.writestr(_member(f"weights/{name}.npy"), content.getvalue())
    write_atomically(path, buffer.getvalue())


def _member(name: str) -> zipfile.ZipInfo:
    """Return a member that is the same whenever it is written."""
    out = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
    out.compress_type = zipfile.ZIP_DEFLATED
    out.external_attr = 0o644 << 16
    return out


# --- reading


@guard_reader
def read_model(path: str | Path) -> Model:
    """Read a model. Raises FileError for whatever is not one."""
    path = check_file(path, ARRAYS)
    with _opened(path) as archive:
        card = _card(path, archive)
        return Model(card, _weights(path, archive, card))


@guard_reader
def read_card(path: str | Path) -> ModelCard:
    """Read what is reported about a model, without its weights. Raises FileError."""
    path = check_file(path, ARRAYS)
    with _opened(path) as archive:
        return _card(path, archive)


@contextmanager
def _opened(path: Path) -> Iterator[zipfile.ZipFile]:
    """Open an archive; whatever broken ones end in, here or while they are read, is a FileError."""
    try:
        with zipfile.ZipFile(path) as archive:
            yield archive
    except OSError as error:
        raise FileError(path, f"cannot be read ({error.strerror or error})", remedy=_REMEDY) from None
    except (zipfile.BadZipFile, zipfile.LargeZipFile, zlib.error, struct.error, *_BROKEN) as error:
        raise FileError(path, f"is damaged, or no model ({error})", remedy=_REMEDY) from None


def _card(path: Path, archive: zipfile.ZipFile) -> ModelCard:
    names = archive.namelist()
    if _JSON not in names:
        raise FileError(path, f"is no model: it holds no {_JSON}", remedy=_REMEDY)
    if archive.getinfo(_JSON).file_size > MOST_TOLD:
        raise FileError(path, "is larger than any model's", _JSON, _REMEDY)
    text = _bytes(archive, _JSON, MOST_TOLD)
    try:
        told = msgspec.json.decode(text)
        number = told.get("format") if isinstance(told, Mapping) else None
        if isinstance(number, int) and number > FORMAT:
            raise FileError(
                path,
                f"has format {number}, this version reads {FORMAT}",
                _JSON,
                "Install a newer version to use it.",
            )
        card = msgspec.convert(told, ModelCard)
        _check_card(card)
    except (msgspec.DecodeError, msgspec.ValidationError, ValueError, PoseError, RecursionError) as error:
        raise FileError(path, f"is no model's: {error}", _JSON, _REMEDY) from None
    return card


def _weights(path: Path, archive: zipfile.ZipFile, card: ModelCard) -> Weights:
    """Return the weights; nothing is read before all names and sizes are as they must be."""
    expected = list_weight_shapes(card.sizes)
    members = {f"weights/{name}.npy": name for name in expected}
    infos = {info.filename: info for info in archive.infolist()}
    odd = sorted(set(infos) - set(members) - {_JSON})
    if odd or len(infos) != len(archive.infolist()):
        raise FileError(path, "holds what no model has", f"'{odd[0] if odd else 'twice'}'", _REMEDY)
    missing = next((name for member, name in members.items() if member not in infos), None)
    if missing is not None:
        raise FileError(path, "a weight is missing", f"'{missing}'", _REMEDY)
    if sum(prod(shape) for shape in expected.values()) * 2 > MOST:
        raise FileError(path, f"its sizes need more than {MOST // 2**20} MiB", _JSON, _REMEDY)
    for member, name in members.items():
        size = prod(expected[name])
        if not 2 * size <= infos[member].file_size <= 4 * size + 4096:
            raise FileError(path, "has another size than its sizes say", f"'{name}'", _REMEDY)
    if sum(i.file_size for i in infos.values()) > MOST + MOST_TOLD:
        raise FileError(path, f"its weights take more than {MOST // 2**20} MiB", remedy=_REMEDY)
    return {name: _array(path, archive, member, expected[name]) for member, name in members.items()}


def _array(path: Path, archive: zipfile.ZipFile, member: str, shape: tuple[int, ...]) -> Array:
    name = member[len("weights/") : -len(".npy")]
    content = io.BytesIO(_bytes(archive, member, 4 * prod(shape) + 4096))
    try:
        found, fortran, dtype = _header(content)
    except (ValueError, SyntaxError, TypeError, MemoryError, RecursionError) as error:
        raise FileError(path, f"is no array ({error})", f"'{name}'", _REMEDY) from None
    if dtype.hasobject or dtype.str not in _TYPES:
        raise FileError(
            path, f"holds {dtype}, not numbers of 16 or 32 bits, and is not read", f"'{name}'", _REMEDY
        )
    if found != shape or (fortran and len(shape) > 1):
        raise FileError(path, f"is {found}, expected {shape}", f"'{name}'", _REMEDY)
    rest = content.read()
    if len(rest) != prod(shape) * dtype.itemsize:
        raise FileError(path, "has more or fewer numbers than it says", f"'{name}'", _REMEDY)
    array = np.frombuffer(rest, dtype).reshape(shape).astype(np.float32)
    if not np.isfinite(array).all():
        raise FileError(path, "holds a value that is not a number", f"'{name}'", _REMEDY)
    return array


def _header(content: BinaryIO) -> tuple[tuple[int, ...], bool, np.dtype[Any]]:
    """Return an array's shape, order and type. NumPy's own reader warns of old headers and mends them."""
    if content.read(8) != b"\x93NUMPY\x01\x00":
        raise ValueError("another version of arrays")
    told = ast.literal_eval(
        content.read(min(4096, int.from_bytes(content.read(2), "little"))).decode("latin-1")
    )
    if not isinstance(told, dict) or set(told) != {"descr", "fortran_order", "shape"}:
        raise ValueError("its head does not say what it is")
    shape, kind = told["shape"], told["descr"]
    if not isinstance(shape, tuple) or not all(type(n) is int for n in shape) or not isinstance(kind, str):
        raise ValueError("its head does not say how large it is")
    return shape, told["fortran_order"] is True, np.dtype(kind)


def _bytes(archive: zipfile.ZipFile, member: str, most: int) -> bytes:
    """Return a member's content, checked against its sum; never more than `most` bytes are unpacked."""
    with archive.open(member) as file:
        out = file.read(most + 1)
        if len(out) > most or file.read(1):
            raise zipfile.BadZipFile(f"'{member}' is larger than it says")
    return out
