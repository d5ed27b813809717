"""`metagraph render`: what is written under the pictures of a contact sheet."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.cli import render_command
from app.cli.render_command import Shot, draw_to, load_figure
from app.project.files import SAMPLE
from app.project.opening import open_whole
from app.stage.playback_source import ShownPlayback
from metagraph.playback.planner import make_plan


@pytest.fixture(scope="module")
def project():
    """The sample, all its actions' names with one beginning that says nothing."""
    project = open_whole(SAMPLE).project
    for graph in list(project.graphs.values()):
        actions = {i: replace(a, name=f"ChrLong@Idle01_{a.name}") for i, a in graph.actions.items()}
        project = project.with_graph(replace(graph, actions=actions))
    return project


@pytest.mark.nightly
@pytest.mark.gl
def test_actions_are_called_as_their_node_calls_them(project, tmp_path, monkeypatch):
    under = []

    def contact_sheet(images, columns, labels=(), **others):
        under.extend(labels)
        return np.zeros((4, 4, 4), np.uint8)

    monkeypatch.setattr("preview.sheet.make_contact_sheet", contact_sheet)
    shown = ShownPlayback(project, make_plan(project, 10.0), 10.0)
    seen = [(load_figure(project, SAMPLE.parent), shown)]
    draw_to(tmp_path / "sheet.png", seen, Shot(10.0, (96, 72), 30, 16, "dark"))
    assert len(under) == 16 and under[0].startswith("0.00 s")
    named = [words for words in under if words.partition(" s")[2].strip()]
    assert named and not any("ChrLong" in words for words in named)


def test_where_nothing_is_played_only_the_time_is_told(project):
    plan = make_plan(project, 1.0, idle=False)
    assert render_command._doing(ShownPlayback(project, plan, 1.0), 0.5) == ""


def test_a_mode_beside_a_kept_performance_is_refused_and_not_ignored(tmp_path, capsys):
    from app.cli.parser import main

    out = str(tmp_path / "a.png")
    words = ["render", str(SAMPLE), "-o", out, "-s", "1", "--performance", "greeting", "--mode", "idle"]
    assert main(words) == 1
    assert "a saved performance has its own mode" in capsys.readouterr().err


def test_depth_of_field_needs_something_behind_the_character(tmp_path, capsys):
    from app.cli.parser import main

    words = [
        "render",
        str(SAMPLE),
        "-o",
        str(tmp_path / "a.png"),
        "-s",
        "1",
        "--transparent",
        "--depth-of-field",
    ]
    assert main(words) == 1
    assert "give --transparent or --depth-of-field" in capsys.readouterr().err


def test_a_written_performance_rests_its_hands_where_the_pictures_have_them(tmp_path):
    from app.cli.parser import main
    from metagraph.formats.bvh.file import read_bvh
    from metagraph.formats.store import save_project
    from sample_clips.make.at_a_desk import make_desk_talk

    place = tmp_path / "desk.metagraph.yaml"
    save_project(make_desk_talk(), place)
    assert main(["render", str(place), "-o", str(tmp_path / "a.bvh"), "-s", "1", "--bvh-metres"]) == 0
    clip = read_bvh(tmp_path / "a.bvh")
    _, at = clip.skeleton.globals(clip.pose_at(0.5))
    assert 0.74 < at[clip.skeleton.index("LeftHand"), 1] < 0.8
