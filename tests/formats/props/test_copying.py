"""Files of props outside the project's folder are found, and copied into it with what belongs to them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
import trimesh
from PIL import Image

from metagraph.formats.props.copying import copy_props, find_outside_props, set_prop_paths
from metagraph.formats.props.reader import list_files_beside, read_prop
from metagraph.graph.prop import Prop
from tests.conftest import Toy


@pytest.fixture
def board(tmp_path: Path) -> Path:
    """An OBJ with a material and a picture, elsewhere."""
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    Image.new("RGB", (4, 4), (200, 10, 10)).save(folder / "red.png")
    (folder / "board.mtl").write_text("newmtl a\nmap_Kd red.png\n")
    (folder / "board.obj").write_text(
        "mtllib board.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n"
    )
    return folder / "board.obj"


def test_what_is_outside_is_found(tmp_path: Path, board: Path) -> None:
    show = tmp_path / "show"
    show.mkdir()
    props = {
        "in": Prop(name="a", path="props/a.glb"),
        "up": Prop(name="b", path="../elsewhere/board.obj"),
        "far": Prop(name="c", path=str(board)),
        "round": Prop(name="d", path="props/../a.glb"),
    }
    found = find_outside_props(replace(Toy().project(), props=props), show)
    assert found == {"up": board, "far": board}


def test_a_copy_has_its_materials_and_pictures_and_is_made_once(tmp_path: Path, board: Path) -> None:
    show = tmp_path / "show"
    show.mkdir()
    assert [path.name for path in list_files_beside(board)] == ["board.mtl", "red.png"]
    paths, problems = copy_props({"a": board, "b": board}, show)
    assert paths == {"a": "props/board.obj", "b": "props/board.obj"} and not problems
    copy = read_prop(show / "props" / "board.obj")
    assert copy.materials[0].image is not None and copy.notes == ()
    assert copy_props({"a": board}, show)[0] == {"a": "props/board.obj"}, "the same file is one file"


def test_another_file_of_the_same_name_keeps_it(tmp_path: Path, board: Path) -> None:
    show = tmp_path / "show"
    (show / "props").mkdir(parents=True)
    (show / "props" / "red.png").write_bytes(b"mine")
    paths, _ = copy_props({"a": board}, show)
    assert paths == {"a": "props/board-2/board.obj"}
    assert (show / "props" / "red.png").read_bytes() == b"mine"
    assert read_prop(show / paths["a"]).materials[0].image is not None


def test_a_file_that_is_gone_is_said_and_others_are_copied(tmp_path: Path) -> None:
    box = tmp_path / "box.stl"
    box.write_bytes(trimesh.creation.box().export(file_type="stl"))
    show = tmp_path / "show"
    show.mkdir()
    paths, problems = copy_props({"a": box, "b": tmp_path / "gone.stl"}, show)
    assert paths == {"a": "props/box.stl"}
    assert len(problems) == 1 and "gone.stl" in str(problems[0])
    project = replace(Toy().project(), props={"a": Prop(name="box", path="../box.stl")})
    assert set_prop_paths(project, {**paths, "other": "x"}).props["a"].path == "props/box.stl"
