"""How long bringing clips onto another character, and mirroring them, take: python
tests/benchmarks/bench_retarget.py

150 clips of 3 seconds at 30 frames a second on a skeleton of 61 joints, onto one of 134 joints when
../shared/data is here, else onto the same figure in another size. Prints seconds: proposing the joint map,
retargeting and mirroring all, medians of three.

Then, of clips of every character in ../shared/data and of ours, spread over each set: degrees that joints
are turned from themselves on the way to another figure and back, 95th percentile and greatest, of what can
survive (`tests/retarget_measures.py` says what cannot, here `lost`) and of all; and of frames in which hands
touch their own body, how far the target's are from that place, with contacts left out and carried over:
medians and 95th percentiles in hundredths of its height, of all and of hands that touch each other, and the
greatest acceleration of a wrist in the median clip.
"""

from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.formats.clips import read_clips  # noqa: E402
from metagraph.motion import rotation  # noqa: E402
from metagraph.motion.clip import Clip  # noqa: E402
from metagraph.motion.joint_map import propose_joint_map  # noqa: E402
from metagraph.motion.mirror import find_joint_twins, mirror  # noqa: E402
from metagraph.motion.retarget import retarget  # noqa: E402
from metagraph.motion.skeleton import Pose, Skeleton  # noqa: E402
from metagraph.motion.standing import find_standing_pose  # noqa: E402
from sample_clips.make.mannequin_skeleton import mannequin_skeleton  # noqa: E402
from tests.retarget_measures import contact_errors, round_trip, variant  # noqa: E402

CLIPS, FRAMES, ROUNDS = 150, 91, 3
EACH, LONGEST = 6, 150  # clips of a set, frames of a clip
SETS = {
    "adult": "sumerian-hosts/glTF/animations/adult_female/*.glb",
    "alien": "sumerian-hosts/glTF/animations/alien/*.glb",
    "bandai": "bandai-namco-1/*.bvh",
    "brad": "smartbody-brad/**/*.bvh",
    "cmu": "mesh2motion-cmu/*.fbx",
    "crossarms": "fbx-pab/crossarms.fbx",
    "kaykit": "kaykit-rogue/**/*.glb",
    "mesh2motion": "mesh2motion-cmu/human-addon-animations.glb",
    "robot": "robot-expressive/**/*.glb",
}


def clips(skeleton: Skeleton) -> list[Clip]:
    rng = np.random.default_rng(1)
    x = np.linspace(0, 2 * np.pi, FRAMES)[:, None, None]
    out = []
    for n in range(CLIPS):
        turns = 0.2 * np.sin(x + rng.random((1, len(skeleton), 1))) * rng.normal(size=(1, len(skeleton), 3))
        root = np.tile(skeleton.rest_translations[:1], (FRAMES, 1, 1))
        out.append(
            Clip(
                f"clip {n}",
                skeleton,
                30,
                rotation.multiply(skeleton.rest_rotations, rotation.exp(turns)),
                root,
            )
        )
    return out


def timed(work: Callable[[], object]) -> float:
    times = []
    for _ in range(ROUNDS):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return statistics.median(times)


def sets() -> dict[str, list[Clip]]:
    """Some clips of each character, all on one skeleton."""
    folder = ROOT.parent / "shared" / "data"
    files = {name: sorted(folder.glob(pattern)) for name, pattern in SETS.items()}
    files = {"sample": sorted((ROOT / "sample_clips" / "clips").glob("*.glb")), **files}
    out = {}
    for name, paths in files.items():
        found = [clip for path in paths for clip in read_clips(path)]
        kinds = [sum(c.skeleton == clip.skeleton for c in found) for clip in found]
        own = [c for c in found if c.skeleton == found[kinds.index(max(kinds))].skeleton]
        some = [own[int(i)] for i in np.unique(np.linspace(0, len(own) - 1, EACH).astype(int))] if own else []
        if some:
            out[name] = [clip.trimmed(0, LONGEST) for clip in some]
    return out


def trips(clips: dict[str, list[Clip]], poses: dict[str, Pose]) -> None:
    print(f"\n{'there and back':>24}   kept p95   max   lost %   all p95   max   with contacts p95")
    for one in clips:
        for two in clips:
            if one == two:
                continue
            kept, every, touching, worst = [], [], [], ("", 0.0)
            for clip in clips[one]:
                degrees, fine = round_trip(clip, clips[two][0].skeleton, poses[one], poses[two])
                also, _ = round_trip(clip, clips[two][0].skeleton, poses[one], poses[two], contacts=True)
                for role, angle in degrees.items():
                    kept.append(angle[fine[role]])
                    every.append(angle)
                    touching.append(also[role])
                    if len(kept[-1]) and kept[-1].max() > max(2, worst[1]):
                        worst = (f"{role} of {clip.name[:30]}", float(kept[-1].max()))
            k, e, t = (np.concatenate(x) for x in (kept, every, touching))
            print(
                f"{one:>11} - {two:<11}{np.percentile(k, 95):9.2f}{k.max():7.1f}"
                f"{100 * (1 - len(k) / len(e)):8.1f}{np.percentile(e, 95):10.2f}{e.max():7.1f}"
                f"{np.percentile(t, 95):10.2f}   {worst[0]}"
            )


def contacts(clips: dict[str, list[Clip]], poses: dict[str, Pose]) -> None:
    print(f"\n{'hands at their own body':>24}  frames     all, off -> on          hands, off -> on     wrist")
    made = variant(clips["sample"][0].skeleton)
    targets = {name: (some[0].skeleton, poses[name]) for name, some in clips.items()}
    targets["variant"] = (made, made.rest)

    def told(parts: list[np.ndarray]) -> str:
        one = np.concatenate(parts)
        return f"{100 * np.median(one):4.1f} {100 * np.percentile(one, 95):4.1f}" if len(one) else "   -    -"

    for one in clips:
        for two, (skeleton, pose) in targets.items():
            if one == two:
                continue
            off, on = (
                [contact_errors(clip, skeleton, poses[one], pose, carried) for clip in clips[one]]
                for carried in (False, True)
            )
            count = sum(len(found[0]) for found in off)
            if count:
                words = [f"{told([f[n] for f in off])} -> {told([f[n] for f in on])}" for n in (0, 1)]
                speed = [float(np.median([f[2] for f in x])) for x in (off, on)]
                words.append(f"{speed[0]:5.1f} -> {speed[1]:5.1f}")
                print(f"{one:>11} - {two:<11}{count:6}   {'   '.join(words)}")


def main() -> None:
    source = mannequin_skeleton()
    file = ROOT.parent / "shared" / "data" / "sumerian-hosts/glTF/animations/adult_female/stand_idle.glb"
    target = read_clips(file)[0].skeleton if file.exists() else Skeleton(
        source.names, source.parents, source.rest_rotations, source.rest_translations * 1.2
    )  # fmt: skip
    many = clips(source)
    joint_map, pairs = propose_joint_map(source, target), find_joint_twins(source)
    print(f"{CLIPS} clips of {(FRAMES - 1) / 30:.0f} s, {len(source)} joints onto {len(target)}")
    print(f"joint map   {timed(lambda: propose_joint_map(source, target)):8.3f} s")
    print(f"retarget    {timed(lambda: [retarget(c, target, joint_map) for c in many]):8.3f} s")
    print(f"mirror      {timed(lambda: [mirror(c, pairs) for c in many]):8.3f} s")
    some = sets()
    poses = {name: find_standing_pose(clips[0]) for name, clips in some.items()}
    trips(some, poses)
    contacts(some, poses)


if __name__ == "__main__":
    main()
