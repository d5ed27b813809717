"""A performance is written by a process of its own, told as it goes, and leaves nothing when it is
cancelled.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from app.project.jobs import WindowJob
from app.stage.render_process import RenderOrder, write_rendering
from metagraph.formats.bvh.file import read_bvh
from metagraph.formats.store import open_project
from metagraph.graph import requests as a
from metagraph.graph.editing import performances as performance_edits

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="module")
def talk():
    """The sample project with a performance of two seconds kept in it."""
    project = open_project(ROOT / "sample_clips" / "sample.metagraph.yaml").project
    kept = a.Performance(name="talk", length=2.0, asks=(a.Play(action="shrug_bt_01", at=0.2, priority=2),))
    return performance_edits.add_performance(project, kept)


@pytest.mark.nightly
@pytest.mark.gl
def test_a_video_is_written_and_its_progress_told(qapp, talk, tmp_path):
    project, ident = talk
    job, told = WindowJob("x", lambda job: None), []
    job.progress.connect(lambda done, total, words: told.append((done, total)))
    folder = tmp_path / "out"
    folder.mkdir()
    order = RenderOrder(folder / "a.mp4", ident, 0.5, (320, 180), 10)
    out = write_rendering(project, ROOT / "sample_clips", order, job)
    assert out.stat().st_size > 1000
    qapp.processEvents()
    assert told[-1] == (5, 5)
    assert [p.name for p in folder.iterdir()] == ["a.mp4"]


@pytest.mark.nightly
def test_a_range_of_it_is_what_the_whole_has_there(qapp, talk, tmp_path):
    project, ident = talk
    for name, seconds, start in (("all", 2.0, 0.0), ("range", 0.5, 1.0)):
        order = RenderOrder(tmp_path / f"{name}.bvh", ident, seconds, start=start)
        write_rendering(project, ROOT / "sample_clips", order, WindowJob("x", lambda job: None))
    whole, part = (read_bvh(tmp_path / f"{name}.bvh") for name in ("all", "range"))
    assert part.frames == 16
    assert abs(abs((whole.rotations[30:46] * part.rotations).sum(-1)) - 1).max() < 1e-4


@pytest.mark.nightly
def test_motion_is_the_performance(qapp, talk, tmp_path):
    from metagraph.playback.planning.running_plan import plan_performance
    from tests.posing import pose_at

    project, ident = talk
    write_rendering(
        project,
        ROOT / "sample_clips",
        RenderOrder(tmp_path / "a.bvh", ident, 1.0),
        WindowJob("x", lambda job: None),
    )
    clip = read_bvh(tmp_path / "a.bvh")
    assert clip.frames == 31
    kept = project.performances[ident]
    there = pose_at(plan_performance(project, kept.asks, 1.0), project, 0.7)
    arm = project.skeleton.index("RightUpperArm") if "RightUpperArm" in project.skeleton.names else 10
    name = project.skeleton.names[arm]
    mine = clip.rotations[21, clip.skeleton.index(name)]
    assert abs(float((mine * there.rotations[arm]).sum())) == pytest.approx(1.0, abs=1e-3)


@pytest.mark.nightly
def test_a_place_that_cannot_be_written_is_said(qapp, talk, tmp_path):
    project, ident = talk
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(RuntimeError, match="file"):
        write_rendering(
            project,
            ROOT / "sample_clips",
            RenderOrder(tmp_path / "file" / "a.bvh", ident, 0.5),
            WindowJob("x", lambda job: None),
        )


def test_a_cancelled_job_leaves_nothing(qapp, talk, tmp_path):
    project, ident = talk
    job = WindowJob("x", lambda job: None)
    job.cancel()
    write_rendering(project, ROOT / "sample_clips", RenderOrder(tmp_path / "a.mp4", ident, 60.0), job)
    # data is where the program keeps its own: a window of an earlier test may make it while this one waits.
    assert {p.name for p in tmp_path.iterdir()} <= {"data"}
