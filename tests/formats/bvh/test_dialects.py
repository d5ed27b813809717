"""BVH as motion capture suits write it: Xsens MVN, Perception Neuron and Rokoko."""

from __future__ import annotations

from pathlib import Path

import pytest

from metagraph.formats.clips import read_clips
from metagraph.motion.roles import find_missing_roles, find_roles

Offset = tuple[float, float, float]
Figure = dict[str, tuple[str, Offset]]  # joint -> its parent, "" for none, and its offset, centimetres


def figure(middle: Figure, left: Figure) -> Figure:
    """Return a figure whose left side is also its right side; "*" stands for the side in a parent's name."""
    out = dict(middle)
    for side, sign in (("Left", 1), ("Right", -1)):
        for name, (parent, (x, y, z)) in left.items():
            out[side + name] = (parent.replace("*", side), (sign * x, y, z))
    return out


def trunk(*names: str) -> Figure:
    return {n: (names[k - 1] if k else "", (0, 11 * (k > 0), 0)) for k, n in enumerate(names)}


def limbs(arm: list[str], leg: list[str], above: str, more: Figure) -> Figure:
    places: list[Offset] = [(3, 8, 0), (14, 0, 0), (28, 0, 0), (25, 0, 0)]
    under: list[Offset] = [(9, 0, 0), (0, -42, 0), (0, -42, 0), (0, -8, 15)]
    out: Figure = {}
    for names, first, offsets in ((arm, above, places), (leg, "Hips", under)):
        for n, (name, offset) in enumerate(zip(names, offsets, strict=False)):
            out[name] = (f"*{names[n - 1]}" if n else first, offset)
    return out | more


XSENS = figure(
    trunk("Hips", "Chest", "Chest2", "Chest3", "Chest4", "Neck", "Head"),
    limbs(["Collar", "Shoulder", "Elbow", "Wrist"], ["Hip", "Knee", "Ankle", "Toe"], "Chest4", {}),
)
NEURON = figure(
    trunk("Hips", "Spine", "Spine1", "Spine2", "Spine3", "Neck", "Head"),
    limbs(
        ["Shoulder", "Arm", "ForeArm", "Hand"],
        ["UpLeg", "Leg", "Foot"],
        "Spine3",
        {"InHandIndex": ("*Hand", (4, 0, 1)), "HandIndex1": ("*InHandIndex", (5, 0, 1))},
    ),
)
ROKOKO = figure(
    trunk("Hips", "Spine1", "Spine2", "Spine3", "Spine4", "Neck", "Head"),
    limbs(["Shoulder", "Arm", "ForeArm", "Hand"], ["Thigh", "Shin", "Foot", "Toe"], "Spine4", {}),
)


def write(path: Path, joints: Figure, places: bool, time: str) -> Path:
    """Write a file of 30 frames. places: whether every joint has channels of its place, as Neuron's have."""
    children: dict[str, list[str]] = {}
    for name, (parent, _) in joints.items():
        children.setdefault(parent, []).append(name)
    out, order = ["HIERARCHY"], list[str]()

    def add(name: str) -> None:
        order.append(name)
        parent, offset = joints[name]
        turns = "Yrotation Xrotation Zrotation"
        six = not parent or places
        out.append(f"{'JOINT' if parent else 'ROOT'} {name}\n{{\nOFFSET {' '.join(map(str, offset))}")
        out.append(f"CHANNELS 6 Xposition Yposition Zposition {turns}" if six else f"CHANNELS 3 {turns}")
        for child in children.get(name, []):
            add(child)
        if name not in children:
            out.append(f"End Site\n{{\nOFFSET {'0 -3 5' if 'oo' in name or 'oe' in name else '0 5 0'}\n}}")
        out.append("}")

    add(children[""][0])
    rows = []
    for frame in range(30):
        row: list[float] = []
        for name in order:
            parent, offset = joints[name]
            row += [0, 95, 0] if not parent else offset if places else []
            row += [0, 0.3 * frame * name.endswith(("ForeArm", "Elbow")), 0]
        rows.append(" ".join(f"{x:g}" for x in row))
    path.write_text("\n".join([*out, "MOTION", "Frames: 30", f"Frame Time: {time}", *rows]) + "\n")
    return path


@pytest.mark.parametrize(
    ("joints", "places", "time", "rate", "hand", "foot"),
    [
        (XSENS, False, "0.016667", 60, "LeftWrist", "LeftAnkle"),
        (NEURON, True, "0.008333", 120, "LeftHand", "LeftFoot"),
        (ROKOKO, False, "0.010000", 100, "LeftHand", "LeftFoot"),
    ],
    ids=["Xsens MVN", "Perception Neuron", "Rokoko"],
)
def test_each_suit_gives_a_person_of_its_size_with_all_parts(
    tmp_path: Path, joints: Figure, places: bool, time: str, rate: float, hand: str, foot: str
) -> None:
    (clip,) = read_clips(write(tmp_path / "a.bvh", joints, places, time))
    roles = find_roles(clip.skeleton)
    assert clip.fps == rate and not find_missing_roles(roles)
    assert clip.translated == (0,)  # places that only repeat the offset move nothing
    names = clip.skeleton.names
    assert (names[roles["left_hand"]], names[roles["left_foot"]]) == (hand, foot)
    _, at = clip.skeleton.globals(clip.poses())
    assert at[0, names.index("Head"), 1] == pytest.approx(0.95 + 0.66, abs=0.05)
