"""The shipped conformance vectors: `python -m sample_clips.make.conformance`."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import msgspec
import numpy as np

from metagraph import engines
from metagraph.engines.export import write_project_files
from metagraph.engines.script_repeats import list_repeat_cases
from metagraph.engines.vectors import list_cases, write_vectors
from metagraph.graph.model import Project
from metagraph.motion.character_mesh import CharacterMesh, MeshMaterial, Surface
from sample_clips.make.conformance_projects import (
    BOTH_EYES,
    repeating,
    sparse,
    standing,
    stepping,
    stick,
    still,
    touching,
    varied,
    with_parameters,
)
from sample_clips.make.randomised_projects import randomised

LIVING = (
    "the models alone",
    "two minutes",
    "a thing that moves",
    "words that are said",
    "stressed syllables",
    "the models in four moods",
    "moods over moods",
    "questions and lips that meet",
    "a mood's face over time",
)
STANDING = (
    "the models alone",
    "two minutes",
    "body: to a stance and back",
    "arms: to a stance and back",
    "arms: holds and preparations",
    "arms: strokes in a mood",
    "chatter 1",
    "chatter 2",
    "arms that weigh",
    "one clip on both",
)
FOLDER = Path(engines.__file__).with_name("conformance")


def _face(project: Project, morphs: tuple[str, ...]) -> CharacterMesh:
    """Return a mesh of one triangle whose corner the morph targets move."""
    skeleton = project.skeleton
    assert skeleton is not None
    corners = np.array([[0.0, 1.6, 0.1], [0.05, 1.6, 0.1], [0.0, 1.65, 0.1]])
    normals, uvs = np.tile([0.0, 0.0, 1.0], (3, 1)), np.zeros((3, 2))
    joints, weights = np.zeros((3, 4), int), np.tile([1.0, 0, 0, 0], (3, 1))
    joints[:, 0] = skeleton.index("Head")
    shifts = np.zeros((len(morphs), 3, 3))
    shifts[:, 2, 1] = 0.01
    return CharacterMesh(
        "face",
        skeleton,
        corners,
        normals,
        uvs,
        joints,
        weights,
        np.array([[0, 1, 2]]),
        (MeshMaterial("grey"),),
        (Surface(0, 1, 0),),
        morphs,
        shifts,
    )


def without_authors(path: Path) -> None:
    """Rewrite an export as a program might that knows nothing of what users set: `own_weights` and
    `own_markov` report nothing, and parts that a layer does not move are not listed.
    """
    document = json.loads(path.read_bytes())
    for layer in document["layers"].values():
        layer["weights"] = {part: weight for part, weight in layer["weights"].items() if weight != 0}
        layer["own_weights"], layer["own_markov"] = [], False
    path.write_bytes(msgspec.json.format(msgspec.json.encode(document), indent=1))


def without_version(path: Path) -> None:
    """Take out which version of Metagraph wrote an export: the shipped ones outlast it."""
    document = json.loads(path.read_bytes())
    del document["exporter"]
    path.write_bytes(msgspec.json.format(msgspec.json.encode(document), indent=1))


def main() -> None:
    touched = touching(randomised(1)), touching(randomised(2, BOTH_EYES))
    footed = standing(), stepping(), stepping("arms")
    for project in (
        with_parameters(stick()),
        varied(),
        sparse(),
        *footed,
        repeating(),
        repeating(True),
        *touched,
        *still(),
    ):
        folder = FOLDER / project.name
        shutil.rmtree(folder, ignore_errors=True)
        made = write_project_files(
            project, folder, character=_face(project, project.face.morphs) if project.face.morphs else None
        )
        without_version(made.json)
        if project.name == "varied":
            without_authors(made.json)
        chosen = None
        if project.life.on and not project.graphs["body"].actions:  # all else stands in "sparse"
            chosen = [case for case in list_cases(project) if case.name in LIVING]
        if project.name == "standing":  # all else in "stick"
            chosen = [case for case in list_cases(project) if case.name.startswith(STANDING)]
        if project.name in ("stepping", "striding"):
            chosen = [case for case in list_cases(project) if case.name.startswith("feet")]
        if project.name == "repeating":
            chosen = [*list_repeat_cases(project), *(c for c in list_cases(project) if c.name == "chatter 1")]
        if project.name == "clasping":
            chosen = [case for case in list_repeat_cases(project) if case.name.startswith("arms")]
        path = write_vectors(made.json, chosen, common=project.name == "stick")
        print(
            f"{path.parent.name}: {path.stat().st_size / 1e3:.0f} kB of vectors, "
            f"{made.glb.stat().st_size / 1e3:.0f} kB of clips"
        )


if __name__ == "__main__":
    main()
