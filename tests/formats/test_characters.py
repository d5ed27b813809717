"""Which of the imported files a character is drawn from, and what of it is hidden at first."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from app.project.files import SAMPLE
from metagraph.formats.characters import CharacterFile, find_held_meshes
from metagraph.formats.gltf.reader import read_character
from metagraph.formats.gltf.writer import write_glb
from metagraph.formats.import_words import describe_imported
from metagraph.formats.imports import import_files
from metagraph.graph.model import Project
from metagraph.motion.character_mesh import CharacterMesh, Surface
from tests.bodies import body, column, everywhere
from tests.projects import SKELETON, clip


def proxy(character: CharacterMesh) -> CharacterMesh:
    """The character's first triangle, as exporters leave one."""
    return replace(character, triangles=character.triangles[:1], surfaces=(Surface(0, 1, 0),))


def whole() -> CharacterMesh:
    return body(SKELETON, dict.fromkeys(range(len(SKELETON)), 0.12))


def test_a_stand_in_is_passed_over_for_the_character_behind_it(tmp_path: Path) -> None:
    write_glb(tmp_path / "a.glb", [clip("a")], proxy(whole()))
    write_glb(tmp_path / "b.glb", [clip("b")], whole())
    result = import_files(Project(), tmp_path, [tmp_path])
    assert result.character is not None and result.character.path == "b.glb"
    assert result.into(Project()).character == "b.glb"


def test_stand_ins_alone_give_no_character_and_say_why(tmp_path: Path) -> None:
    for name in ("a", "b"):
        write_glb(tmp_path / f"{name}.glb", [clip(name)], proxy(whole()))
    result = import_files(Project(), tmp_path, [tmp_path])
    assert result.character is None and result.into(Project()).character is None
    assert [(s.path, s.why_not) for s in result.stand_ins] == [
        ("a.glb", "is 1 triangle, a stand-in"),
        ("b.glb", "is 1 triangle, a stand-in"),
    ]


def test_a_file_without_motion_is_the_character_of_the_clips_beside_it(tmp_path: Path) -> None:
    write_glb(tmp_path / "a.glb", [clip("a")], proxy(whole()))
    write_glb(tmp_path / "body.glb", [], whole())
    result = import_files(Project(), tmp_path, [tmp_path])
    assert result.character is not None and result.character.path == "body.glb"
    assert result.failures == (), "it was of use"


def test_a_vrm_file_says_which_joint_has_which_role_where_names_and_shape_do_not(tmp_path: Path) -> None:
    joint = SKELETON.names[1]
    stated = CharacterFile("me.vrm", roles={"chest": joint, "jaw": "nowhere"})
    project = stated.into(Project(skeleton=SKELETON))
    assert project.roles == {"chest": joint}
    corrected = stated.into(Project(skeleton=SKELETON, roles={"chest": SKELETON.names[0]}))
    assert corrected.roles == {"chest": SKELETON.names[0]}, "what the user said counts"


def test_a_file_without_motion_of_somebody_else_stays_a_failure(tmp_path: Path) -> None:
    write_glb(tmp_path / "a.glb", [clip("a")])
    write_glb(tmp_path / "body.glb", [], everywhere(column()))
    result = import_files(Project(), tmp_path, [tmp_path])
    assert result.character is None and len(result.failures) == 1


def test_a_project_with_a_character_keeps_it_and_looks_at_no_other(tmp_path: Path) -> None:
    write_glb(tmp_path / "a.glb", [clip("a")], whole())
    result = import_files(Project(character="mine.glb"), tmp_path, [tmp_path])
    assert result.character is None and result.into(Project(character="mine.glb")).character == "mine.glb"


@pytest.fixture
def rogue(shared_data: Path) -> CharacterMesh:
    return read_character(shared_data / "kaykit-rogue/Rogue.glb")


def test_weapons_that_one_hand_cannot_all_hold_are_hidden_and_that_is_told(
    shared_data: Path, tmp_path: Path
) -> None:
    shutil.copy(shared_data / "kaykit-rogue/Rogue.glb", tmp_path / "Rogue.glb")
    result = import_files(Project(), tmp_path, [tmp_path])
    project = result.into(Project())
    assert set(project.hidden) == {"Knife_Offhand", "1H_Crossbow", "2H_Crossbow", "Knife", "Throwable"}
    assert any("5 meshes" in note for note in result.notes)


def test_what_one_hand_holds_alone_stays_in_sight(rogue: CharacterMesh) -> None:
    one = rogue.without({"1H_Crossbow", "2H_Crossbow", "Knife"})
    assert find_held_meshes(one) == ()


def test_what_hangs_elsewhere_than_in_a_hand_stays_in_sight(rogue: CharacterMesh) -> None:
    assert "Rogue_Cape" not in find_held_meshes(rogue)
    chest = rogue.skeleton.index("chest")
    worn = tuple(replace(s, held=chest) if s.held >= 0 else s for s in rogue.surfaces)
    assert find_held_meshes(replace(rogue, surfaces=worn)) == ()


def test_a_robots_hand_of_plates_is_no_prop(shared_data: Path) -> None:
    robot = read_character(shared_data / "robot-expressive/RobotExpressive.glb")
    assert find_held_meshes(robot) == ()


def test_a_body_made_of_nothing_but_plates_holds_nothing() -> None:
    assert find_held_meshes(whole()) == ()


def test_a_character_given_by_itself_takes_the_place_of_the_projects_own(tmp_path: Path) -> None:
    shutil.copy(SAMPLE.parent / "ben.glb", tmp_path / "me.glb")
    own = read_character(tmp_path / "me.glb").skeleton
    skeleton = replace(own, names=tuple(f"rig:{name}" for name in own.names))
    project = Project(skeleton=skeleton, character="mine.glb")
    result = import_files(project, tmp_path, [tmp_path / "me.glb"])
    assert result.failures == () and result.chosen
    assert result.into(project).character == "me.glb"
    assert describe_imported(result) == "Drawn with me.glb from now on"
    write_glb(tmp_path / "a.glb", [clip("a")])
    beside = import_files(project, tmp_path, [tmp_path])
    assert not beside.chosen and beside.into(project).character == "mine.glb"


def test_a_mesh_given_by_itself_that_is_nobodys_stays_a_failure(tmp_path: Path) -> None:
    write_glb(tmp_path / "me.glb", [], proxy(whole()))
    result = import_files(Project(skeleton=SKELETON), tmp_path, [tmp_path / "me.glb"])
    assert not result.chosen and len(result.failures) == 1
