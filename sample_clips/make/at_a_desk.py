"""Seat two at a desk with cups, who talk: a project beside the samples, to look at and to film.

    python -m sample_clips.make.at_a_desk FOLDER

writes the project there, with the paths of the samples. Then film it:

    metagraph render FOLDER/desk.metagraph.yaml --conversation talk --depth-of-field -o desk.mp4
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import msgspec

from metagraph.formats.project.paths import make_paths_absolute
from metagraph.formats.store import open_project, save_project
from metagraph.graph.backdrop import Backdrop
from metagraph.graph.editing.props import add_prop
from metagraph.graph.model import Project
from metagraph.graph.prop import Prop

SAMPLES = Path(__file__).resolve().parents[1]
EDGE = -0.28  # metres ahead of where who sits stood: the desk's edge, before the body
LONG = 1.4  # of the desk, from one to the other
SEAT = -0.42  # metres: where the middle of a chair is
APART = LONG + 2 * EDGE  # metres between where both stood


def make_desk_talk() -> Project:
    """Return the seated sample with the sample's conversation: Ben and Ada at the ends of a desk."""
    project = make_paths_absolute(open_project(SAMPLES / "seated.metagraph.yaml").project, SAMPLES)
    sample = make_paths_absolute(open_project(SAMPLES / "sample.metagraph.yaml").project, SAMPLES)
    talk = next(iter(sample.conversations.values()))
    ben, ada = (msgspec.structs.replace(side, project=None, take=None, motion=None) for side in talk.sides)
    ada = msgspec.structs.replace(ada, character=str(SAMPLES / "ada.glb"))
    talk = msgspec.structs.replace(talk, name="talk", sides=(ben, ada), distance=APART)
    project = replace(project, conversations={"talk": talk}, backdrop=Backdrop(kind="room"))
    for name, at, turn in (
        ("desk", (0.0, 0.0, EDGE + LONG / 2), 90.0),
        ("chair", (0.0, 0.0, SEAT), 0.0),
        ("chair", (0.0, 0.0, APART - SEAT), 180.0),
        ("cup", (0.22, 0.74, 0.16), 40.0),
        ("cup", (-0.22, 0.74, APART - 0.16), -120.0),
        ("plant", (1.5, 0.0, APART / 2), 0.0),
    ):
        path = str(SAMPLES / "props" / f"{name}.glb")
        project, _ = add_prop(project, Prop(name=name, path=path, at=at, turn=(0.0, turn, 0.0)))
    return project


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    save_project(make_desk_talk(), folder / "desk.metagraph.yaml")
