"""Makes TRC and C3D files of clips: markers on the skin of a figure, or at its joints."""

from __future__ import annotations

import io
import warnings
from collections.abc import Mapping
from typing import Any

import c3d
import numpy as np
from numpy.typing import NDArray

from metagraph.motion.clip import Clip
from metagraph.motion.roles import find_roles

Array = NDArray[Any]

_JOINTS = {"upper_arm": "Shoulder", "lower_arm": "Elbow", "hand": "Wrist", "upper_leg": "Hip",
           "lower_leg": "Knee", "foot": "Ankle"}  # fmt: skip


def joint_markers(clip: Clip) -> dict[str, Array]:
    """Markers `[F, 3]` at the joints of a clip, metres, called as Pose2Sim calls them."""
    roles = find_roles(clip.skeleton)
    places = clip.skeleton.globals(clip.poses())[1]
    return {
        f"{side[0].upper()}{word}": places[:, roles[f"{side}_{role}"]].astype(float)
        for side in ("left", "right")
        for role, word in _JOINTS.items()
    }


def skin_markers(clip: Clip) -> dict[str, Array]:
    """Markers of Plug-in Gait with those inside of elbows, knees and ankles, 4 cm off the joints."""
    at = joint_markers(clip)
    out: dict[str, Array] = {}
    for side, sign in (("L", 1.0), ("R", -1.0)):
        aside = np.array([0.04 * sign, 0.0, 0.0])
        out[f"{side}SHO"] = at[f"{side}Shoulder"]
        out |= {f"{side}ELB": at[f"{side}Elbow"] + aside, f"{side}MEL": at[f"{side}Elbow"] - aside}
        out |= {f"{side}WRA": at[f"{side}Wrist"] + aside, f"{side}WRB": at[f"{side}Wrist"] - aside}
        out |= {f"{side}KNE": at[f"{side}Knee"] + aside, f"{side}KNM": at[f"{side}Knee"] - aside}
        out |= {f"{side}ANK": at[f"{side}Ankle"] + aside, f"{side}MED": at[f"{side}Ankle"] - aside}
    # The pelvis that Bell's shares give these hips: its front spines are 1/0.72 as far apart as they.
    left, right = at["LHip"], at["RHip"]
    wide = np.linalg.norm(left - right, axis=-1, keepdims=True) / (1 - 2 * 0.14)
    x = (left - right) / np.linalg.norm(left - right, axis=-1, keepdims=True)
    z = np.cross(x, np.array([0.0, 1.0, 0.0]))
    z /= np.linalg.norm(z, axis=-1, keepdims=True)
    y = np.cross(z, x)
    out["LASI"] = left + wide * (0.14 * x + 0.30 * y + 0.19 * z)
    out["RASI"] = right + wide * (-0.14 * x + 0.30 * y + 0.19 * z)
    out["SACR"] = (out["LASI"] + out["RASI"]) / 2 - wide * 0.8 * z
    return out


def write_trc(markers: Mapping[str, Array], rate: float, unit: str = "mm", z_up: bool = False) -> bytes:
    """A TRC file of markers `[F, 3]` metres, with nothing where one was not seen."""
    scale = {"mm": 1000.0, "m": 1.0}[unit]
    count = len(next(iter(markers.values())))
    head = "DataRate CameraRate NumFrames NumMarkers Units OrigDataRate OrigDataStartFrame OrigNumFrames"
    lines = ["PathFileType\t4\t(X/Y/Z)\ttake.trc", head.replace(" ", "\t")]
    lines.append("\t".join(map(str, (rate, rate, count, len(markers), unit, rate, 1, count))))
    lines.append("Frame#\tTime\t" + "\t\t\t".join(markers) + "\t\t")
    lines.append("\t\t" + "\t".join(f"{a}{n}" for n in range(1, len(markers) + 1) for a in "XYZ"))
    lines.append("")
    for frame in range(count):
        row = [str(frame + 1), f"{frame / rate:.5f}"]
        for places in markers.values():
            x, y, z = places[frame]
            place = (x, -z, y) if z_up else (x, y, z)
            row += [f"{v * scale:.4f}" if np.isfinite(v) else "" for v in place]
        lines.append("\t".join(row))
    return ("\n".join(lines) + "\n").encode()


def write_c3d(markers: Mapping[str, Array], rate: float, subject: str = "") -> bytes:
    """A C3D file of markers `[F, 3]` metres in millimetres, z up, as laboratories write them."""
    writer = c3d.Writer(point_rate=rate, point_units="mm")
    count = len(next(iter(markers.values())))
    for frame in range(count):
        points = np.zeros((len(markers), 5), np.float32)
        for n, places in enumerate(markers.values()):
            x, y, z = places[frame]
            seen = np.isfinite(x)
            points[n, :3] = (1000 * x, -1000 * z, 1000 * y) if seen else 0
            points[n, 3:] = 0 if seen else -1
        writer.add_frames([(points, np.array([[]]))])
    writer.set_point_labels([f"{subject}{name}" for name in markers])
    out = io.BytesIO()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        writer.write(out)
    return out.getvalue()
