"""Which sound belongs to a motion: the plan, and whether its analysis finds what was planted."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from app.cli.parser import main
from metagraph.formats.clips import read_clips
from metagraph.research.study.perceive.mismatched import (
    list_mismatched_systems,
    list_stretches,
    make_mismatched_plan,
)
from metagraph.research.study.perceive.perceive_analysis import analyse_answers
from metagraph.research.study.perceive.perceive_data import collect_answers
from metagraph.research.study.perceive.perceive_plan import parse_perceive_plan, read_perceive_plan
from metagraph.research.study.perceive.perceive_report import (
    format_perceive_page,
    perceive_tables,
    summarise_perceive,
)
from metagraph.research.study.perceive.simulated import Raters, write_simulated
from tests.thorough import many

pytestmark = pytest.mark.usefixtures("quick_codes")
SAMPLE = Path(__file__).resolve().parents[4] / "sample_clips" / "sample.metagraph.yaml"
SYSTEMS = {name: {"conversation": "Office"} for name in ("planner", "graph", "model", "recorded")}
PLANTED = {"planner": 0.0, "graph": 0.5, "model": 1.0, "recorded": 1.6}  # log odds of choosing the own sound


def test_stretches_do_not_overlap_and_lie_within() -> None:
    found = list_stretches(30.0, 4.0, 12)
    assert len(found) == 7 and found[-1][0] + 4 <= 30
    assert all(b[0] >= a[0] + a[1] for a, b in pairwise(found))
    assert len(list_stretches(30.0, 4.0, 3)) == 3
    with pytest.raises(ValueError, match="no 2 stretches of 20 s"):
        list_stretches(30.0, 20.0, 12)


def test_a_plan_shows_each_motion_with_both_sounds_one_after_the_other() -> None:
    plan = parse_perceive_plan(make_mismatched_plan("T", 8, SYSTEMS, list_stretches(60, 5, 10), "p.yaml"))
    assert plan.pairs == tuple((f"{s}-own", f"{s}-other") for s in SYSTEMS)
    assert plan.choice is not None and plan.choice.present == "after"
    for name in SYSTEMS:
        own, other = plan.conditions[f"{name}-own"], plan.conditions[f"{name}-other"]
        assert (own.sound, other.sound) == ("own", "mismatched")
        assert own.face == other.face == "still" and own.conversation == other.conversation
    with pytest.raises(ValueError, match="no system"):
        make_mismatched_plan("T", 8, {}, [(0, 1), (1, 1)])


def test_the_command_writes_it_for_planner_recorded_motion_and_files(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["study", "perceive", "mismatched", str(tmp_path / "perceive.yaml"), "--project", str(SAMPLE)]
    words += ["--conversation", "Office", "--recorded", "--seconds", "4"]
    assert main([*words, "--motion", "model=a.bvh"]) == 1
    assert "a file for each of the 2 sides" in capsys.readouterr().err
    more = ["--motion", f"graph={tmp_path}/a.bvh,{tmp_path}/b.bvh", "--motion", "model=c.bvh,d.bvh"]
    assert main([*words, *more]) == 0
    plan = read_perceive_plan(tmp_path)
    assert [a.removesuffix("-own") for a, _ in plan.pairs] == ["planner", "recorded", "graph", "model"]
    assert plan.conditions["graph-own"].motion == ("a.bvh", "b.bvh")
    assert len(plan.items) == 8
    assert main([*words[:-5], "--conversation", "Nowhere"]) == 1
    assert "no conversation 'Nowhere'" in capsys.readouterr().err


def test_a_graph_and_a_model_that_are_not_there_are_told_before_anything_is_made(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["study", "perceive", "mismatched", str(tmp_path / "perceive.yaml"), "--project", str(SAMPLE)]
    words += ["--conversation", "Office", "--seconds", "4"]
    for asked, told in (
        (["--graph", "graph"], "as NAME=PATH, not 'graph'"),
        (["--graph", "planner=x"], "take another name"),
        (["--model", "own=nowhere.mgmodel"], "does not exist"),
        (["--graph", "a=.", "--model", "a=."], "take another name"),
    ):
        assert main([*words, *asked]) == 1
        assert told in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


@pytest.mark.nightly
def test_one_command_makes_the_motion_of_a_graph_and_of_a_model(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    takes = tmp_path / "takes"
    assert main(["generate", "planted", "-o", str(takes), "--count", "2", "-s", "60"]) == 0
    words = ["study", "perceive", "mismatched", str(tmp_path / "perceive.yaml"), "--project", str(SAMPLE)]
    words += ["--conversation", "Office", "--seconds", "4", "--graph", f"graph={takes}"]
    model = SAMPLE.parent / "models" / "own.mgmodel"
    assert main([*words, "--model", f"own={model}", "--json"]) == 0
    plan = read_perceive_plan(tmp_path)
    assert [*list_mismatched_systems(plan)] == ["planner", "graph", "own"]
    for name in ("graph", "own"):
        files = plan.conditions[f"{name}-own"].motion
        assert files == (f"motion/{name}_1.glb", f"motion/{name}_2.glb")
        clips = [read_clips(tmp_path / file)[0] for file in files]
        assert all(abs(clip.duration - 32.07) < 0.1 for clip in clips)
        assert not np.allclose(clips[0].rotations[:500], clips[1].rotations[:500])
    capsys.readouterr()


def test_systems_are_compared_with_each_other_and_told_in_the_report(tmp_path: Path) -> None:
    words = make_mismatched_plan("T", 24, SYSTEMS, list_stretches(96, 8, 12), "p.yaml")
    raters = Raters({"recorded-own": 2.0}, lapses=0, seed=3)
    study = write_simulated(tmp_path, parse_perceive_plan(words), words.encode(), "s", raters)
    results = analyse_answers(collect_answers(study))
    found = {s.systems: s for s in results.systems}
    assert len(found) == 6 and next(iter(found)) == ("planner", "graph")
    assert {s.better for pair, s in found.items() if "recorded" in pair} == {"recorded"}
    assert {s.better for pair, s in found.items() if "recorded" not in pair} == {None}
    assert found["planner", "recorded"].difference.holds(-2.0)
    said = summarise_perceive(results)
    assert any(line.startswith("recorded's motion goes with its sound more visibly than") for line in said)
    page = format_perceive_page(results)
    assert "Systems beside each other" in page and "planner less recorded" in page
    columns, rows = perceive_tables(results)["systems.csv"]
    assert columns[0] == "first" and len(rows) == 6


def test_a_plan_of_other_questions_has_no_systems() -> None:
    text = make_mismatched_plan("T", 8, SYSTEMS, list_stretches(60, 5, 10), "p.yaml")
    plan = parse_perceive_plan(text.replace("sound: mismatched", "sound: none"))
    assert list_mismatched_systems(plan) == {}


@pytest.mark.nightly
def test_its_analysis_finds_what_was_planted_and_nothing_where_nothing_was(tmp_path: Path) -> None:
    words = make_mismatched_plan("T", 24, SYSTEMS, list_stretches(96, 8, 12), "p.yaml")
    studies, held, chance, found = many(8, 40), 0, 0, 0
    for seed in range(studies):
        liked = {f"{name}-own": value for name, value in PLANTED.items()}
        raters = Raters(liked, lapses=0, seed=seed)
        study = write_simulated(
            tmp_path / str(seed), parse_perceive_plan(words), words.encode(), f"s{seed}", raters
        )
        pairs = {c.pair[0].removesuffix("-own"): c for c in analyse_answers(collect_answers(study)).pairs}
        for name, planted in PLANTED.items():
            model = pairs[name].model
            held += model is not None and model.effects["preference"].holds(planted)
        chance += pairs["planner"].verdict != "not told"
        found += pairs["recorded"].verdict == "preferred"
    assert held >= 0.87 * 4 * studies and chance <= many(2, 5) and found == studies


def test_still_faces_have_no_lips_brows_and_blinks_of_speech_for_all_who_are_seen() -> None:
    from dataclasses import replace

    from app.cli.perceive_stimuli import make_face_still
    from app.stage.playback_source import ShownPlayback
    from metagraph.graph.model import Project
    from metagraph.playback.plan import Plan

    alone = ShownPlayback(Project(), Plan(1, 0.0), 1.0)
    shown = make_face_still(replace(alone, others=(replace(alone, side=1),)))
    assert [one.side for one in shown.everyone] == [0, 1]
    for one in shown.everyone:
        life = one.project.life
        assert life.lips == life.expressions == life.accent_brows == life.accent_blinks == 0
        assert life.breathing == alone.project.life.breathing
