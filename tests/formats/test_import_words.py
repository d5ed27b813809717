"""One line on an import, and many notes as one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from metagraph.formats.characters import CharacterFile
from metagraph.formats.gltf.writer import write_glb
from metagraph.formats.import_words import count_alike, describe_import, list_remedies
from metagraph.formats.imports import Imported, import_files
from metagraph.graph.model import Project
from metagraph.motion.clip import Repair
from tests.projects import clip


def loaded(*repairs: Repair) -> Imported:
    return Imported((("a.glb", 0, "", replace(clip("a"), repairs=repairs)),))


def test_a_whole_import_says_how_many_came_in() -> None:
    assert describe_import(loaded()) == "Imported 1 clip"
    assert describe_import(Imported(())) == "Imported 0 clips"


def test_what_was_put_right_is_counted_each_skipped_take_once_and_names_not() -> None:
    repairs = (Repair("unit", "…"), Repair("name", "…"), Repair("up_axis", "…", made=False))
    take = Repair("one_frame", "…", take=1)
    one = replace(clip("a"), repairs=(*repairs, take))
    two = replace(clip("b"), repairs=(take,))
    result = Imported((("a.glb", 0, "", one), ("a.glb", 2, "", two)))
    words = describe_import(result)
    assert "2 clips" in words and "units of length (1)" in words and "one frame (1)" in words
    assert words.count("(1)") == 2


def test_no_character_and_hidden_meshes_are_told() -> None:
    none = CharacterFile("idle.glb", why_not="is 1 triangle, a stand-in")
    words = describe_import(replace(loaded(), stand_ins=(none, none)), window=False)
    assert "idle.glb and 1 more" in words and none.why_not in words
    hidden = CharacterFile("me.glb", hidden=("sword", "bow"))
    assert "2 meshes" in describe_import(replace(loaded(), character=hidden))


def test_strangers_are_told_once_not_as_files_that_cannot_be_used_too(tmp_path: Path) -> None:
    from tests.formats.test_imports import stranger

    write_glb(tmp_path / "a.glb", [clip("a")])
    write_glb(tmp_path / "b.glb", [clip("b")])
    write_glb(tmp_path / "odd.glb", [stranger("x")])
    (tmp_path / "bad.glb").write_bytes(b"noise")
    result = import_files(Project(), tmp_path, [tmp_path])
    words = describe_import(result, window=False)
    assert all(
        piece in words for piece in ("2 clips.", "1 clip with another", "1 unusable file", "of 1 clip in")
    )
    assert [r.do for r in list_remedies(result)] == ["map"]


@pytest.mark.parametrize(
    ("lines", "wanted"),
    [
        ([], []),
        (["one.bvh: empty"], ["one.bvh: empty"]),
        (["a: x", "a: x"], ["a and 1 more: x"]),
        (
            ["a.glb: scale of 8 joints", "b.glb: scale of 1 joints", "c.glb: other"],
            ["a.glb and 1 more: scale of 1 to 8 joints", "c.glb: other"],
        ),
        (["a: 'x' lost 2", "b: 'y' lost 10"], ["a and 1 more: 'x' lost 2 to 10"]),
        (["no subject", "no subject"], ["no subject"]),
        (["no subject 1", "no subject 2"], ["no subject 1", "no subject 2"]),
    ],
)
def test_lines_that_say_the_same_of_several_files_are_one(lines: list[str], wanted: list[str]) -> None:
    assert count_alike(lines) == wanted


@pytest.mark.nightly
def test_the_notes_of_a_real_set_are_few(shared_data: Path) -> None:
    result = import_files(Project(), None, [shared_data / "sumerian-hosts/glTF/animations/adult_female"])
    lines = count_alike(result.notes)
    assert len(result.notes) > 5 and len(lines) == 2
    assert any("1 to 15 joints" in line for line in lines)
