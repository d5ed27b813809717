"""Props are added, changed and removed; what cannot be is refused in words."""

from __future__ import annotations

from pathlib import Path

import msgspec
import numpy as np
import pytest

from metagraph.formats.project.merging import merge_projects
from metagraph.formats.project.paths import list_project_files, make_paths_absolute, move_project
from metagraph.formats.store import open_project, read_project, save_project
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing.differences import describe_differences
from metagraph.graph.editing.props import MOST, add_prop, find_grip, remove_prop, set_prop
from metagraph.graph.prop import Prop, make_turn
from metagraph.motion import rotation
from metagraph.motion.joint_map import find_known_roles
from tests.conftest import Toy

SAMPLE = Path(__file__).resolve().parents[3] / "sample_clips" / "sample.metagraph.yaml"

CUP = Prop(name="cup", path="props/cup.glb", at=(0.25, 0.75, 0.5), turn=(0, 30, 0), scale=1.5)


def test_a_prop_is_added_changed_and_removed() -> None:
    project, ident = add_prop(Toy().project(), CUP)
    assert project.props == {ident: CUP} and project.has(ident)
    moved = set_prop(project, ident, msgspec.structs.replace(CUP, at=(1, 0, 0)))
    assert moved.props[ident].at == (1, 0, 0) and project.props[ident] == CUP
    assert remove_prop(moved, ident).props == {}


def test_the_same_file_twice_is_two_props() -> None:
    project, first = add_prop(Toy().project(), CUP)
    project, second = add_prop(project, CUP)
    assert first != second and len(project.props) == 2


def test_what_cannot_be_done_is_refused_in_words() -> None:
    project, ident = add_prop(Toy().project(), CUP)
    with pytest.raises(EditError, match="no joint 'Tail'"):
        set_prop(project, ident, msgspec.structs.replace(CUP, joint="Tail"))
    with pytest.raises(EditError, match="no longer"):
        set_prop(project, "o1", CUP)
    for _ in range(MOST - 1):
        project, _ = add_prop(project, CUP)
    with pytest.raises(EditError, match="at most 100"):
        add_prop(project, CUP)


def test_what_a_joint_without_fingers_carries_is_in_the_middle_of_what_is_below_it() -> None:
    project = Toy().project()
    skeleton = project.skeleton
    assert skeleton is not None
    parent = next(n for n in range(len(skeleton)) if skeleton.children[n])
    middle = np.mean([skeleton.rest_translations[c] for c in skeleton.children[parent]], axis=0)
    np.testing.assert_allclose(find_grip(project, skeleton.names[parent])[0], middle, atol=1e-4)
    leaf = next(n for n in range(len(skeleton)) if not skeleton.children[n])
    assert find_grip(project, skeleton.names[leaf]) == ((0, 0, 0), (0, 0, 0)) == find_grip(project, "nobody")


@pytest.mark.parametrize("side", ["right", "left"])
def test_a_hand_holds_a_prop_in_its_palm_upright_towards_its_thumb(side: str) -> None:
    """Of Ada, whose palms face down or to the body at rest."""
    project = open_project(SAMPLE).project
    skeleton = project.skeleton
    assert skeleton is not None
    joint = skeleton.names.index(f"{side.title()}Hand")
    at, turn = find_grip(project, skeleton.names[joint])
    turns, places = skeleton.globals(skeleton.rest)
    where = places[joint] + rotation.rotate_vectors(turns[joint], np.array(at))
    held = rotation.multiply(turns[joint], np.array(make_turn(Prop(name="", path="", turn=turn))))
    up = rotation.rotate_vectors(held, np.array([0.0, 1, 0]))
    roles = find_known_roles(skeleton, None)
    knuckles = [places[roles[f"{side}_{finger}_1"]] for finger in ("index", "little")]
    across = (knuckles[0] - knuckles[1]) / np.linalg.norm(knuckles[0] - knuckles[1])
    assert float(up @ across) > 0.99
    out = where - places[joint]
    out -= across * float(out @ across)
    along = (knuckles[0] + knuckles[1]) / 2 - places[joint]
    palm = np.cross(across, along) * (1 if side == "right" else -1)
    assert float(out @ palm) > 0 and palm[1] < 0, "the palm's side, which is below in a T-pose"
    tip = places[roles[f"{side}_middle_3"]]
    assert np.linalg.norm(where - tip) < 0.14


def test_props_are_saved_moved_and_read(tmp_path: Path) -> None:
    project, ident = add_prop(Toy().project(), CUP)
    there, here = tmp_path / "a" / "p.metagraph.yaml", tmp_path / "p.metagraph.yaml"
    there.parent.mkdir()
    save_project(move_project(project, here, there), there)
    read = read_project(there)
    assert read.props[ident].path == "../props/cup.glb" and read.props[ident].at == CUP.at
    assert there.parent / "../props/cup.glb" in list_project_files(read, there.parent)
    whole = make_paths_absolute(read, there.parent)
    assert whole.props[ident].path == (tmp_path / "props" / "cup.glb").resolve().as_posix()


def test_opening_a_project_says_which_props_have_no_file(tmp_path: Path) -> None:
    project, _ = add_prop(Toy().project(), CUP)
    path = tmp_path / "p.metagraph.yaml"
    save_project(project, path)
    assert any("'cup' is not drawn" in note and "props/cup.glb" in note for note in open_project(path).notes)
    (tmp_path / "props").mkdir()
    (tmp_path / "props" / "cup.glb").write_bytes(b"x")
    assert not any("cup" in note for note in open_project(path).notes)


def test_two_peoples_props_are_merged() -> None:
    base = Toy().project()
    ours, mine = add_prop(base, CUP)
    theirs, other = add_prop(base, Prop(name="desk", path="desk.obj"))
    merged = merge_projects(base, ours, theirs)
    assert set(merged.project.props) == {mine, other} and merged.kept == ()


def test_the_history_says_what_was_done_to_a_prop() -> None:
    before, ident = add_prop(Toy().project(), CUP)
    after = set_prop(before, ident, msgspec.structs.replace(CUP, scale=2.0))
    (line,) = describe_differences(before, after)
    assert "cup" in line and "Prop" in line and "2" in line
