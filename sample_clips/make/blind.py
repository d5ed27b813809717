"""Blind lists: strips of clips, or of a character in each mood, in an order that their judge does not know.

python -m sample_clips.make.blind strips FOLDER KEY --seed 7 moods       write FOLDER/00.png ... and the KEY
python -m sample_clips.make.blind strips FOLDER KEY --seed 7 NAME...     the same of clips; names as a whole
python -m sample_clips.make.blind compare KEY GUESSES                    tell how many were right

Look at the pictures without opening the KEY (JSON), and write the GUESSES first: a line each, the number and
a word, such as "03 sad". A guess of a clip is right where its name has the word.
"""

from __future__ import annotations

import argparse
import json
from dataclasses import replace
from pathlib import Path

import msgspec
import numpy as np

from metagraph.formats.gltf.reader import read_gltf_clips
from metagraph.graph.model import Project
from metagraph.graph.requests import make_request
from metagraph.playback.evaluator import Evaluator
from metagraph.playback.planning.mood import MOODS
from metagraph.playback.planning.running_plan import plan_performance
from preview.camera import close_up, make_upper_body_camera
from preview.character_file import load_mesh_figure
from preview.figure import MeshFigure
from preview.offscreen import Offscreen
from preview.scene import LIGHT, Actor, Scene
from preview.sheet import make_contact_sheet, write_png
from sample_clips.make.before_after import CELL, COLUMNS, HERE, base_project, rows
from sample_clips.make.mannequin_rig import SKELETON, Array, at

PLAN_SEED = 3
FROM, EACH = 9.0, 0.6  # seconds of the performance the first picture shows, and between two


def feeling_rows(offscreen: Offscreen, figure: MeshFigure, project: Project, mood: str) -> list[Array]:
    """Return the pictures of a character that talks in a mood: first its body, then its face."""
    valence, arousal = MOODS[mood]
    life = msgspec.structs.replace(project.life, valence=valence, arousal=arousal)
    face = msgspec.structs.replace(project.face, morphs=tuple(figure.morphs))
    project = replace(project, life=life, face=face)
    times = FROM + EACH * np.arange(COLUMNS)
    talking = make_request({"do": "mode", "mode": "talking", "id": "m", "at": 0.0})
    plan = plan_performance(project, [talking], float(times[-1]) + 1.0, PLAN_SEED, idle=True)
    evaluator = Evaluator(plan, project)
    pose = evaluator.at(times)
    rotations, places = SKELETON.globals(pose)
    aspect, far, near = CELL[0] / CELL[1], [], []
    for i, time in enumerate(times):
        morphs = figure.morph_weights(evaluator.morphs_at(float(time)))
        scene = Scene((Actor(figure, rotations[i], places[i], morphs),))
        head = places[i, at("Head")]
        body = make_upper_body_camera(places[0, at("Head")], SKELETON.height, aspect, 0.35).zoom(-2.0)
        face = close_up(head + (0, 0.03, 0), SKELETON.height, aspect).zoom(2.5)
        for camera, out in ((body, far), (face, near)):
            out.append(offscreen.render(scene, camera, LIGHT)[..., :3])
    return [*far, *near]


def strips(folder: Path, key: Path, seed: int, names: list[str], clips: Path) -> None:
    """Write a strip of each name, numbered in a shuffled order, and the key."""
    project = base_project()
    figure = load_mesh_figure(HERE / "ada.glb", SKELETON)
    names = list(MOODS) if names == ["moods"] else names
    order = [names[i] for i in np.random.default_rng(seed).permutation(len(names))]
    folder.mkdir(parents=True, exist_ok=True)
    with Offscreen(*CELL) as offscreen:
        for n, name in enumerate(order):
            if name in MOODS:
                pictures = feeling_rows(offscreen, figure, project, name)
            else:
                (clip,) = read_gltf_clips(clips / f"{name}.glb")
                pictures = rows(offscreen, figure, project, clip, COLUMNS, np.radians(22.0), None)
            page = make_contact_sheet(pictures, COLUMNS, [], f"{n:02d}", gap=4)
            write_png(folder / f"{n:02d}.png", page)
    key.write_text(json.dumps(order), encoding="utf-8")


def compare(key: Path, guesses: Path) -> None:
    """Print each guess beside what it was, and how many are right."""
    order = json.loads(key.read_text(encoding="utf-8"))
    right = 0
    for line in guesses.read_text(encoding="utf-8").splitlines():
        if not line.strip():
            continue
        number, word = line.split()[:2]
        was = order[int(number)]
        right += word in was
        print(number, word, was, "right" if word in was else "WRONG")
    print(f"{right} of {len(order)}")


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m sample_clips.make.blind", description="Blind lists.")
    commands = parser.add_subparsers(dest="command", required=True)
    one = commands.add_parser("strips", help="write strips and their key")
    one.add_argument("folder", type=Path)
    one.add_argument("key", type=Path)
    one.add_argument("names", nargs="+", help="`moods`, or names of clips")
    one.add_argument("--seed", type=int, required=True)
    one.add_argument("--clips", type=Path, default=HERE / "clips", help="the folder of the clips")
    two = commands.add_parser("compare", help="tell how many guesses are right")
    two.add_argument("key", type=Path)
    two.add_argument("guesses", type=Path)
    options = parser.parse_args()
    if options.command == "strips":
        strips(options.folder, options.key, options.seed, options.names, options.clips)
    else:
        compare(options.key, options.guesses)


if __name__ == "__main__":
    main()
