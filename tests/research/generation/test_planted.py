import numpy as np
import pytest

from metagraph.errors import FileError
from metagraph.generation.features import RATE
from metagraph.generation.statistics import compute_measures, make_motion_sample, mismatch_speech
from metagraph.generation.take_files import find_takes, read_take_batch
from metagraph.generation.takes import share_stretch, split_takes
from metagraph.graph.conversation.model import list_segments_heard_by
from metagraph.graph.model import Project
from metagraph.research.generation.planted import CARD, Planted, perform_planted, read_planted, write_planted
from metagraph.research.generation.planted_speech import make_planted_speech

SHORT = Planted(count=2, seconds=20.0)


@pytest.fixture(scope="module")
def project(sample):
    return sample


@pytest.fixture(scope="module")
def folder(project, tmp_path_factory):
    out = tmp_path_factory.mktemp("planted")
    assert write_planted(project, out, SHORT, "MIT: made here") == 2
    return out


def test_the_same_seed_says_the_same_and_another_something_else():
    a, b, c = (make_planted_speech(30.0, seed, 1, "talk") for seed in (1, 1, 2))
    assert a.conversation == b.conversation
    assert (a.samples == b.samples).all()
    assert a.conversation.sides != c.conversation.sides


def test_other_moves_say_the_same():
    a, b = (make_planted_speech(30.0, 1, moves, "talk") for moves in (1, 2))
    assert a.conversation.sides == b.conversation.sides
    assert (a.samples == b.samples).all()


@pytest.mark.nightly
def test_a_clause_is_loudest_at_its_peak():
    spoken = make_planted_speech(120.0, 3, 1, "talk")
    for n, side in enumerate(spoken.conversation.sides):
        clauses = [s for s in side.segments if s.kind == "clause"]
        assert len(clauses) > 5
        for s in clauses:
            piece = spoken.samples[n, round(s.start * RATE) : round(s.end * RATE)].astype(float)
            power = np.convolve(piece**2, np.ones(RATE // 25), "same")
            assert abs(s.start + power.argmax() / RATE - s.peak) < 0.12


@pytest.mark.nightly
def test_speech_has_all_that_can_be_answered_and_is_not_cut_off():
    spoken = make_planted_speech(180.0, 1, 1, "talk")
    assert np.abs(spoken.samples).max() < 0.5
    for n in (0, 1):
        kinds = {s.kind for s in list_segments_heard_by(spoken.conversation, n)}
        assert kinds == {"clause", "response", "hesitation"}
        assert spoken.conversation.sides[n].segments[-1].end <= 180.0


@pytest.mark.parametrize("seconds", [0.0, 3.0, float("nan")])
def test_too_short_a_conversation_is_refused_in_words(seconds):
    with pytest.raises(ValueError, match="at least 10 s"):
        make_planted_speech(seconds, 1, 1, "talk")


@pytest.mark.nightly
def test_the_folder_is_read_as_takes_of_both_sides(folder):
    files, without = find_takes([folder])
    assert not without
    assert [f.side for f in files] == [0, 1, 0, 1]
    batch = read_take_batch(files)
    assert not batch.failures and not batch.notes
    assert [len(t.poses) for t in batch.takes] == [501] * 4
    first, second = batch.takes[:2]
    assert (first.activity[:, 0] == second.activity[:, 1]).all()
    assert first.marks.peaks and first.source.licence == "LICENSE.txt: MIT: made here"
    learned, held = split_takes(batch.takes)
    assert {t.source.name[:-2] for t in learned}.isdisjoint({t.source.name[:-2] for t in held})
    assert not share_stretch(batch.takes[0], batch.takes[2])


@pytest.mark.nightly
def test_nothing_is_made_twice_and_what_was_cut_short_is_made_up_for(project, folder):
    before = {p.name: p.read_bytes() for p in folder.iterdir()}
    assert write_planted(project, folder, SHORT) == 0
    (folder / "planted-002.json").unlink()
    (folder / "planted-002_2.glb").write_bytes(b"half")
    assert write_planted(project, folder, SHORT) == 1
    assert {p.name: p.read_bytes() for p in folder.iterdir()} == before


def test_a_folder_of_other_takes_is_left_alone(project, folder, tmp_path):
    with pytest.raises(FileError, match="planted otherwise: seed 1"):
        write_planted(project, folder, Planted(count=2, seconds=20.0, seed=2))
    (tmp_path / "thesis.txt").write_text("mine")
    with pytest.raises(FileError, match="holds other files"):
        write_planted(project, tmp_path, SHORT)
    assert [p.name for p in tmp_path.iterdir()] == ["thesis.txt"]
    assert read_planted(folder) is not None and read_planted(tmp_path) is None
    (tmp_path / CARD).write_text("{")
    with pytest.raises(FileError, match="no planted takes"):
        read_planted(tmp_path)


def test_what_cannot_be_planted_is_refused_before_anything_is_written(project, tmp_path):
    with pytest.raises(ValueError, match="1 to 10,000"):
        write_planted(project, tmp_path / "a", Planted(count=0))
    with pytest.raises(ValueError, match="no clips"):
        write_planted(Project("empty"), tmp_path / "a", SHORT)
    with pytest.raises(ValueError, match="at least 10 s"):
        write_planted(project, tmp_path / "a", Planted(count=1, seconds=1.0))
    assert not (tmp_path / "a").exists()


@pytest.mark.nightly
def test_other_moves_are_other_motion_that_goes_with_the_speech_as_well(project, folder, tmp_path):
    assert write_planted(project, tmp_path, Planted(count=2, seconds=20.0, moves=2)) == 2
    one = read_take_batch(find_takes([folder])[0])
    other = read_take_batch(find_takes([tmp_path])[0], one.rig)
    true, again = ([make_motion_sample(one.rig, t.poses, t) for t in batch.takes] for batch in (one, other))
    assert any(np.abs(a.poses - b.poses).max() > 0.1 for a, b in zip(true, again, strict=True))
    floor, wrong = compute_measures(again, true), compute_measures(mismatch_speech(true), true)
    assert floor["stroke"] > 1.5 > wrong["stroke"]
    assert floor["profile"] > 0.7 > wrong["profile"]


def test_a_clip_has_the_length_of_its_conversation(project):
    clip = perform_planted(project, make_planted_speech(12.0, 1, 1, "talk").conversation, 0)
    assert clip.fps == 25 and clip.frames == 301
