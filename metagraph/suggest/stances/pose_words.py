"""What a stance that nobody named is called: as an animator would say what its pose looks like."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.words import LAYERS, Layer
from metagraph.suggest.body_points import NAMES
from metagraph.suggest.stances.known import Shape

Array = NDArray[Any]
Points = Mapping[str, Array]

ARM = 0.35  # heights, an arm's usual length: what hands are measured by on figures with others
LEVEL = 0.4  # sine of the angle between the trunk and the ground below which somebody lies
LEAN = 9.0  # degrees a trunk leans, beyond what is usual for the set
AWRY = 0.015  # heights the crown or nose is to a side, of a head that is tilted or turned
WEIGHT = 0.02  # heights the hips are to a side of the feet, of a body that rests on one leg


def describe_pose(
    shape: Shape, usual: Shape | None = None, scale: Mapping[Layer, float] | None = None
) -> str:
    """Return words for a stance's pose: "sitting, arms crossed". usual: the most used stance, if that is
    another. scale: how much longer each layer's points are than they are (see `whole_body`).
    """
    p = _points(shape, scale)
    base = _points(usual, scale) if usual is not None else {}
    words = [w for w in (_legs(p), _trunk(p, base), _arms(p), _head(p, base)) if w]
    if not words:
        return f"{shape.layer} at rest" if usual is None else f"{shape.layer} held"
    return ", ".join(words)


def _points(shape: Shape, scale: Mapping[Layer, float] | None) -> dict[str, Array]:
    of = {name: layer for layer in LAYERS for name in NAMES[layer]}
    return {
        name: pose / (scale[of[name]] if scale is not None and name in of else 1.0)
        for name, pose in zip(shape.names, shape.poses[0], strict=True)
    }


def is_lying(names: Sequence[str], pose: Array) -> bool:
    """Return whether somebody lies: the trunk is nearer to level than to upright. pose: `[n, 3]`, the named
    points.
    """
    if not {"hips", "trunk"} <= set(names):
        return False
    up = pose[names.index("trunk")] - pose[names.index("hips")]
    return bool(up[1] < LEVEL * np.linalg.norm(up))


def _legs(p: Points) -> str:
    if not {"hips", "trunk"} <= set(p):
        return ""
    if is_lying([*p], np.array([*p.values()])):
        return "lying"
    upright, reach = [], 0.0
    for side in ("left", "right"):
        if f"{side}_lower_leg" in p and f"{side}_foot" in p:
            thigh = p["hips"] - p[f"{side}_lower_leg"]
            shank = p[f"{side}_lower_leg"] - p[f"{side}_foot"]
            # across the hips does not count: some figures are broad and short
            upright.append(thigh[1] / max(float(np.linalg.norm(thigh[1:])), 1e-6))
            reach = max(reach, float(np.linalg.norm(thigh) + np.linalg.norm(shank)))
    if not upright:
        return ""
    if max(upright) < 0.5:
        low = p["hips"][1] < 0.35 * reach
        return "sitting on the floor" if low else "sitting"
    if min(upright) < 0.5:
        return "on one knee"
    aside = float(p["hips"][0])
    return f"weight {'left' if aside > 0 else 'right'}" if abs(aside) > WEIGHT else "standing"


def _lean(p: Points) -> tuple[float, float]:
    up = p["trunk"] - p["hips"]
    return float(np.degrees(np.arctan2(up[2], up[1]))), float(np.degrees(np.arctan2(up[0], up[1])))


def _trunk(p: Points, base: Points) -> str:
    if not {"hips", "trunk"} <= set(p) or _legs(p) == "lying":
        return ""
    ahead, aside = _lean(p)
    if {"hips", "trunk"} <= set(base):
        usual = _lean(base)
        ahead, aside = ahead - usual[0], aside - usual[1]
    if max(abs(ahead), abs(aside)) < LEAN:
        return ""
    if abs(ahead) >= abs(aside):
        return f"leaning {'forward' if ahead > 0 else 'back'}"
    return f"leaning {'left' if aside > 0 else 'right'}"


def _arms(p: Points) -> str:
    if not {"left_hand", "right_hand", "left_upper_arm", "right_upper_arm"} <= set(p):
        return ""
    length = _arm(p)
    size = length / ARM if length > 0.05 else 1.0
    left, right = p["left_hand"] / size, p["right_hand"] / size
    middle = (p["left_upper_arm"] + p["right_upper_arm"]) / 2 / size
    left, right = left - middle, right - middle
    across = float(left[0] - right[0])
    if min(left[2], right[2]) > 0.03 and max(left[1], right[1]) < 0 and across < 0.04:
        return "arms crossed"
    if max(left[2], right[2]) < -0.02 and across < 0.15:
        return "hands behind the back"
    if float(np.linalg.norm(left - right)) < 0.12 and max(left[1], right[1]) < -0.05:
        return "hands clasped"
    named = {"left": _hand(p, "left", left, size), "right": _hand(p, "right", right, size)}
    if named["left"] == named["right"]:
        return f"hands {named['left']}" if named["left"] else ""
    telling = [f"{side} hand {w}" for side, w in named.items() if w and w != "at the sides"]
    return " and ".join(telling)


def _arm(p: Points) -> float:
    out = 0.0
    for side in ("left", "right"):
        if f"{side}_lower_arm" in p:
            upper = p[f"{side}_upper_arm"] - p[f"{side}_lower_arm"]
            out = max(
                out,
                float(np.linalg.norm(upper) + np.linalg.norm(p[f"{side}_lower_arm"] - p[f"{side}_hand"])),
            )
    return out


def _hand(p: Points, side: str, hand: Array, size: float) -> str:
    """Return where a hand is. hand: from between the shoulders, in heights of a figure with usual arms."""
    away = abs(float(hand[0]))
    elbow = p.get(f"{side}_lower_arm")
    if hand[1] > 0.2:
        return "raised"
    if hand[1] > -0.07 and hand[2] > 0.03 and away < 0.12:
        return "at the chin"
    if elbow is not None and abs(float(elbow[0]) / size) > away + 0.04 and -0.32 < hand[1] < -0.14:
        return "on the hips" if hand[2] < 0.08 else "before the belly"
    if hand[2] > 0.16:
        return "forward"
    if hand[1] < -0.24:
        return "at the sides" if hand[2] < 0.1 else "on the thighs"
    return ""


def _head(p: Points, base: Points) -> str:
    if not {"head", "nose", "crown"} <= set(p):
        return ""
    nose, crown = p["nose"] - p["head"], p["crown"] - p["head"]
    if {"head", "nose", "crown"} <= set(base):
        nose = nose - (base["nose"] - base["head"])
        crown = crown - (base["crown"] - base["head"])
    else:
        nose, crown = nose * np.array([1, 0, 0]), crown * np.array([1, 0, 0])
    if abs(crown[0]) > AWRY and abs(crown[0]) >= abs(nose[0]):
        return f"head tilted {'left' if crown[0] > 0 else 'right'}"
    if abs(nose[0]) > AWRY and abs(nose[0]) >= abs(nose[1]):
        return f"looking {'left' if nose[0] > 0 else 'right'}"
    if abs(nose[1]) > AWRY:
        return f"looking {'up' if nose[1] > 0 else 'down'}"
    return "" if len(p) > 3 else "head straight"
