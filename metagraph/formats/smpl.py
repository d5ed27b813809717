"""Body motion as SMPL, SMPL-H and SMPL-X parameters in .npz files: AMASS, BEAT2 and others that keep to them.

Read are the rotations of the joints, in the order and with the parents that the models publish, and where the
body goes. The models' files are neither needed nor read: the figure has the proportions of Drillis and
Contini (1966, as tabled by Winter, Biomechanics and Motor Control of Human Movement), at rest with its arms
stretched out. What the body's shape is (`betas`), what its soft parts do, and a face's expressions are left
out.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.budgets import CLIP_SECONDS, FRAMES
from metagraph.common.files import guard_reader
from metagraph.common.wording import phrase
from metagraph.errors import FileError, clean_text
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton

Array = NDArray[Any]

_REMEDY = phrase("Use a file of AMASS or BEAT2, or another one whose 'poses' are rotations of SMPL's joints.")
_LARGEST = 1 << 30  # bytes of one array
_HEIGHT = 1.7  # metres
USUAL_RATE = 30.0
FASTEST = 12.0  # metres a second that hips go at most: as sprinters run
HIGHEST = 20.0  # metres that they go up and down at most
_BODY = (
    "pelvis", "left_hip", "right_hip", "spine1", "left_knee", "right_knee", "spine2", "left_ankle",
    "right_ankle", "spine3", "left_foot", "right_foot", "neck", "left_collar", "right_collar", "head",
    "left_shoulder", "right_shoulder", "left_elbow", "right_elbow", "left_wrist", "right_wrist",
)  # fmt: skip
_PARENTS = (-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19)
_FINGERS = ("index", "middle", "pinky", "ring", "thumb")
_FACE = ("jaw", "left_eye_smplhf", "right_eye_smplhf")
# How many joints `poses` has -> what follows the 22 of the body.
_MODELS = {22: "SMPL-X's body", 24: "SMPL", 52: "SMPL-H", 55: "SMPL-X"}
_POSES = ("poses", "pose", "smpl_poses", "fullpose")
_PLACES = ("trans", "transl", "translation", "smpl_trans")
_RATES = ("mocap_framerate", "mocap_frame_rate", "fps", "frame_rate", "framerate")
_SCALING = "smpl_scaling"  # by which AIST++ has enlarged `smpl_trans`
_PARTS = ("root_orient", "pose_body", "pose_jaw", "pose_eye", "pose_hand")


@guard_reader
def read_smpl(path: str | Path) -> Clip:
    """Return the motion of a file as a clip, metres, Y up, with the lowest foot on the floor. Raises
    FileError.
    """
    path = Path(path)
    arrays = _arrays(path)
    poses = _poses(path, arrays)
    frames, joints = poses.shape[:2]
    if not 0 < frames <= FRAMES:
        raise FileError(path, phrase("it has no frames, or too many"), "'poses'", _REMEDY)
    notes: list[str] = [
        phrase(
            "read as {model} without the model's file, so the body shape is Metagraph's own",
            model=_MODELS[joints],
        )
    ]
    rate = _rate(path, arrays, notes)
    if frames / rate > CLIP_SECONDS:
        raise FileError(path, phrase("it is longer than six hours"), "'poses'", phrase("Cut it into pieces."))
    places = _places(path, arrays, frames, notes)
    turned = _from_vectors(poses)
    places, turned[:, 0] = _upright(places, turned[:, 0], notes)
    places = _in_metres(places, rate, notes)
    skeleton = make_smpl_figure(joints)
    left = [k for k in ("betas", "dmpls", "expressions") if k in arrays]
    if left:
        notes.append(phrase("left out: {names}", names=", ".join(left)))
    places = places - [places[0, 0], 0.0, places[0, 2]]
    clip = Clip(
        path.stem, skeleton, rate, rotation.make_continuous(turned), places[:, None], (0,), notes=tuple(notes)
    )
    return _on_floor(clip, places)


def _arrays(path: Path) -> dict[str, Array]:
    """Return the arrays of numbers of a file that are read. Raises FileError."""
    wanted = {*_POSES, *_PLACES, *_RATES, *_PARTS, _SCALING, "betas", "dmpls", "expressions"}
    out: dict[str, Array] = {}
    try:
        with zipfile.ZipFile(path) as archive:
            for info in archive.infolist():
                name = info.filename.removesuffix(".npy")
                if name not in wanted or not info.filename.endswith(".npy"):
                    continue
                if info.file_size > _LARGEST:
                    raise FileError(
                        path, phrase("'{name}' is larger than a gigabyte", name=name), "", _REMEDY
                    )
                with archive.open(info) as file:
                    out[name] = _array(path, name, file.read(_LARGEST))
            names = [i.filename.removesuffix(".npy") for i in archive.infolist()]
    except (zipfile.BadZipFile, OSError, NotImplementedError, RuntimeError, EOFError) as error:
        raise FileError(
            path,
            phrase("is not an archive that can be read ({error})", error=clean_text(str(error)[:80])),
            "",
            _REMEDY,
        ) from None
    except Exception as error:  # zlib's own, which has no common name
        if isinstance(error, FileError):
            raise
        raise FileError(
            path, phrase("is not an archive that can be read ({error})", error="zlib"), "", _REMEDY
        ) from None
    if not any(k in out for k in (*_POSES, "root_orient")):
        some = ", ".join(repr(clean_text(n[:30])) for n in names[:8])
        raise FileError(
            path, phrase("holds no rotations of joints ('poses'), only {some}", some=some), "", _REMEDY
        )
    return out


def _array(path: Path, name: str, data: bytes) -> Array:
    """Return an array of numbers; nothing is unpickled. Raises FileError."""
    bad = phrase("'{name}' is not an array of numbers", name=name)
    try:
        head = io.BytesIO(data)
        version = np.lib.format.read_magic(head)
        read = (
            np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
        )
        shape, _, kind = read(head)
        size = 1
        for n in shape:
            size *= int(n)
        if kind.hasobject or kind.kind not in "fiu" or size * kind.itemsize > len(data):
            raise FileError(path, bad, "", _REMEDY)
        return np.asarray(np.lib.format.read_array(io.BytesIO(data), allow_pickle=False), float)
    except (ValueError, TypeError, SyntaxError, OverflowError, EOFError, MemoryError):
        raise FileError(path, bad, "", _REMEDY) from None


def _poses(path: Path, arrays: Mapping[str, Array]) -> Array:
    """Return rotation vectors `[F, J, 3]`."""
    whole = next((arrays[k] for k in _POSES if k in arrays), None)
    if whole is None:
        parts = [
            arrays[k].reshape(len(arrays[k]), int(np.prod(arrays[k].shape[1:])))
            for k in _PARTS
            if k in arrays and arrays[k].ndim > 1
        ]
        if len({len(p) for p in parts}) != 1:
            raise FileError(
                path, phrase("its parts have different numbers of frames"), "'root_orient'", _REMEDY
            )
        whole = np.concatenate(parts, 1)
    flat = (
        whole.reshape(len(whole), int(np.prod(whole.shape[1:]))) if whole.ndim in (2, 3) else np.zeros((0, 0))
    )
    count = flat.shape[1] // 3
    if flat.shape[1] % 3 or count not in _MODELS:
        known = ", ".join(f"{n} ({model})" for n, model in _MODELS.items())
        raise FileError(
            path,
            phrase(
                "'poses' has the shape {shape}, which fits none of the known joints: {known}",
                shape="x".join(map(str, whole.shape)),
                known=known,
            ),
            "",
            _REMEDY,
        )
    if not np.isfinite(flat).all() or (flat.size and np.abs(flat).max() > 1e3):
        raise FileError(path, phrase("a rotation is not a possible number"), "'poses'", _REMEDY)
    if not len(flat):
        raise FileError(path, phrase("it has no frames, or too many"), "'poses'", _REMEDY)
    return flat.reshape(len(flat), count, 3)


def _rate(path: Path, arrays: Mapping[str, Array], notes: list[str]) -> float:
    said = next((arrays[k] for k in _RATES if k in arrays and arrays[k].size == 1), None)
    if said is None:
        notes.append(
            phrase("it does not give its frame rate: {rate:g} frames a second were assumed", rate=USUAL_RATE)
        )
        return USUAL_RATE
    rate = float(said.reshape(-1)[0])
    if not 1 <= rate <= 1000:
        raise FileError(path, phrase("its frame rate is {rate:g}", rate=rate), "", _REMEDY)
    return rate


def _places(path: Path, arrays: Mapping[str, Array], frames: int, notes: list[str]) -> Array:
    said = next((arrays[k] for k in _PLACES if k in arrays), None)
    if said is None:
        notes.append(phrase("it does not say where the body goes ('trans'), so the body stays in its place"))
        return np.zeros((frames, 3))
    if said.shape != (frames, 3) or not np.isfinite(said).all() or np.abs(said).max() > 1e5:
        raise FileError(path, phrase("'trans' does not have three numbers for each frame"), "", _REMEDY)
    scaling = arrays.get(_SCALING)
    if scaling is not None and scaling.size == 1 and "smpl_trans" in arrays and float(scaling.max()) > 0:
        notes.append(phrase("'trans' was divided by '{name}', as in AIST++", name=_SCALING))
        said = said / float(scaling.max())
    return said


def _from_vectors(poses: Array) -> Array:
    """Return quaternions of rotation vectors (axis times angle, radians)."""
    angle = np.linalg.norm(poses, axis=-1)
    half = 0.5 * angle[..., None]
    scale = np.where(half > 1e-8, np.sin(half) / np.maximum(2 * half, 1e-12), 0.5)
    return np.concatenate([poses * scale, np.cos(half)], -1)


def _upright(places: Array, root: Array, notes: list[str]) -> tuple[Array, Array]:
    """Return where the body goes and how its hips turn with Y up, whichever way the file has them: bodies are
    upright most of the time.
    """
    up = np.median(rotation.rotate_vectors(root, np.broadcast_to([0.0, 1.0, 0.0], (len(root), 3))), axis=0)
    if abs(up[2]) > abs(up[1]):
        quarter = -1.0 if up[2] > 0 else 1.0
        told = (
            phrase("its Z axis points up; it was turned so that Y points up")
            if up[2] > 0
            else phrase("its Z axis points down; it was turned so that Y points up")
        )
    elif up[1] < -0.5:  # who stands before a camera, in the camera's axes
        quarter, told = (
            2.0,
            phrase("its Y axis points down, as in a camera's picture; it was turned so that Y points up"),
        )
    else:
        return places, root
    notes.append(told)
    turn = rotation.from_axis_angle([1.0, 0.0, 0.0], quarter * np.pi / 2)
    turns = np.broadcast_to(turn, root.shape)
    return rotation.rotate_vectors(turns, places), rotation.multiply(turns, root)


def _in_metres(places: Array, rate: float, notes: list[str]) -> Array:
    """Return where the body goes in metres: in centimetres or millimetres where it would otherwise be faster
    than people run, or go higher than they climb.
    """
    steps = np.linalg.norm(np.diff(places, axis=0), axis=-1)
    speed = float(np.percentile(steps, 95)) * rate if len(steps) else 0.0
    height = float(np.ptp(np.percentile(places[:, 1], (5, 95))))
    for scale, unit in ((1.0, ""), (0.01, phrase("centimetres")), (0.001, phrase("millimetres"))):
        if speed * scale <= FASTEST and height * scale <= HIGHEST:
            if unit:
                notes.append(phrase("'trans' was read as {unit}: in metres it would go too far", unit=unit))
            return places * scale
    return places


def make_smpl_figure(joints: int) -> Skeleton:
    """Return the figure of a model with so many joints (22, 24, 52 or 55) at rest: arms to the sides, looking
    along +Z.
    """
    h = _HEIGHT
    waist, hip, shoulder = 0.556, 0.53, 0.818  # heights as shares of the stature
    at = {
        "pelvis": (0, waist, 0), "left_hip": (0.0955, hip, 0), "left_knee": (0.0955, 0.285, 0),
        "left_ankle": (0.0955, 0.039, 0), "left_foot": (0.0955, 0.012, 0.08), "spine1": (0, 0.62, 0),
        "spine2": (0, 0.69, 0), "spine3": (0, 0.735, 0), "neck": (0, 0.85, 0), "head": (0, 0.905, 0.01),
        "left_collar": (0.045, 0.81, 0), "left_shoulder": (0.1295, shoulder, 0),
        "left_elbow": (0.1295 + 0.186, shoulder, 0), "left_wrist": (0.1295 + 0.186 + 0.146, shoulder, 0),
    }  # fmt: skip
    names, parents = list(_BODY), list(_PARENTS)
    wrist = np.array(at["left_wrist"])
    if joints == 24:
        at["left_hand"] = tuple(wrist + [0.05, 0, 0])
        names += ["left_hand", "right_hand"]
        parents += [20, 21]
    if joints == 55:
        at |= {"jaw": (0, 0.91, 0.02), "left_eye_smplhf": (0.019, 0.935, 0.05)}
        names += _FACE
        parents += [15, 15, 15]
    if joints >= 52:
        across = {"index": 0.013, "middle": 0.002, "ring": -0.009, "pinky": -0.02, "thumb": 0.02}
        for side, hand in (("left", 20), ("right", 21)):
            for finger in _FINGERS:
                for n in range(3):
                    out = (0.02 if finger == "thumb" else 0.055) + 0.018 * n
                    at[f"left_{finger}{n + 1}"] = tuple(wrist + [out, 0, across[finger]])
                    parents.append(hand if n == 0 else len(names) - 1)
                    names.append(f"{side}_{finger}{n + 1}")
    place = np.array(
        [at[n] if n in at else np.multiply(at[n.replace("right_", "left_")], (-1, 1, 1)) for n in names],
        float,
    )
    place *= h
    order = np.array(parents)
    rest = place - np.where(order[:, None] < 0, 0.0, place[np.maximum(order, 0)])
    return Skeleton(tuple(names), order, rotation.make_identity_rotations((len(names),)), rest)


def _on_floor(clip: Clip, places: Array) -> Clip:
    """Return the clip with its lowest foot on the floor: where the hips are above what `trans` says, only the
    model's file knows.
    """
    feet = [clip.skeleton.names.index(n) for n in ("left_foot", "right_foot")]
    some = np.linspace(0, clip.frames - 1, min(clip.frames, 500)).astype(int)
    part = replace(clip, rotations=clip.rotations[some], translations=clip.translations[some])
    _, at = clip.skeleton.globals(part.poses())
    low = at[:, feet, 1].min(1)
    down = float(np.percentile(low, 2)) - 0.012 * _HEIGHT
    told = phrase("its hips were put at a height at which the feet reach the floor")
    moved = (places - [0.0, down, 0.0])[:, None]
    return replace(clip, translations=moved, notes=(*clip.notes, told))
