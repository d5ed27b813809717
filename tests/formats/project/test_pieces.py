"""Stances and actions go from one project's folder to another's, by file and by the clipboard."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.errors import FileError
from metagraph.formats.gltf.reader import write_glb
from metagraph.formats.project.pieces import encode_piece, is_piece, read_other_project, read_piece
from metagraph.formats.store import SUFFIX, open_project, save_project
from metagraph.graph import edits
from metagraph.graph.model import Project
from metagraph.motion.clip import Clip
from tests.projects import clip


def project_in(folder: Path, name: str, clips: tuple[str, ...]) -> Path:
    (folder / "clips").mkdir(parents=True)
    loaded = []
    for n in clips:
        write_glb(folder / "clips" / f"{n}.glb", [clip(n)])
        loaded.append((f"clips/{n}.glb", 0, "", clip(n)))
    project = edits.add_clips(Project(name), loaded)
    first, *rest = project.clips
    project = edits.add_stance(project, "arms", "rest", [first])
    (stance,) = project.graphs["arms"].stances
    save_project(edits.place_clips(project, rest, "arms", "gesture", stance), folder / f"{name}{SUFFIX}")
    return folder / f"{name}{SUFFIX}"


@pytest.fixture
def two(tmp_path: Path) -> tuple[Path, Path]:
    return (
        project_in(tmp_path / "ours", "ours", ("idle", "wave")),
        project_in(tmp_path / "theirs", "theirs", ("pose", "point")),
    )


def names(project: Project) -> set[str]:
    return {a.name for a in project.actions()}


def test_another_projects_file_is_taken_with_paths_from_here(two: tuple[Path, Path]) -> None:
    ours, theirs = two
    before = open_project(ours).project
    after = read_other_project(theirs, ours).into(before).project
    save_project(after, ours)
    again = open_project(ours)
    assert names(again.project) == {"idle", "wave", "pose", "point"} and not again.notes
    assert {e.path for e in again.project.clips.values()} >= {"../theirs/clips/point.glb", "clips/wave.glb"}
    assert len(again.project.graphs["arms"].stances) == 1, "both call it rest"


def test_what_is_copied_in_one_window_is_pasted_in_another(two: tuple[Path, Path]) -> None:
    ours, theirs = two
    source = open_project(theirs).project
    (point,) = (a.id for a in source.actions() if a.name == "point")
    text = encode_piece(source, theirs.parent, actions=[point])
    assert is_piece(text) and json.loads(text)
    taking = read_piece(text, ours).into(open_project(ours).project)
    assert names(taking.project) == {"idle", "wave", "point"}
    (entry,) = (e for e in taking.project.clips.values() if e.name == "point")
    assert entry.path == "../theirs/clips/point.glb" and entry.motion is not None


def test_a_stance_is_copied_with_all_on_it_into_an_untitled_project(
    two: tuple[Path, Path],
) -> None:
    _, theirs = two
    source = open_project(theirs).project
    text = encode_piece(source, theirs.parent, stances=list(source.graphs["arms"].stances))
    after = read_piece(text, None).into(Project()).project
    assert names(after) == {"pose", "point"}
    assert all(Path(e.path).is_absolute() and e.motion is not None for e in after.clips.values())


def test_a_clip_whose_file_is_gone_is_reported_and_comes_without_motion(two: tuple[Path, Path]) -> None:
    ours, theirs = two
    (theirs.parent / "clips" / "point.glb").unlink()
    piece = read_other_project(theirs, ours)
    assert any("point.glb' is missing" in note for note in piece.notes)
    assert "point" in names(piece.into(open_project(ours).project).project)


def test_a_project_is_not_taken_into_itself(two: tuple[Path, Path]) -> None:
    with pytest.raises(FileError, match="is the open project itself"):
        read_other_project(two[0], two[0])


@pytest.mark.parametrize(
    "text",
    [
        '{"metagraph_piece"',
        '{"metagraph_piece": 1}',
        '{"metagraph_piece": 1, "actions": 3, "project": {"metagraph": 2}}',
        '{"metagraph_piece": 1, "actions": [], "project": []}',
        '{"metagraph_piece": 1, "actions": [], "project": {"metagraph": 2, "clips": 7}}',
        '{"metagraph_piece": 1, "actions": [], "project": {"metagraph": 99}}',
    ],
)
def test_what_is_no_piece_is_refused_in_words(text: str) -> None:
    assert is_piece(text)
    with pytest.raises(FileError, match="clipboard"):
        read_piece(text, None)


def test_other_texts_are_no_pieces(two: tuple[Path, Path]) -> None:
    assert not any(map(is_piece, ("", "hello", "{}", "metagraph: 2", '[{"do": "nod"}]')))


def test_the_command_line_takes_a_project_file(two: tuple[Path, Path], capsys: Any) -> None:
    from app.cli.parser import main

    ours, theirs = two
    assert main(["import", str(ours), str(theirs)]) == 0
    said = capsys.readouterr().out
    assert "2 new actions" in said and "2 new clips" in said
    assert names(open_project(ours).project) == {"idle", "wave", "pose", "point"}


def test_the_command_line_says_what_is_left_out_and_how_to_take_it(
    two: tuple[Path, Path], capsys: Any
) -> None:
    from app.cli.parser import main
    from sample_clips.make.mannequin_skeleton import mannequin_skeleton

    ours, theirs = two
    skeleton = mannequin_skeleton()
    still = np.tile(skeleton.rest_rotations, (31, 1, 1))
    pose = Clip("pose", skeleton, 30, still, np.tile(skeleton.rest_translations[:1], (31, 1, 1)))
    write_glb(theirs.parent / "clips" / "pose.glb", [pose])
    project = edits.add_clips(Project("theirs"), [("clips/pose.glb", 0, "", pose)])
    save_project(edits.add_stance(project, "arms", "other", list(project.clips)), theirs)
    before = open_project(ours).project
    assert main(["import", str(ours), str(theirs)]) == 3
    said = capsys.readouterr()
    assert "left out: clip 'pose'" in said.err and "--retarget" in said.out
    assert len(open_project(ours).project.graphs["arms"].stances) == len(before.graphs["arms"].stances)
