"""`python -m sample_clips.make.sample_keypoints`: make the sample keypoints again, the same to the byte.

What a pose estimator would find in a video of somebody who talks, had there been one: the sample character,
with another person's proportions, performs a script of stances with gestures between them; a camera looks on;
the joints are seen with jitter, dropped now and then, and the person turns a little this way and that. Nobody
was filmed. Beside it lies what was really done when.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from metagraph.formats.store import open_project
from metagraph.graph import requests as a
from metagraph.graph.model import LAYERS, Layer, Project
from metagraph.mimicry.keypoint_layouts import LAYOUTS
from metagraph.mimicry.signatures import BodySignature
from metagraph.motion.skeleton import Pose
from metagraph.playback.evaluator import Evaluator
from metagraph.playback.plan import Plan
from metagraph.playback.planning.running_plan import plan_performance

SAMPLE = Path(__file__).resolve().parents[1] / "sample.metagraph.yaml"
OUT = Path(__file__).resolve().parents[1] / "keypoints"
NOTE = (
    "Made up: nobody was filmed. Written by sample_clips/make/sample_keypoints.py as an example of what "
    "Metagraph mimics. MIT licence."
)
SECONDS = 60.0
SEED = 20
# What the person does: stance and when it is gone for, seconds. The models do the gestures between.
SCRIPT: Mapping[Layer, tuple[tuple[float, str], ...]] = {
    "arms": (
        (0.0, "hands at sides"),
        (6.0, "on hips"),
        (14.0, "arms crossed"),
        (24.0, "hand to chin"),
        (33.0, "arms crossed"),
        (38.0, "hands clasped"),
        (47.0, "on hips"),
        (53.0, "hands at sides"),
    ),
    "body": (
        (0.0, "weight both"),
        (8.0, "weight left"),
        (17.0, "weight right"),
        (27.0, "weight both"),
        (31.0, "lean forward"),
        (40.0, "weight both"),
        (45.0, "weight left"),
        (54.0, "weight both"),
    ),
    "head": (
        (0.0, "head straight"),
        (10.0, "head tilt left"),
        (20.0, "head straight"),
        (28.0, "head tilt right"),
        (37.0, "head straight"),
        (43.0, "head tilt left"),
        (50.0, "head tilt right"),
        (56.0, "head straight"),
    ),
}
# Another person: how much longer bones are, by a word in the joint's name.
PERSON = {
    "UpperArm": 0.94,
    "LowerArm": 1.05,
    "Hand": 1.03,
    "UpperLeg": 1.06,
    "LowerLeg": 1.05,
    "Neck": 1.08,
    "Head": 0.95,
    "Chest": 0.97,
}


@dataclass(frozen=True)
class View:
    """How the person is seen. turn: degrees the person is turned, to and fro by `sway` more. distance,
    height: of the camera, metres; roll: degrees it is held askew. width, tall, focal: of the picture, pixels.
    jitter: standard deviation of a point, metres, as slow as `slowness` seconds; depth: times as much along
    the camera's axis. lost: share of the time a point is not found.
    """

    turn: float = 0.0
    sway: float = 14.0
    distance: float = 2.7
    height: float = 1.05
    roll: float = 0.6
    width: int = 960
    tall: int = 720
    focal: float = 820.0
    jitter: float = 0.006
    slowness: float = 0.12
    depth: float = 3.0
    lost: float = 0.02
    seed: int = 7


def played(
    project: Project | None = None, script: Mapping[Layer, tuple[tuple[float, str], ...]] = SCRIPT
) -> tuple[Project, Plan]:
    """Return the project and the plan of what the person does."""
    project = open_project(SAMPLE).project if project is None else project
    asks = [
        a.Go(id=f"{layer}{n}", layer=layer, stance=stance, at=at, stay=True, priority=2)
        for layer, rows in script.items()
        for n, (at, stance) in enumerate(rows)
    ]
    return project, plan_performance(project, asks, SECONDS, SEED)


def truth(
    project: Project, plan: Plan, seconds: float = SECONDS
) -> dict[Layer, list[tuple[float, float, str]]]:
    """Return when the person is in which stance: layer -> (start, end, name); times between are spent
    changing.
    """
    out: dict[Layer, list[tuple[float, float, str]]] = {}
    for layer in LAYERS:
        of, rows, start = plan.layers[layer], [], 0.0
        stance = of.rests[0].stance
        for cue in of.cues:
            if cue.then != cue.stance and cue.start < seconds:
                rows.append((start, cue.start, stance))
                start, stance = cue.end, cue.then
        rows.append((start, seconds, stance))
        graph = project.graphs[layer]
        out[layer] = [(round(b, 3), round(e, 3), graph.stances[s].name) for b, e, s in rows if e > b]
    return out


def _noise(shape: tuple[int, ...], seed: int, fps: float, slowness: float) -> Any:
    """Return noise of variance 1 along the first axis that forgets itself in so many seconds."""
    rng = np.random.default_rng(np.random.PCG64(seed))
    white = rng.standard_normal(shape)
    keep = np.exp(-1.0 / (fps * slowness)) if slowness > 0 else 0.0
    out = white.copy()
    for n in range(1, len(out)):
        out[n] = keep * out[n - 1] + np.sqrt(1 - keep**2) * white[n]
    return out


def world(project: Project, plan: Plan, times: Any, person: Mapping[str, float] = PERSON) -> dict[str, Any]:
    """Return where the person's points are, by name, `[F, 3]`: metres, y up, x to the person's left, the
    person looking along z.
    """
    assert project.skeleton is not None
    names = project.skeleton.names
    longer = np.array([next((v for k, v in person.items() if k in name), 1.0) for name in names])
    pose = Evaluator(plan, project).at(times)
    pose = Pose(
        pose.rotations, pose.translations * np.where(np.arange(len(names)) == 0, 1.0, longer)[:, None]
    )
    body = BodySignature(project)
    _, at = project.skeleton.globals(pose)
    from metagraph.mimicry.keypoint_layouts import POINTS

    out = {name: body.points(pose)[:, n] for n, name in enumerate(POINTS)}
    for side in ("left", "right"):
        joint = {
            k: at[:, names.index(f"{side.capitalize()}{k}")]
            for k in ("Index1", "Little1", "Thumb2", "Foot", "Toes")
        }
        eye, nose, sign = out[f"{side}_eye"], out["nose"], 1.0 if side == "left" else -1.0
        out[f"{side}_index"], out[f"{side}_pinky"], out[f"{side}_thumb"] = (
            joint["Index1"],
            joint["Little1"],
            joint["Thumb2"],
        )
        out[f"{side}_heel"] = joint["Foot"] * [1, 0.25, 1] - (joint["Toes"] - joint["Foot"]) * [0.35, 0, 0.35]
        out[f"{side}_toes"] = out[f"{side}_big_toe"] = joint["Toes"] + (joint["Toes"] - joint["Foot"]) * [
            0.5,
            0,
            0.5,
        ]
        out[f"{side}_small_toe"] = joint["Toes"] + np.array([0.05 * sign, 0, 0])
        out[f"{side}_eye_inner"], out[f"{side}_eye_outer"] = (
            eye - [0.012 * sign, 0, 0],
            eye + [0.012 * sign, 0, 0],
        )
        out[f"{side}_mouth"] = nose + [0.025 * sign, -0.045, -0.02]
    out["neck"] = (out["left_shoulder"] + out["right_shoulder"]) / 2
    out["hips"] = (out["left_hip"] + out["right_hip"]) / 2
    return out


def seen(
    project: Project, plan: Plan, layout: str, fps: float, seconds: float = SECONDS, view: View | None = None
) -> tuple[Any, Any, Any, Any]:
    """Return times `[F]`, points in the picture `[F, K, 2]` (pixels, y down), points in space `[F, K, 3]`
    (metres from the hips, x right, y down, z away from the camera, as MediaPipe has them) and confidence `[F,
    K]` of a layout.
    """
    view = view or View()
    times = np.arange(round(seconds * fps)) / fps
    where = world(project, plan, times)
    points = np.stack([where[name] for name in LAYOUTS[layout]], 1)
    frames, count = points.shape[:2]
    points = points + _noise((frames, count, 3), view.seed, fps, view.slowness) * view.jitter * np.array(
        [1, 1, view.depth]
    )
    phase = 2 * np.pi * times
    turn = np.radians(view.turn + view.sway * (0.7 * np.sin(phase / 23.0) + 0.3 * np.sin(phase / 7.0 + 1)))
    c, s = np.cos(turn)[:, None], np.sin(turn)[:, None]
    x, y, z = points[..., 0] * c + points[..., 2] * s, points[..., 1], points[..., 2] * c - points[..., 0] * s
    hips = np.stack([x, y, z], -1)
    roll = np.radians(view.roll)
    up = y - view.height
    across, up = x * np.cos(roll) - up * np.sin(roll), up * np.cos(roll) + x * np.sin(roll)
    near = view.distance - z
    picture = np.stack(
        [view.width / 2 + view.focal * across / near, view.tall / 2 - view.focal * up / near], -1
    )
    middle = (where["left_hip"] + where["right_hip"])[:, None] / 2
    middle = np.stack(
        [middle[..., 0] * c + middle[..., 2] * s, middle[..., 1], middle[..., 2] * c - middle[..., 0] * s], -1
    )
    space = (hips - middle) * [1, -1, -1]
    rng = np.random.default_rng(np.random.PCG64(view.seed + 1))
    sure = np.clip(0.86 + 0.08 * _noise((frames, count), view.seed + 2, fps, 0.3), 0.3, 0.99)
    gone = _noise((frames, count), view.seed + 3, fps, 0.25) < _below(view.lost, rng)
    inside = (picture >= 0).all(-1) & (picture[..., 0] < view.width) & (picture[..., 1] < view.tall)
    return times, picture, space, np.where(gone | ~inside, 0.0, sure)


def _below(share: float, rng: np.random.Generator) -> float:
    """Return below what a share of normally distributed numbers lies."""
    return float(np.quantile(rng.standard_normal(20000), share)) if share > 0 else -np.inf


def openpose(picture: Any, sure: Any, fps: float, view: View) -> str:
    """Return frames as OpenPose writes them, all in one list."""
    rows = []
    for frame, certain in zip(picture, sure, strict=True):
        numbers = []
        for (x, y), c in zip(frame, certain, strict=True):
            numbers += [f"{x:.0f}", f"{y:.0f}", f"{c:.1f}"] if c > 0 else ["0", "0", "0"]
        rows.append(
            json.dumps({"people": [{"pose_keypoints_2d": ["*"]}]}, separators=(",", ":")).replace(
                '"*"', ",".join(numbers)
            )
        )
    head = {"note": NOTE, "version": 1.3, "fps": fps, "width": view.width, "height": view.tall}
    return json.dumps(head)[:-1] + ', "frames": [\n' + ",\n".join(rows) + "\n]}\n"


def mediapipe(times: Any, space: Any, sure: Any) -> str:
    """Return frames as programs around MediaPipe write its world landmarks, one JSON object a line."""
    rows = [json.dumps({"note": NOTE})]
    for t, frame, certain in zip(times, space, sure, strict=True):
        marks = [
            {
                **{k: round(float(v), 3) + 0.0 for k, v in zip("xyz", p, strict=True)},
                "visibility": round(float(c), 2),
            }
            for p, c in zip(frame, certain, strict=True)
        ]
        rows.append(
            json.dumps(
                {"timestampMs": round(float(t) * 1000), "worldLandmarks": marks}, separators=(",", ":")
            )
        )
    return "\n".join(rows) + "\n"


def main() -> None:
    project, plan = played()
    view = View()
    flat = replace(view, seed=view.seed + 10)
    _, picture, _, sure = seen(project, plan, "openpose body_25", 20.0, view=flat)
    feet = [n for n, name in enumerate(LAYOUTS["openpose body_25"]) if name.endswith(("toe", "heel"))]
    sure[:, feet] = 0.0
    times, _, space, certain = seen(project, plan, "mediapipe", 10.0, 20.0, view)
    files = {
        "conversation.openpose.json": openpose(picture, sure, 20.0, flat),
        "conversation.mediapipe.jsonl": mediapipe(times, space, certain),
        "conversation.truth.json": json.dumps(
            {"note": NOTE, "seconds": SECONDS, "layers": truth(project, plan)}, indent=1
        )
        + "\n",
    }
    OUT.mkdir(parents=True, exist_ok=True)
    for name, text in files.items():
        (OUT / name).write_text(text, encoding="utf-8")
        print(f"{name}: {len(text) / 1e3:.0f} kB")


if __name__ == "__main__":
    main()
