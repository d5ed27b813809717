"""Filmed people: python tests/benchmarks/bench_filmed.py [FOLDER] [--only WORD]

How right MediaPipe (the extra `camera`) is about a person whose motion is known. There is no film of real
people here, so the sample's characters act the script of the sample keypoints before the preview's camera.
For each film: the share of the pictures in which somebody is found, how long a picture takes; the share of
the time outside transitions in which `Mimic` sees the right stance, from points in space and from points in
the picture, and the changes it sees too many; by how many degrees limbs are off, seen from the trunk, and how
far the joints of the take are off, in hundredths of the body's height. Films stay in FOLDER.
"""

from __future__ import annotations

import sys
import tempfile
import time
from argparse import ArgumentParser
from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from math import radians
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from app.cli.render_command import load_figure  # noqa: E402
from app.stage.filming import measure_bounds, render_pictures  # noqa: E402
from app.stage.playback_source import ShownPlayback  # noqa: E402
from metagraph.formats.filmed.film import FilmedKeypoints, film_video, write_filmed_keypoints  # noqa: E402
from metagraph.formats.keypoints.reader import read_keypoints  # noqa: E402
from metagraph.graph.model import LAYERS, Project  # noqa: E402
from metagraph.mimicry.keypoint_layouts import PLACE, KeypointTrack  # noqa: E402
from metagraph.mimicry.keypoint_take import KeypointTakeError, make_clip_from_keypoints  # noqa: E402
from metagraph.mimicry.mimic import Mimic  # noqa: E402
from metagraph.mimicry.signatures import BodySignature  # noqa: E402
from metagraph.motion.roles import find_roles  # noqa: E402
from metagraph.playback.evaluator import Evaluator  # noqa: E402
from metagraph.playback.plan import Plan  # noqa: E402
from preview.camera import Camera  # noqa: E402
from preview.looks import look_of  # noqa: E402
from preview.video import write_video  # noqa: E402
from sample_clips.make.sample_keypoints import SAMPLE, played, truth  # noqa: E402

SIZE, FPS, SECONDS = (720, 720), 20.0, 60.0


@dataclass(frozen=True)
class Shooting:
    """How a character is filmed. yaw: degrees the camera stands aside; waist: only from the hips up; body:
    the character's file.
    """

    name: str
    body: str = "ada.glb"
    yaw: float = 0.0
    waist: bool = False


SHOOTINGS = (
    Shooting("Ada from the front"),
    Shooting("Ada, 25 degrees aside", yaw=25.0),
    Shooting("Ada from the hips up", waist=True),
    Shooting("Ben from the front", "ben.glb"),
    Shooting("the mannequin", "mannequin.glb"),
)


def shoot(shooting: Shooting, project: Project, plan: Plan, path: Path) -> None:
    """Write the film of a character that acts the plan."""
    project = replace(project, character=shooting.body)
    seen = [(load_figure(project, SAMPLE.parent), ShownPlayback(project, plan, SECONDS))]
    times = np.arange(round(SECONDS * FPS)) / FPS
    low, high = (np.asarray(x, float) for x in measure_bounds(seen, times))
    if shooting.waist:
        low[1] = high[1] - 0.52 * (high[1] - low[1])
    camera = Camera(fov=radians(40.0)).facing(radians(shooting.yaw), radians(3.0)).frame((low, high), 1.0)
    look = look_of("light", backdrop="neutral")
    write_video(path, render_pictures(seen, times, SIZE, look, camera), FPS, SIZE)


def score_stances(project: Project, plan: Plan, track: KeypointTrack) -> Mapping[str, tuple[float, int]]:
    """Return for each layer the share of the time in which the right stance is seen, and changes too many."""
    mimic = Mimic(project, mirror=False)
    said: dict[str, list[tuple[float, str | None]]] = {layer: [] for layer in LAYERS}
    for seconds, points, sure in zip(
        track.times, track.points[:, :, : track.dims], track.confidence, strict=True
    ):
        mimic.feed(float(seconds), points, sure)
        for layer in LAYERS:
            ident = mimic.seen.get(layer)
            said[layer].append((float(seconds), project.graphs[layer].stances[ident].name if ident else None))
    out = {}
    for layer, rows in truth(project, plan).items():
        good = total = 0
        for start, end, name in rows:
            inside = [s for t, s in said[layer] if start <= t < end]
            good, total = good + inside.count(name), total + len(inside)
        names = [s for _, s in said[layer] if s is not None]
        out[layer] = good / total, sum(a != b for a, b in pairwise(names)) - (len(rows) - 1)
    return out


def view_from_trunk(points: np.ndarray) -> dict[str, np.ndarray]:
    """Return the directions `[F, 3]` of limbs in the space of the trunk, of COCO's points `[F, 17, 3]`."""
    at = {name: points[:, n] for name, n in PLACE.items()}
    up = at["left_shoulder"] + at["right_shoulder"] - at["left_hip"] - at["right_hip"]
    across = at["left_shoulder"] - at["right_shoulder"]
    up = up / np.linalg.norm(up, axis=-1, keepdims=True)
    across = across - (across * up).sum(-1, keepdims=True) * up
    across = across / np.linalg.norm(across, axis=-1, keepdims=True)
    axes = np.stack([across, up, np.cross(across, up)], 1)
    out = {}
    for limb, a, b in (
        ("upper arms", "shoulder", "elbow"),
        ("lower arms", "elbow", "wrist"),
        ("upper legs", "hip", "knee"),
        ("lower legs", "knee", "ankle"),
    ):
        for side in ("left", "right"):
            way = at[f"{side}_{b}"] - at[f"{side}_{a}"]
            turned = np.einsum("fij,fj->fi", axes, way)
            out[f"{side} {limb}"] = turned / np.linalg.norm(turned, axis=-1, keepdims=True)
    return out


def measure_angles(project: Project, plan: Plan, track: KeypointTrack) -> dict[str, np.ndarray]:
    """Return by how many degrees each kind of limb is off, of both sides."""
    known = BodySignature(project).points(Evaluator(plan, project).at(track.times))
    seen, sure = track.canonical
    good = (sure > 0).all(1)
    true, found = view_from_trunk(known[good]), view_from_trunk(seen[good])
    out: dict[str, np.ndarray] = {}
    for limb, way in true.items():
        off = np.degrees(np.arccos(np.clip((way * found[limb]).sum(-1), -1, 1)))
        out[limb.split(" ", 1)[1]] = np.concatenate([out.get(limb.split(" ", 1)[1], np.empty(0)), off])
    return out


def measure_take(project: Project, plan: Plan, track: KeypointTrack) -> np.ndarray:
    """Return how far hands, elbows, knees and head of the take are off, seen from the hips and with both
    facing ahead, in heights.
    """
    skeleton = project.skeleton
    assert skeleton is not None
    made = make_clip_from_keypoints(track, skeleton, "take")
    times = np.arange(made.frames) / made.fps
    roles = find_roles(skeleton)
    joints = [roles[f"{s}_{r}"] for s in ("left", "right") for r in ("hand", "lower_arm", "lower_leg")]
    joints.append(roles["head"])
    out = []
    for poses in (Evaluator(plan, project).at(times), made.poses()):
        places = skeleton.globals(poses)[1]
        places = places - places[:, [roles["hips"]]]
        across = places[:, roles["left_upper_arm"]] - places[:, roles["right_upper_arm"]]
        angle = np.arctan2(across[:, 2], across[:, 0])
        c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
        x, z = places[..., 0], places[..., 2]
        out.append(np.stack([x * c + z * s, places[..., 1], z * c - x * s], -1)[:, joints])
    return np.asarray(np.linalg.norm(out[0] - out[1], axis=-1) / skeleton.height)


def describe(values: np.ndarray, unit: str) -> str:
    """Return the median and the 95th percentile in words."""
    return f"{np.median(values):5.1f} {unit}, 95 of 100 below {np.quantile(values, 0.95):5.1f}"


def film(path: Path) -> tuple[FilmedKeypoints, float]:
    """Return what is seen in a film, and the seconds it took."""
    begin = time.perf_counter()
    filmed = film_video(path)
    return filmed, time.perf_counter() - begin


def main() -> None:
    parser = ArgumentParser(description="How right MediaPipe is about a person whose motion is known.")
    parser.add_argument("folder", nargs="?", type=Path, default=Path(tempfile.gettempdir()) / "filmed")
    parser.add_argument("--only", default="", help="only films with this in their name")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    project, plan = played()
    for shooting in SHOOTINGS:
        if options.only not in shooting.name:
            continue
        path = options.folder / f"{shooting.name.replace(' ', '-').replace(',', '')}.mp4"
        if not path.exists():
            shoot(shooting, project, plan, path)
        filmed, took = film(path)
        write_filmed_keypoints(filmed, path.with_suffix(".jsonl"))
        assert len(read_keypoints(path.with_suffix(".jsonl"))) == len(filmed.track)
        found = sum("worldLandmarks" in frame for frame in filmed.frames) / len(filmed.frames)
        print(f"{shooting.name}: found in {found:.1%}, {1e3 * took / len(filmed.frames):.0f} ms a picture")
        for way, track in (("space", filmed.track), ("picture", filmed.track.flat)):
            assert track is not None
            scores = score_stances(project, plan, track)
            words = ", ".join(f"{layer} {share:.0%} ({more:+d})" for layer, (share, more) in scores.items())
            print(f"  stances in {way:8} {words}")
        for limb, off in measure_angles(project, plan, filmed.track).items():
            print(f"  {limb:10} off {describe(off, 'degrees')}")
        try:
            off = 100 * measure_take(project, plan, filmed.track)
            print(f"  take       off {describe(off, '% of the height')}")
        except KeypointTakeError as error:
            print(f"  take       none: {error}")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
