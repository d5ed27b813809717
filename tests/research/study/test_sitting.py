"""Sittings go through their phases once, and go on where they were left, whatever happened."""

from __future__ import annotations

import os
import random
import shutil
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

from metagraph.errors import FileError
from metagraph.formats.store import read_project
from metagraph.graph import edits
from metagraph.research.study.logs.log import read_log
from metagraph.research.study.plan.task_projects import make_task_project, reopen, write_task_project
from metagraph.research.study.sitting import Sitting, SittingError, find_place_in_sitting, list_phases
from metagraph.research.study.study_plan import read_study
from tests.processes import started
from tests.thorough import many

KILLS = many(40, 100)

ROOT = Path(__file__).resolve().parents[3]


def names(study, participant: str) -> list[str]:
    return [" ".join(filter(None, (p.name, p.condition, p.task))) for p in list_phases(study, participant)]


def test_a_participant_goes_from_consent_to_thanks(tiny):
    study = read_study(tiny)
    one, other = (
        (("meta", "manual") if study.plan.blocks("P01")[0][0] == "meta" else ("manual", "meta")),
        names(study, "P01"),
    )
    expected = ["consent"]
    for condition in one:
        expected += [
            f"instructions {condition}",
            f"training {condition}",
            f"instructions {condition} nods",
            f"task {condition} nods",
        ]
        expected += [f"questionnaire {condition}"] + (["break"] if condition == one[0] else [])
    assert other == [*expected, "questionnaire", "end"]
    assert [p.index for p in list_phases(study, "P01")] == list(range(len(other)))
    assert names(study, "P02")[1] == f"instructions {one[1]}"


def test_questionnaires_come_when_they_are_about(tiny):
    text = tiny.read_text().replace(
        "[sus,", "[{id: each, when: after_task, items: [{id: a, text: b, words: true}]}, sus,"
    )
    tiny.write_text(text)
    found = [
        (p.condition, p.task, p.questionnaire.id)
        for p in list_phases(read_study(tiny), "P01")
        if p.questionnaire
    ]
    assert [f[2] for f in found] == ["each", "sus", "each", "sus", "more"]
    assert found[0][1] == "nods" and found[1][1] is None and found[4][:2] == (None, None)


def test_a_condition_that_is_come_back_to_is_trained_and_asked_about_once(tiny):
    more = (
        "order: {given: {P01: [meta/nods, manual/nods, meta/six], P02: [meta], P03: [meta], P04: [meta]}}\n"
    )
    task = "- {id: six, clips: [x.glb]}\n"
    tiny.write_text(tiny.read_text().replace("breaks: 1\n", task + more))
    found = names(read_study(tiny), "P01")
    assert found.count("training meta") == 1
    assert found.count("questionnaire meta") == 1
    assert found.index("questionnaire meta") > found.index("task meta six")


def test_a_stranger_takes_no_part(tiny):
    with pytest.raises(ValueError, match=r"'P09'.*P01, P02, P03, P04"):
        Sitting(read_study(tiny), "P09")


def test_nothing_logged_is_the_beginning(tiny):
    course = list_phases(read_study(tiny), "P01")
    assert (find_place_in_sitting(course, []).phase, find_place_in_sitting(course, []).begun) == (
        course[0],
        False,
    )


def through(sitting: Sitting, count: int) -> None:
    for _ in range(count):
        sitting.begin()
        sitting.end()


def test_it_goes_on_in_the_phase_it_was_left_in(tiny):
    study = read_study(tiny)
    first = Sitting(study, "P01")
    assert not first.resumed
    through(first, 2)
    first.begin()
    first.writer.add("view", what="layer")
    first.close()
    second = Sitting(study, "P01")
    assert second.resumed
    assert (second.phase.index, second.now.begun) == (2, True)
    second.begin()  # changes nothing: it runs
    second.end()
    second.close()
    events = read_log(study.log("P01")).events
    told = [(e["index"], e["state"]) for e in events if e["type"] == "phase"]
    assert told == [(n, state) for n in range(3) for state in ("begin", "end")]
    assert [e["type"] for e in events].count("resumed") == 1


def test_answers_are_kept_and_told_once(tiny):
    study = read_study(tiny)
    sitting = Sitting(study, "P01")
    through(sitting, next(p.index for p in sitting.course if p.questionnaire))
    sitting.begin()
    sitting.answer("sus1", 4)
    sitting.answer("sus1", 4)
    sitting.answer("sus2", 2)
    sitting.close()
    again = Sitting(study, "P01")
    assert again.now.answers == {"sus1": 4, "sus2": 2}
    again.answer("sus1", 4)
    again.close()
    assert [e["item"] for e in read_log(study.log("P01")).events if e["type"] == "answer"] == ["sus1", "sus2"]


def test_what_was_made_but_not_told_as_ended_is_ended(tiny):
    study = read_study(tiny)
    sitting = Sitting(study, "P01")
    through(sitting, 4)
    sitting.begin()
    assert sitting.phase.name == "task"
    write_task_project(make_task_project(study, sitting.phase.clips, "work"), sitting.file)
    end, sitting.end = sitting.end, lambda why: None  # as if killed in between
    sitting.keep("time")
    assert end
    sitting.close()
    again = Sitting(study, "P01")
    assert again.phase.name == "questionnaire"
    again.close()
    (run,) = read_log(study.log("P01")).tasks()
    assert run.timed_out and run.artefact == sitting.course[4].file and len(run.digest) == 64


def test_what_was_not_saved_cannot_be_kept(tiny):
    sitting = Sitting(read_study(tiny), "P01")
    through(sitting, 4)
    sitting.begin()
    with pytest.raises(FileError, match="on keeping it"):
        sitting.keep()
    sitting.close()


def test_the_end_is_told_once(tiny):
    study = read_study(tiny)
    sitting = Sitting(study, "P01")
    through(sitting, len(sitting.course))
    assert sitting.phase is None
    sitting.end()
    sitting.close()
    Sitting(study, "P01").close()
    log = read_log(study.log("P01"))
    assert log.complete and [e["type"] for e in log.events].count("end") == 1
    assert log.events[-1]["type"] == "end"


def test_the_log_of_another_course_is_refused(tiny):
    study = read_study(tiny)
    sitting = Sitting(study, "P01")
    through(sitting, 3)
    sitting.close()
    tiny.write_text(tiny.read_text().replace("consent: You take part of your own free will.\n", ""))
    with pytest.raises(SittingError, match=r"event 1 \(consent begin\)"):
        Sitting(read_study(tiny), "P01")
    tiny.write_text(tiny.read_text().replace("A tiny study", "Another title") + "consent: Other words.\n")
    Sitting(read_study(tiny), "P01").close()  # words may be corrected


def test_a_clip_that_cannot_be_read_stops_the_task_for_everybody(tiny):
    (tiny.parent / "bad.glb").write_bytes(b"glTF nonsense")
    tiny.write_text(tiny.read_text().replace("tasks:", "tasks:\n- {id: bad, clips: [bad.glb]}"))
    study = read_study(tiny)
    with pytest.raises(FileError, match=r"study\.yaml, clips: .*bad\.glb"):
        make_task_project(study, study.plan.task("bad").clips, "bad")


def test_a_task_begins_with_its_clips_and_the_references_base_and_character(tmp_path):
    folder = Path(os.path.relpath(ROOT / "sample_clips", tmp_path)).as_posix()
    (tmp_path / "study.yaml").write_text(
        "study: 1\ntitle: t\nparticipants: 1\nconditions: [meta]\ntasks:\n- id: a\n"
        f"  clips: [{folder}/clips/hands_at_sides__stance.glb, {folder}/clips/on_hips__stance.glb]\n"
        f"  reference: {folder}/sample.metagraph.yaml\n"
    )
    study = read_study(tmp_path)
    project = make_task_project(study, study.plan.task("a").clips, "a", study.reference("a"))
    assert [c.name for c in project.clips.values()] == ["hands_at_sides__stance", "on_hips__stance"]
    assert project.clips[project.base.clip].name == "hands_at_sides__stance"
    saved = write_task_project(project, tmp_path / "data" / "P01" / "a.metagraph.yaml")
    assert saved.character.endswith("ada.glb") and saved.character.startswith("..")
    opened, count = reopen(tmp_path / "data" / "P01" / "a.metagraph.yaml")
    assert count == 0 and not opened.notes
    assert all(c.motion is not None for c in opened.project.clips.values())


def test_edits_in_the_journal_are_in_the_file_once_it_was_reopened(tiny):
    from metagraph.formats.project.journal import Journal, make_journal_path

    study = read_study(tiny)
    path = study.data("P01") / "x.metagraph.yaml"
    project = write_task_project(make_task_project(study, study.plan.tasks[0].clips, "x"), path)
    journal = Journal(make_journal_path(path), path)
    journal.edit(project, edits.add_stance(project, "head", "straight"))
    journal.close()
    opened, count = reopen(path)
    assert count == 1 and [s.name for s in opened.project.graphs["head"].stances.values()] == ["straight"]
    assert read_project(path).graphs["head"].stances.keys() == opened.project.graphs["head"].stances.keys()
    assert reopen(path)[1] == 0, "a journal of an older state adds nothing"


@pytest.mark.nightly
@pytest.mark.skipif(sys.platform == "win32", reason="processes are forked and killed as Unix does")
def test_killed_at_many_moments_nothing_is_lost_and_nothing_is_there_twice(tiny):
    study = read_study(tiny)
    draw = random.Random(20260301)
    kills, seen = 0, set()
    ahead = (
        Counter()
    )  # edits that a kill came between, and the log does not have: in each phase that was begun
    for participant in study.plan.ids:
        words = [sys.executable, Path(__file__).with_name("scripted.py"), tiny, participant]
        with started(*words, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
            for _ in range(400):
                process.stdin.write(
                    f"{draw.randrange(1300) if kills < KILLS else 1e9} {draw.uniform(0, 6)}\n"
                )
                process.stdin.flush()
                told = process.stdout.readline().strip()
                if not study.log(participant).exists():
                    continue
                log = read_log(study.log(participant))
                assert not log.problems
                assert [e["n"] for e in log.events] == list(range(len(log.events)))
                marks = [(e["index"], e["state"]) for e in log.events if e["type"] == "phase"]
                assert marks == [(n // 2, ("begin", "end")[n % 2]) for n in range(len(marks))]
                now = find_place_in_sitting(list_phases(study, participant), log.events)
                if now.phase is not None and now.begun:
                    seen.add(now.phase.name)
                if told != "killed":
                    assert told == "ended 0"
                    break
                kills += 1
                if now.phase is not None and now.phase.works and now.begun and now.artefact is None:
                    begun = max(n for n, e in enumerate(log.events) if e["type"] == "phase")
                    logged = sum(e["type"] == "edit" for e in log.events[begun:])
                    copy = shutil.copytree(study.data(participant), tiny.parent / f"copy {kills}")
                    made = len(reopen(copy / now.phase.file)[0].project.graphs["arms"].stances)
                    more = made - logged - ahead[participant, begun]
                    assert more in (0, 1), "the project is as it was at the last edit"
                    ahead[participant, begun] += more
            process.stdin.close()
        log = read_log(study.log(participant))
        assert log.complete
        assert len(log.answers()) == 21
        assert [r.finished for r in log.tasks()] == [True, True]
        for run in log.tasks():
            made = read_project(study.data(participant) / run.artefact)
            assert len(made.graphs["arms"].stances) == 40
    assert kills == KILLS
    assert seen >= {"task", "training"}
