"""Clips under numbers: who sees which task so, what the window is given, and what the report makes of it."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest

from metagraph.errors import FileError
from metagraph.formats.store import read_project
from metagraph.research.study.analysis.reading import collect_study
from metagraph.research.study.analysis.results import analyse_study
from metagraph.research.study.plan.hidden_names import copy_numbered, make_clip_numbers, reveal_names
from metagraph.research.study.plan.task_projects import make_task_project, write_task_project
from metagraph.research.study.report import format_study_page
from metagraph.research.study.simulation.like_study import write_like
from metagraph.research.study.simulation.people import Truth
from metagraph.research.study.sitting import Sitting, list_phases
from metagraph.research.study.study_plan import Study, read_study
from sample_clips.make.study import FOLDER

STUDY = read_study(FOLDER)


@pytest.mark.parametrize(("people", "together"), [(4, 1), (8, 2), (16, 3)])
def test_names_are_crossed_with_the_order_of_conditions_and_of_tasks(people: int, together: int) -> None:
    rows = []
    for who in STUDY.plan.ids[:people]:
        (condition, tasks), _ = STUDY.blocks(who)
        assert {STUDY.hides(who, t) for t in tasks} == {True, False}, "everybody has both"
        rows.append((condition, tasks[0], next(t for t in tasks if STUDY.hides(who, t))))
    for a, b in ((0, 1), (0, 2), (1, 2)):
        counts = Counter((r[a], r[b]) for r in rows)
        assert len(counts) == 4 and len(set(counts.values())) == 1
    if together > 1:
        assert len(Counter(rows)) == 8


def test_both_conditions_of_a_task_have_numbers_and_the_sitting_says_so() -> None:
    tasks = [p for p in list_phases(STUDY, "P01") if p.name == "task"]
    found = {(p.condition, p.task): p.names for p in tasks}
    assert found["meta", "ten"] == found["manual", "ten"] != found["meta", "twenty"]
    assert all(p.fields["names"] == p.names for p in tasks)
    assert {p.names: STUDY.plan.hidden in p.text for p in tasks} == {"hidden": True, "shown": False}


def test_numbers_differ_between_conditions_and_people_and_are_the_same_each_time() -> None:
    one = STUDY.make_clip_numbers("P01", "meta", "ten")
    assert list(one) == [f"{n:02d}.glb" for n in range(1, 11)]
    assert one == STUDY.make_clip_numbers("P01", "meta", "ten")
    assert list(one.values()) != list(STUDY.make_clip_numbers("P01", "manual", "ten").values())
    assert list(one.values()) != list(STUDY.make_clip_numbers("P02", "meta", "ten").values())
    with pytest.raises(FileError, match="may need other files"):
        make_clip_numbers([Path("a.gltf")], "P01", "meta", "ten")


def numbered_work(study: Study, folder: Path) -> tuple[Path, dict[str, Path]]:
    found = study.make_clip_numbers("P01", "meta", "ten")
    copies = copy_numbered(found, folder / "clips")
    numbered = dict(zip(copies, found.values(), strict=True))
    clips = study.plan.task("ten").clips
    project = make_task_project(study, clips, "Ten", study.reference("ten"), numbered)
    write_task_project(project, folder / "work.metagraph.yaml")
    return folder / "work.metagraph.yaml", found


def test_nothing_that_is_worked_on_has_a_clips_own_name(tmp_path: Path) -> None:
    path, found = numbered_work(STUDY, tmp_path)
    text = path.read_text(encoding="utf-8")
    assert not [p.stem for p in found.values() if p.stem in text]
    project = read_project(path)
    assert sorted(c.name for c in project.clips.values()) == [f"Clip {n:02d}" for n in range(1, 11)]
    right = read_project(STUDY.reference("ten"))
    base = reveal_names(project, found).clips[project.base.clip]
    assert base.name == right.clips[right.base.clip].name, "the base pose is the reference's"


def test_what_was_made_of_numbers_is_scored_as_if_it_had_names(tmp_path: Path) -> None:
    (tmp_path / "clips").symlink_to(FOLDER.parent / "clips")
    (tmp_path / "mannequin.glb").symlink_to(FOLDER.parent / "mannequin.glb")
    study_folder = tmp_path / "study"
    study_folder.mkdir()
    for file in FOLDER.iterdir():
        if file.is_file():
            (study_folder / file.name).write_bytes(file.read_bytes())
    text = (study_folder / "study.yaml").read_text().replace("names: both", "names: hidden")
    (study_folder / "study.yaml").write_text(text)
    study = read_study(study_folder)
    sitting = Sitting(study, "P01")
    while (phase := sitting.phase) is not None and phase.name != "task":
        sitting.begin()
        sitting.end()
    assert phase is not None and phase.names == "hidden"
    found = study.make_clip_numbers("P01", phase.condition or "", phase.task or "")
    copies = {p.name: c for p, c in zip(found.values(), copy_numbered(found, tmp_path / "x"), strict=True)}
    right = read_project(study.reference(phase.task))
    clips = {
        i: replace(c, path=copies[Path(c.path).name].as_posix(), name=copies[Path(c.path).name].stem)
        for i, c in right.clips.items()
    }
    character = (study_folder / right.character).resolve().as_posix()
    sitting.begin()
    write_task_project(replace(right, clips=clips, character=character), sitting.file)
    sitting.writer.add("edit", what="place", words="Place", clips=[])
    sitting.keep()
    sitting.close()
    (row,) = collect_study(study_folder, jumps=False).rows
    assert row.run.names == "hidden"
    if phase.condition == "meta":
        assert row.correct
    else:
        assert row.score is not None and not row.score.count("unwanted")


@pytest.mark.nightly
def test_a_report_says_how_clips_were_called_and_finds_what_was_planted(tmp_path: Path) -> None:
    made = write_like(STUDY, tmp_path / "made", Truth(ratio=2.0, spread=0.1, hidden=(1.0, 2.0)))
    found = analyse_study(collect_study(made.folder, jumps=False))
    assert found.names_ratio is not None and found.names_ratio.holds(2.0)
    assert found.by_names["shown"].holds(2.0) and found.by_names["hidden"].holds(4.0)
    page = format_study_page(found)
    assert "clips had numbers instead of names" in page and "ratio with numbers over ratio with names" in page
