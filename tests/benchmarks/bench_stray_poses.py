"""How often bind poses left in takes are found, and how often one is seen if there is none.

Run: python -m tests.benchmarks.bench_stray_poses [FOLDER ...] [--every N] [--show]. Takes of the folders (by
default the sample clips, and ../shared/data where it is) get bind poses put in, in many ways, which must all
go, no frame more and none less; and the same takes start fast, or smoothly from a bind pose, and must stay.
"""

from __future__ import annotations

import argparse
import time
import zlib
from collections import defaultdict
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.errors import FileError
from metagraph.formats.clips import find_clip_files, read_clips
from metagraph.formats.stray_poses import find_stray_poses
from metagraph.formats.takes import BIND_POSE, LONE_FRAME
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.roles import find_roles
from metagraph.motion.skeleton import Pose
from metagraph.motion.standing import find_standing_pose

Array = NDArray[Any]
Case = tuple[
    str, Clip, int, int, tuple[int, ...]
]  # what was made, frames to drop first and last, and lone ones
SHORTEST = 12  # frames


def takes_of(folders: list[Path]) -> list[Clip]:
    """Return the takes of folders as their authors meant them: a bind pose that is in the file is cut off."""
    out = []
    for folder in folders:
        for path in find_clip_files(folder):
            try:
                takes = read_clips(path, (BIND_POSE, LONE_FRAME))
            except FileError:
                continue
            for clip in takes:
                if clip.frames >= SHORTEST:
                    out.append(clip.trimmed(1) if any(r.name == BIND_POSE for r in clip.repairs) else clip)
    return out


# --- poses


def posed(clip: Clip, below: float) -> Pose | None:
    """Return a standing pose with its arms straight out, so many degrees below the level; None without
    arms.
    """
    skeleton, roles = clip.skeleton, find_roles(clip.skeleton)
    needed = [f"{s}_{r}" for s in ("left", "right") for r in ("upper_arm", "lower_arm", "hand", "upper_leg")]
    if any(role not in roles for role in (*needed, "hips", "head")):
        return None
    standing = find_standing_pose(clip, roles)
    local = standing.rotations.astype(float).copy()
    _, at = skeleton.globals(standing)
    up = at[roles["head"]] - at[roles["hips"]]
    up = up / np.linalg.norm(up)
    left = at[roles["left_upper_arm"]] - at[roles["right_upper_arm"]]
    left = left - up * (left @ up)
    left = left / max(1e-9, float(np.linalg.norm(left)))
    for side, sign in (("left", 1.0), ("right", -1.0)):
        angle = np.radians(below)
        wanted = sign * np.cos(angle) * left - np.sin(angle) * up
        for joint, tip in (("upper_arm", "lower_arm"), ("lower_arm", "hand")):
            a, b = roles[f"{side}_{joint}"], roles[f"{side}_{tip}"]
            model, at = skeleton.globals(Pose(local, standing.translations))
            turn = rotation.find_rotation_between(at[b] - at[a], wanted)
            above = model[skeleton.parents[a]]
            local[a] = rotation.multiply(rotation.conjugate(above), rotation.multiply(turn, model[a]))
    return Pose(local, standing.translations)


def noisy(pose: Pose, degrees: float, seed: int) -> Pose:
    rng = np.random.default_rng(seed)
    axes = rng.normal(size=(len(pose.rotations), 3))
    axes /= np.linalg.norm(axes, axis=-1, keepdims=True)
    turns = rotation.from_axis_angle(axes, np.radians(degrees) * rng.normal(size=len(axes)))
    return Pose(rotation.multiply(pose.rotations, turns), pose.translations)


def resting(clip: Clip, pose: Pose) -> Clip:
    """Return the clip on a skeleton that rests in another pose; its motion stays."""
    skeleton = replace(
        clip.skeleton, rest_rotations=pose.rotations, rest_translations=clip.skeleton.rest_translations
    )
    return replace(clip, skeleton=skeleton)


# --- takes made of takes


def row(clip: Clip, pose: Pose, at_origin: bool, near: int) -> tuple[Array, Array]:
    """Return a frame `[1, J, 4]`, `[1, T, 3]` of the clip that holds a pose."""
    places = pose.translations[list(clip.translated)].astype(np.float32)
    if not at_origin:
        places = places.copy()
        places[0] = clip.translations[near, 0]
    return pose.rotations[None].astype(np.float32), places[None]


def joined(clip: Clip, parts: list[tuple[Array, Array]]) -> Clip:
    turns = rotation.make_continuous(np.concatenate([p[0] for p in parts]))
    return replace(
        clip,
        rotations=turns,
        translations=np.concatenate([p[1] for p in parts]),
        morphs=(),
        weights=None,
    )


def between(one: tuple[Array, Array], other: tuple[Array, Array], shares: Array) -> tuple[Array, Array]:
    n = len(shares)
    turns = rotation.slerp(
        np.repeat(one[0], n, 0), np.repeat(other[0], n, 0), np.repeat(shares[:, None], one[0].shape[1], 1)
    )
    return turns.astype(np.float32), one[1] + (other[1] - one[1]) * shares[:, None, None].astype(np.float32)


def whole(clip: Clip) -> tuple[Array, Array]:
    return clip.rotations, clip.translations


def backwards(clip: Clip) -> Clip:
    return replace(
        clip, rotations=clip.rotations[::-1], translations=clip.translations[::-1], morphs=(), weights=None
    )


def resampled(clip: Clip, fps: float, count_first: bool) -> tuple[Clip, int]:
    """Return the clip at another rate, and how many frames lie before its second one."""
    times = np.arange(int(clip.duration * fps) + 1) / fps
    low, high, part = clip.locate(times)  # straight between keys, as tools do it
    turned = np.broadcast_to(part[:, None], (len(times), len(clip.skeleton)))
    moved_by = part[:, None, None]
    moved = replace(
        clip,
        fps=fps,
        rotations=rotation.make_continuous(rotation.nlerp(clip.rotations[low], clip.rotations[high], turned)),
        translations=clip.translations[low] * (1 - moved_by) + clip.translations[high] * moved_by,
        morphs=(),
        weights=None,
    )
    return moved, int(np.sum(times < 1 / clip.fps - 1e-6)) if count_first else 0


def with_stray_poses(clip: Clip) -> Iterator[Case]:
    """Make takes with bind poses in them."""
    rest = clip.skeleton.rest
    seed = zlib.crc32(clip.name.encode())
    poses: dict[str, tuple[Clip, Pose]] = {
        "rest": (clip, rest),
        "noisy rest": (clip, noisy(rest, 2.0, seed)),
    }
    arms = {name: posed(clip, below) for name, below in (("T", 0.0), ("A", 45.0), ("hanging", 80.0))}
    if arms["T"] is not None and arms["A"] is not None and arms["hanging"] is not None:
        hanging = resting(clip, arms["hanging"])
        poses |= {
            "T-pose": (clip, arms["T"]),
            "A-pose": (clip, arms["A"]),
            "hanging rest": (hanging, arms["hanging"]),
            "T over hanging rest": (hanging, arms["T"]),
            "A over hanging rest": (hanging, arms["A"]),
        }
    for name, (own, pose) in poses.items():
        for origin in (False, True):
            place = "origin" if origin else "in place"
            head, tail = row(own, pose, origin, 0), row(own, pose, origin, -1)
            yield f"first, {name}, {place}", joined(own, [head, whole(own)]), 1, 0, ()
        yield f"last, {name}", joined(own, [whole(own), tail]), 0, 1, ()
        yield f"both, {name}", joined(own, [head, whole(own), tail]), 1, 1, ()
    head, tail = row(clip, rest, False, 0), row(clip, rest, False, -1)
    begin = (clip.rotations[:1], clip.translations[:1])
    end = (clip.rotations[-1:], clip.translations[-1:])
    yield "held 3 frames", joined(clip, [head, head, head, whole(clip)]), 3, 0, ()
    for count in (1, 2, 3):
        way = between(head, begin, np.arange(1, count + 1) / (count + 1))
        yield f"ramp of {count}", joined(clip, [head, way, whole(clip)]), 1 + count, 0, ()
        way = between(end, tail, np.arange(1, count + 1) / (count + 1))
        yield f"ramp of {count} at the end", joined(clip, [whole(clip), way, tail]), 0, 1 + count, ()
    bound = joined(clip, [head, whole(clip)])
    for rate in (24.0, 25.0, 50.0, 60.0, 120.0):
        if abs(rate - clip.fps) > 1:
            moved, count = resampled(bound, rate, True)
            yield f"resampled to {rate:.0f}", moved, count, 0, ()
    if clip.frames > 20 and clip.fps >= 18:
        middle = clip.frames // 2
        one, two = clip.trimmed(0, middle), clip.trimmed(middle)
        yield (
            "lone frame",
            joined(clip, [whole(one), row(clip, rest, False, middle), whole(two)]),
            0,
            0,
            (middle,),
        )


def without_stray_poses(clip: Clip) -> Iterator[Case]:
    """Make takes that begin and end oddly and are all their author's."""
    yield "as it is", clip, 0, 0, ()
    rest, begin = clip.skeleton.rest, (clip.rotations[:1], clip.translations[:1])
    arms = posed(clip, 0.0)
    for name, pose in (("rest", rest), ("T-pose", arms)):
        if pose is None:
            continue
        head = row(clip, pose, False, 0)
        for seconds in (0.3, 0.6, 1.0):
            u = np.arange(1, max(2, round(seconds * clip.fps))) / max(2, round(seconds * clip.fps))
            eased = between(head, begin, u * u * (3 - 2 * u))
            yield f"smoothly from {name} in {seconds} s", joined(clip, [head, eased, whole(clip)]), 0, 0, ()
            held = [head] * round(0.4 * clip.fps)
            yield (
                f"held {name}, then in {seconds} s",
                joined(clip, [*held, head, eased, whole(clip)]),
                0,
                0,
                (),
            )
        late = between(head, begin, 1 - (1 - u) ** 2)
        yield f"fast from {name}", joined(clip, [head, late, whole(clip)]), 0, 0, ()
    steps = rotation.measure_angle_between(
        clip.rotations[1:].astype(float), clip.rotations[:-1].astype(float)
    ).sum(-1)
    fastest = int(np.argmax(steps[: max(1, len(steps) - SHORTEST)]))
    cut = clip.trimmed(fastest)
    yield "cut where it is fastest", cut, 0, 0, ()
    for name, own in (("begins", clip), ("is cut", cut)):
        first = Pose(own.rotations[0].astype(float), own.skeleton.rest_translations)
        yield f"rests as it {name}", resting(own, first), 0, 0, ()
        yield f"rests as it {name}, backwards", backwards(resting(own, first)), 0, 0, ()
    yield (
        "twice as fast",
        replace(
            clip, rotations=clip.rotations[::2], translations=clip.translations[::2], morphs=(), weights=None
        ),
        0,
        0,
        (),
    )
    for rate in (12.0, 15.0, 60.0):
        moved, _ = resampled(clip, rate, False)
        yield f"at {rate:.0f} fps", moved, 0, 0, ()


def right(case: Case, find: Callable[[Clip], tuple[int, int, tuple[int, ...]]]) -> bool:
    _, clip, first, last, lone = case
    return find(clip) == (first, last, lone)


def seen(case: Case) -> bool:
    """Whether the steps from and to what was put in stand out at all: the largest is larger than any of the
    clip's own.
    """
    _, clip, first, last, lone = case
    _, places = clip.skeleton.globals(clip.poses())
    steps = np.sqrt((np.diff(places - places.mean(1, keepdims=True), axis=0) ** 2).sum(-1).mean(-1))
    put = np.zeros(len(steps), bool)
    put[:first] = True
    put[len(steps) - last :] = True
    for frame in lone:
        put[frame - 1 : frame + 1] = True
    ends = ([steps[:first].max()] if first else []) + ([steps[-last:].max()] if last else [])
    ends += [steps[frame - 1 : frame + 1].min() for frame in lone]
    return min(ends) > max(steps[~put].max(), 1e-3 * clip.skeleton.height)


def found(clip: Clip) -> tuple[int, int, tuple[int, ...]]:
    [poses] = find_stray_poses([clip])
    return poses.first, poses.last, poses.lone


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", type=Path, nargs="*")
    parser.add_argument("--every", type=int, default=1, help="take only every so many takes")
    parser.add_argument("--show", action="store_true", help="name the takes that went wrong")
    options = parser.parse_args()
    root = Path(__file__).resolve().parents[2]
    folders = options.folders or [
        p for p in (root / "sample_clips", root.parent / "shared" / "data") if p.is_dir()
    ]
    takes = takes_of(folders)[:: options.every]
    print(f"{len(takes)} takes")
    for title, make in (("found", with_stray_poses), ("left whole", without_stray_poses)):
        counts: dict[str, list[int]] = defaultdict(lambda: [0, 0])
        began = time.perf_counter()
        for clip in takes:
            for case in make(clip):
                if case[1].frames < SHORTEST - 2:
                    continue
                if case[2:] != (0, 0, ()) and not seen(case):
                    continue
                good = right(case, found)
                counts[case[0]][0] += good
                counts[case[0]][1] += 1
                if options.show and not good:
                    print(f"  {case[0]}: {clip.name}: {found(case[1])}, not {case[2:]}")
        good, total = (sum(row[n] for row in counts.values()) for n in (0, 1))
        for name, (some, of) in sorted(counts.items(), key=lambda item: item[1][0] / item[1][1]):
            print(f"{some:6} of {of:6}  {some / of:7.2%}  {name}")
        print(f"{title}: {good} of {total}, {good / total:.2%}, in {time.perf_counter() - began:.0f} s\n")


if __name__ == "__main__":
    main()
