"""Props are in exported GLBs: beside the character, or below the joint that carries them."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
import trimesh

from metagraph.engines.targets.registry import write_for_target
from metagraph.engines.targets.target import Contents, TargetReport
from metagraph.formats.gltf.reader import read_character, read_gltf_clips
from metagraph.graph.editing.props import add_prop, set_prop
from metagraph.graph.model import Project
from metagraph.graph.prop import Prop
from tests.conftest import Toy


@pytest.fixture
def room(tmp_path: Path) -> Project:
    scene = trimesh.Scene(trimesh.creation.box((1, 0.7, 0.5)))
    (tmp_path / "desk.glb").write_bytes(scene.export(file_type="glb"))
    project = Toy().project()
    assert project.skeleton is not None
    project, _ = add_prop(project, Prop(name="desk", path="desk.glb", at=(0, 0.35, 1), turn=(0, 90, 0)))
    joint = project.skeleton.names[2]
    project, _ = add_prop(project, Prop(name="small desk", path="desk.glb", scale=0.1, joint=joint))
    project, _ = add_prop(project, Prop(name="gone", path="gone.obj"))
    return project


def write(project: Project, folder: Path, target: str) -> TargetReport:
    return write_for_target(project, target, folder / "out", Contents(base=folder))


def read_document(path: Path) -> dict[str, Any]:
    data = path.read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)
    found: dict[str, Any] = json.loads(data[20 : 20 + length])
    return found


@pytest.mark.parametrize("target", ["metagraph", "godot-tree"])
def test_props_are_nodes_of_the_glb(room: Project, tmp_path: Path, target: str) -> None:
    report = write(room, tmp_path, target)
    (glb,) = (path for path in report.files if path.suffix == ".glb")
    document = read_document(glb)
    nodes = document["nodes"]
    by_name = {node["name"]: n for n, node in enumerate(nodes)}
    assert by_name["desk"] in document["scenes"][0]["nodes"]
    assert nodes[by_name["desk"]]["translation"] == [0, 0.35, 1]
    np.testing.assert_allclose(nodes[by_name["desk"]]["rotation"], (0, 0.5**0.5, 0, 0.5**0.5), atol=1e-9)
    carried = nodes[by_name["small desk"]]
    assert by_name["small desk"] in nodes[2]["children"] and carried["scale"] == [0.1] * 3
    assert carried["mesh"] == nodes[by_name["desk"]]["mesh"], "props of one file share its mesh"
    assert any("gone.obj" in words for words in report.warnings)
    assert len(read_gltf_clips(glb)[0].skeleton) == len(room.skeleton)  # type: ignore[arg-type]
    loaded = trimesh.load_scene(glb)
    assert len([name for name in loaded.graph.nodes_geometry if "desk" in name]) == 2


def test_a_file_that_was_exported_is_read_again_without_its_props(room: Project, tmp_path: Path) -> None:
    from metagraph.errors import FileError

    report = write(room, tmp_path, "metagraph")
    (glb,) = (path for path in report.files if path.suffix == ".glb")
    with pytest.raises(FileError):  # the toy has no mesh, and props are none of its
        read_character(glb)


def test_a_target_without_props_says_that_they_are_left_out(room: Project, tmp_path: Path) -> None:
    report = write(room, tmp_path, "bml")
    assert any(words == "3 props are left out" for words in report.losses)


def test_a_prop_that_nothing_carries_is_left_out_with_a_word(room: Project, tmp_path: Path) -> None:
    odd, _ = add_prop(room, Prop(name="tail ring", path="desk.glb", joint="Tail"))
    report = write(odd, tmp_path, "metagraph")
    assert any("'tail ring' is left out" in words and "'Tail'" in words for words in report.warnings)


def test_an_export_says_that_hands_do_not_rest_on_what_stands_near(room: Project, tmp_path: Path) -> None:
    def say(project: Project) -> bool:
        return any("hands do not rest" in words for words in write(project, tmp_path, "metagraph").warnings)

    far = next(ident for ident, prop in room.props.items() if prop.name == "desk")
    assert say(set_prop(room, far, msgspec.structs.replace(room.props[far], at=(0, 0.35, 0.3))))
    assert not say(set_prop(room, far, msgspec.structs.replace(room.props[far], at=(0, 0.35, 9))))
