"""Contact sheets: a clip from the front and the side at evenly spaced times, drawn with nothing but PIL."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from metagraph.motion import rotation
from metagraph.motion.skeleton import Pose
from sample_clips.make.mannequin_rig import SKELETON, Array, at
from sample_clips.make.measure import TORSO

RADII = {
    "UpperLeg": (0.078, 0.052),
    "LowerLeg": (0.052, 0.038),
    "Foot": (0.035, 0.028),
    "UpperArm": (0.046, 0.038),
    "LowerArm": (0.038, 0.026),
    "Hand": (0.025, 0.020),
}


def _balls(turns: Array, places: Array) -> Array:
    """Return balls `[N, 5]`: place, radius, colour number (0 torso, 1 left, 2 right, 3 nose) of one pose."""
    out: list[Array] = []
    children = SKELETON.children
    for joint, name in enumerate(SKELETON.names):
        colour = 1 if name.startswith("Left") else 2 if name.startswith("Right") else 0
        kind = name.removeprefix("Left").removeprefix("Right")
        if any(w in kind for w in ("Lid", "Brow", "Jaw", "Eye", "Shoulder")):
            continue
        finger = kind[-1].isdigit()
        radii = (0.009, 0.008) if finger else RADII.get(kind)
        if radii is None:
            continue
        ends = [places[c] for c in children[joint]]
        if finger and not ends:
            length = 0.02
            ends = [places[joint] + (places[joint] - places[SKELETON.parents[joint]]) / 0.025 * length * 0.9]
        for end in ends:
            n = max(2, int(np.linalg.norm(end - places[joint]) / 0.012))
            for f in np.linspace(0, 1, n):
                out.append(
                    np.array(
                        [*(places[joint] * (1 - f) + end * f), radii[0] * (1 - f) + radii[1] * f, colour]
                    )
                )
    angles = np.linspace(0, 2 * np.pi, 22, endpoint=False)
    for name, up, wide, deep, forwards in TORSO:
        joint = at(name)
        ring = np.stack(
            [(wide - 0.03) * np.cos(angles), 0 * angles + up, forwards + (deep - 0.03) * np.sin(angles)], -1
        )
        for p in places[joint] + rotation.rotate_vectors(turns[joint], ring):
            out.append(np.array([*p, 0.032, 0]))
    head = at("Head")
    for p, r in (
        ((0, 0.10, 0.02), 0.088),
        ((0, 0.06, 0.03), 0.075),
        ((0, 0.0, 0.05), 0.040),
        ((0, -0.05, -0.01), 0.05),
    ):
        out.append(np.array([*(places[head] + rotation.rotate_vectors(turns[head], np.array(p))), r, 0]))
    nose = places[head] + rotation.rotate_vectors(turns[head], np.array([0, 0.075, 0.112]))
    out.append(np.array([*nose, 0.014, 3]))
    return np.array(out)


COLOURS = np.array([(205, 205, 200), (110, 160, 235), (235, 130, 110), (90, 60, 60)], float)
VIEWS = {"front": 0.0, "left": 90.0, "right": -90.0, "quarter": 35.0}


def draw(
    image: Any,
    rotations: Array,
    root: Array,
    box: tuple[int, int, int, int],
    view: str,
    low: float,
    high: float,
) -> None:
    """Draw one pose `[J, 4]` into the image's box (x, y, width, height), showing heights `low` to `high`
    (m).
    """
    from PIL import Image, ImageDraw

    translations = np.array(SKELETON.rest_translations)
    translations[0] = root
    turns, places = SKELETON.globals(Pose(rotations, translations))
    balls = _balls(turns, places)
    angle = np.radians(VIEWS[view])
    # The camera stands in front: the character's left is on the picture's right. Turning it shows the other
    # sides.
    across = balls[:, 0] * np.cos(angle) - balls[:, 2] * np.sin(angle)
    depth = balls[:, 0] * np.sin(angle) + balls[:, 2] * np.cos(angle)
    width, height = box[2:]
    cell = Image.new("RGB", (width, height), (250, 250, 248))
    scale = height / (high - low)
    pen = ImageDraw.Draw(cell)
    for i in np.argsort(depth + balls[:, 3] * 0.6):
        x, y = width / 2 + across[i] * scale, (high - balls[i, 1]) * scale
        r = balls[i, 3] * scale
        light = 0.72 + 0.28 * np.clip((depth[i] + 0.25) / 0.6, 0, 1)
        colour = tuple(int(v) for v in COLOURS[int(balls[i, 4])] * light)
        dark = tuple(int(v) for v in COLOURS[int(balls[i, 4])] * light * 0.55)
        pen.ellipse((x - r - 1, y - r - 1, x + r + 1, y + r + 1), fill=dark)
        pen.ellipse((x - r * 0.86, y - r * 0.92, x + r * 0.86, y + r * 0.80), fill=colour)
    image.paste(cell, box[:2])


def sheet(
    clip: Any,
    path: Path | str,
    columns: int = 10,
    views: tuple[str, ...] = ("front", "left"),
    size: tuple[int, int] = (190, 230),
) -> None:
    """Write a PNG of the clip: a row for each view, a column for each time."""
    from PIL import Image, ImageDraw

    width, height = size
    low, high = {"head": (1.05, 1.85), "arms": (0.66, 1.82)}.get(layer_of(clip.name), (-0.05, 1.85))
    image = Image.new("RGB", (columns * width, len(views) * height + 14), (250, 250, 248))
    pen = ImageDraw.Draw(image)
    frames = np.round(np.linspace(0, clip.frames - 1, columns)).astype(int)
    for c, frame in enumerate(frames):
        for r, view in enumerate(views):
            draw(
                image,
                np.asarray(clip.rotations[frame], float),
                clip.root[frame],
                (c * width, 14 + r * height, width, height),
                view,
                low,
                high,
            )
        pen.text((c * width + 4, 1), f"{clip.name if c == 0 else ''} {frame / clip.fps:.2f}", fill=(0, 0, 0))
    image.save(path)


def layer_of(name: str) -> str:
    return name.split("_")[0] if name.startswith(("body_", "head_")) else "arms"
