"""Sheets of a clip before and after it was made again: drawn as a character plays it, hands kept in contact
and out of the body.

python -m sample_clips.make.before_after FOLDER --before OLD NAME    write FOLDER/NAME.png: the clip in
    the folder OLD, above those of sample_clips/clips; without a name, of all clips that changed
python -m sample_clips.make.before_after FOLDER NAME                 only the clip as it is
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from metagraph.formats.gltf.reader import read_character, read_gltf_clips
from metagraph.formats.store import open_project
from metagraph.graph.model import Action, ClipEntry, Layer, Project, Timing
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Pose
from metagraph.playback.evaluator import Evaluator
from metagraph.playback.plan import Cue, LayerPlan, Plan, Rest
from metagraph.suggest.find_contacts import find_contacts, with_measured_body
from preview.camera import Camera
from preview.character_file import load_mesh_figure
from preview.figure import MeshFigure
from preview.offscreen import Offscreen
from preview.scene import LIGHT, Actor, Scene
from preview.sheet import make_contact_sheet, write_png
from sample_clips.make.clip_sheet import layer_of
from sample_clips.make.mannequin_rig import SKELETON, Array, at

HERE = Path(__file__).resolve().parents[1]
CELL = (210, 250)  # pixels
COLUMNS = 10
HANDS = (at("LeftHand"), at("RightHand"))
KNUCKLES = (at("LeftMiddle1"), at("RightMiddle1"))
TOGETHER = 0.32  # metres between hands that are shown together
NEAR = 0.15  # metres round what a close-up shows


def base_project() -> Project:
    """Return the sample's base pose, body and settings, with the mannequin's measures."""
    return with_measured_body(
        open_project(HERE / "sample.metagraph.yaml").project, read_character(HERE / "mannequin.glb")
    )


def played(project: Project, clip: Clip, times: Array, below: Clip | None = None) -> Pose:
    """Return how a clip plays at times `[T]`, with the contacts found in it and the guard. below: a clip of
    the body layer it plays over.
    """
    layer: Layer = layer_of(clip.name)
    clips, rests = dict(project.clips), {}
    for each, where in ((below, "body"), (clip, layer)):
        if each is None:
            continue
        clips[each.name] = ClipEntry(each.name, each.name, "", frames=each.frames, fps=each.fps, motion=each)
        action = Action(each.name, each.name, "stance", where, "", each.name, Timing(loop=True, blend_in=0.0))
        rests[where] = action
    project = replace(
        project, clips=clips, touch=msgspec.structs.replace(project.touch, contacts=True, guard=True)
    )
    for where, action in rests.items():
        action = replace(action, contacts=find_contacts(project, action))
        graph = project.graphs[where]
        project = project.with_graph(graph.with_actions({action.id: action}))
        rests[where] = action
    # It plays as a cue, not as a loop: a transition does not go back to where it began.
    layers: Any = {where: LayerPlan(where) for where in project.graphs}
    for where, action in rests.items():
        end = below.duration if where != layer and below is not None else clip.duration
        cue = Cue(action, 0.0, max(end, clip.duration) + 1.0, 0.0, 0.0, 0.0, "", "", "")
        rest = Rest("", action, 0.0, 0.0, 0.0)
        layers[where] = LayerPlan(where, cues=(cue,) if where == layer else (), rests=(rest,))
    end = clip.duration
    return Evaluator(Plan(0, end, layers), project).at(np.minimum(times, end - 1e-4), alive=False)


def moving(pose: Pose) -> list[int]:
    """Return which hands, 0 left and 1 right, a close-up is of: those that move, both where none does."""
    _, places = SKELETON.globals(pose)
    ways = [float(np.ptp(places[:, hand], axis=0).sum()) for hand in HANDS]
    if max(ways) < 0.02:
        return [0, 1]
    return [side for side in (0, 1) if ways[side] > 0.25 * max(ways)]


def cameras(places: Array, which: Sequence[int], layer: str, yaw: float) -> tuple[Camera, Camera]:
    """Return the cameras of one pose: of the figure, and of its hands or face."""
    aspect = CELL[0] / CELL[1]
    low, high = (
        ((-0.42, -0.02, -0.2), (0.42, 1.75, 0.3))
        if layer == "body"
        else ((-0.4, 0.72, -0.1), (0.4, 1.75, 0.3))
    )
    far = Camera().facing(yaw, np.radians(4)).frame((low, high), aspect, 1.0)
    near = Camera().facing(yaw - np.radians(62), np.radians(8))
    if layer == "body":
        return far, near.frame((low, high), aspect, 1.0)
    if layer == "head":
        head = places[at("Head")] + (0, 0.07, 0)
        return far, near.frame((head - 0.17, head + 0.17), aspect, 1.0)
    middles = [(places[HANDS[s]] + places[KNUCKLES[s]]) / 2 for s in which]
    if len(middles) > 1 and np.linalg.norm(middles[0] - middles[1]) > TOGETHER:
        middles = [middles[1]]
    box = (np.min(middles, axis=0) - NEAR, np.max(middles, axis=0) + NEAR)
    return far, near.frame(box, aspect, 1.0)


def rows(
    offscreen: Offscreen,
    figure: MeshFigure,
    project: Project,
    clip: Clip,
    columns: int,
    yaw: float,
    below: Clip | None,
) -> list[Array]:
    """Return the pictures of a clip: first the figure at each time, then its close-ups."""
    times = np.linspace(0, clip.duration, columns)
    pose = played(project, clip, times, below)
    rotations, places = SKELETON.globals(pose)
    which = moving(played(project, clip, np.linspace(0, clip.duration, 60), below))
    far, near = [], []
    for i in range(columns):
        scene = Scene((Actor(figure, rotations[i], places[i]),))
        one, two = cameras(places[i], which, layer_of(clip.name), yaw)
        far.append(offscreen.render(scene, one, LIGHT)[..., :3])
        near.append(offscreen.render(scene, two, LIGHT)[..., :3])
    return [*far, *near]


def main() -> None:
    parser = argparse.ArgumentParser(
        prog="python -m sample_clips.make.before_after", description="Draw clips before and after a change."
    )
    parser.add_argument("folder", type=Path, help="where to write the pictures")
    parser.add_argument(
        "names", nargs="*", help="parts of clips' names; all clips that changed where none is given"
    )
    parser.add_argument("--before", type=Path, help="the folder of clips as they were")
    parser.add_argument("--after", type=Path, default=HERE / "clips", help="the folder of clips as they are")
    parser.add_argument("--below", type=Path, help="a clip of the body layer that they play over")
    parser.add_argument("--character", default="ada.glb", help="who plays them")
    parser.add_argument("--columns", type=int, default=COLUMNS, help="how many times of a clip are drawn")
    parser.add_argument("--yaw", type=float, default=22.0, help="degrees the first camera stands to the left")
    parser.add_argument(
        "--numbered", action="store_true", help="keep the names out of pictures and file names"
    )
    options = parser.parse_intermixed_args()  # names may follow options
    options.folder.mkdir(parents=True, exist_ok=True)
    folders = [f for f in (options.before, options.after) if f is not None]
    names = sorted(p.stem for p in options.after.glob("*.glb"))
    if options.names:
        names = [n for n in names if any(part in n for part in options.names)]
    elif options.before is not None:
        names = [n for n in names if _bytes(options.before, n) != _bytes(options.after, n)]
    project = base_project()
    figure = load_mesh_figure(HERE / options.character, SKELETON)
    below = read_gltf_clips(options.below)[0] if options.below else None
    with Offscreen(*CELL) as offscreen:
        for n, name in enumerate(names):
            pictures, labels = [], []
            for folder in folders:
                path = folder / f"{name}.glb"
                if not path.exists():
                    continue
                (clip,) = read_gltf_clips(path)
                pictures += rows(
                    offscreen, figure, project, clip, options.columns, np.radians(options.yaw), below
                )
                word = "" if len(folders) == 1 else "before " if folder == options.before else "after "
                stamps = [f"{word}{t:.2f} s" for t in np.linspace(0, clip.duration, options.columns)]
                labels += [*stamps, *[""] * options.columns]
            title = f"{n:02d}" if options.numbered else name
            write_png(
                options.folder / f"{title}.png",
                make_contact_sheet(pictures, options.columns, labels, title, gap=4),
            )
            print(title)


def _bytes(folder: Path, name: str) -> bytes:
    path = folder / f"{name}.glb"
    return path.read_bytes() if path.exists() else b""


if __name__ == "__main__":
    main()
