"""How much an action stands out: by its motion, its name and its user."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from metagraph.graph import edits
from metagraph.graph.model import Action, Project
from metagraph.playback.planning.prominence import EMBLEM, SMALL, measure_prominence


def named(project: Project, name: str) -> Action:
    return next(a for a in project.actions() if a.name == name)


def test_a_beat_hardly_shows_and_a_wave_does(sample: Project) -> None:
    assert measure_prominence(sample, named(sample, "beat_small_rt_01")) <= SMALL
    for emblem in ("wave_hello_rt_01", "check_watch_lf_01", "thumbs_up_rt_01"):
        assert measure_prominence(sample, named(sample, emblem)) >= EMBLEM


def test_without_telling_names_the_larger_and_faster_motion_shows_more(sample: Project) -> None:
    def plain(name: str) -> float:
        return measure_prominence(sample, replace(named(sample, name), name="x", tags=()))

    assert plain("beat_small_rt_01") < plain("open_palms_bt_01") < plain("refuse_bt_01")
    assert plain("nod_small_01") < plain("shake_01"), "the head turns on the spot: its turn is measured"


def test_its_user_says_more_than_name_and_motion(sample: Project) -> None:
    wave = named(sample, "wave_hello_rt_01")
    project = edits.update_actions(sample, [wave.id], prominence=0.1)
    assert measure_prominence(project, project.action(wave.id)) == 0.1


def test_nothing_is_known_of_a_clip_that_is_missing(toy: Any) -> None:
    project = toy.project()
    action = project.action(toy.id(project, "rest long"))
    assert measure_prominence(project, action) > 0
    gone = replace(project, clips={i: replace(c, motion=None) for i, c in project.clips.items()})
    assert measure_prominence(gone, action) == 0.0
