"""Retimed clips in files: kept in the project, exported as they play, refused where they make no sense."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

from metagraph.engines.export import write_project_files
from metagraph.formats.clips import read_clips
from metagraph.formats.project.data import DataError, from_data, to_data
from metagraph.formats.store import open_project, save_project
from metagraph.graph import edits
from metagraph.graph.editing.retiming import set_retime
from metagraph.motion.retime import Hold, Retime

CLIPS = Path(__file__).resolve().parents[2] / "sample_clips" / "clips"


@pytest.fixture
def saved(tmp_path):
    """A project of two of our own clips, one of them slower and held."""
    files = sorted(CLIPS.glob("*.glb"))[:2] or sorted(CLIPS.rglob("*.*"))[:2]
    project = None
    from metagraph.graph.model import Project

    project = Project()
    for file in files:
        shutil.copy(file, tmp_path / file.name)
        project = edits.add_clips(project, [(file.name, 0, "", read_clips(file)[0])])
    first, second = project.clips
    project = edits.add_stance(project, "arms", "here", [first])
    stance = next(iter(project.graphs["arms"].stances))
    project = edits.place_clips(project, [second], "arms", "gesture", stance)
    project = set_retime(project, second, Retime(0.8, (Hold(0.5, 0.6),)))
    path = tmp_path / "p.metagraph.yaml"
    save_project(project, path)
    return project, path, second


def test_it_is_kept_and_read_again(saved):
    project, path, clip = saved
    again = open_project(path).project
    assert again.clips[clip].retime == Retime(0.8, (Hold(0.5, 0.6),))
    assert again.clips[clip].frames == project.clips[clip].frames
    assert np.allclose(again.clips[clip].motion.rotations, project.clips[clip].motion.rotations, atol=1e-6)
    assert again.clips[clip].source is not None


def test_the_export_has_the_clip_as_it_plays(saved, tmp_path):
    project, _, clip = saved
    write_project_files(project, tmp_path / "out")
    found = {c.name: c for f in (tmp_path / "out").glob("*.glb") for c in read_clips(f)}
    played = project.clips[clip]
    exported = next(c for name, c in found.items() if played.name in name)
    assert exported.duration == pytest.approx(played.motion.duration, abs=0.02)
    assert exported.duration > played.source.duration + 0.5


@pytest.mark.parametrize(
    ("field", "value", "words"),
    [
        ("speed", 0.0, "between 0.1 and 4"),
        ("speed", "fast", "should be a number"),
        ("holds", [{"at": -1, "seconds": 1}], "0 or more"),
        ("holds", [{"at": 1, "seconds": 0}], "above 0"),
        ("holds", [{"at": 1}], "is missing"),
        ("holds", [{"at": 1, "seconds": 1, "why": 2}], "not a field known here"),
        ("holds", [{"at": 1, "seconds": 1}, {"at": 1, "seconds": 2}], "different moments"),
    ],
)
def test_what_makes_no_sense_is_refused_with_its_place(saved, field, value, words):
    data = to_data(saved[0])
    data["clips"][0][field] = value
    with pytest.raises(DataError, match=words) as error:
        from_data(data)
    assert error.value.where.startswith("clips[0]")


def test_a_plain_clip_says_nothing_of_it(saved):
    data = to_data(saved[0])
    assert "speed" not in data["clips"][0] and data["clips"][1]["speed"] == 0.8


def test_hands_that_are_kept_are_kept_in_the_file(saved, tmp_path):
    from metagraph.graph.editing.retiming import keep_hand

    project, _, clip = saved
    project = keep_hand(project, clip, "right", 0.4, 0.9)
    save_project(project, tmp_path / "kept.metagraph.yaml")
    again = open_project(tmp_path / "kept.metagraph.yaml").project
    assert again.clips[clip].retime == project.clips[clip].retime and again.clips[clip].retime.contacts
    assert np.allclose(again.clips[clip].motion.rotations, project.clips[clip].motion.rotations, atol=1e-6)
    data = to_data(project)
    data["clips"][1]["contacts"][0]["last"] = 0.1
    with pytest.raises(DataError, match="before last"):
        from_data(data)
