"""Takes, what was heard during them, and clips kept as files."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
import soundfile

from app.features.motion_graph.synthesis_jobs import (
    ChosenTakes,
    Wish,
    choose_takes,
    count_graph_states,
    cut_to_take,
    describe_unusable_clips,
    find_recorded_side,
    list_usable_clips,
    synthesise,
)
from app.project.new_clips import cut_into_pieces, save
from metagraph.errors import FileError
from metagraph.formats.clips import read_clips
from metagraph.graph.conversation.model import Conversation, Segment, Side
from metagraph.graph.model import Project
from metagraph.research.motion_graph.search_evaluation import cut_segments
from metagraph.synthesis.graph import build_graph
from metagraph.synthesis.iconic_words import parse_word_wish
from metagraph.synthesis.soft_constraints import SoftWish
from metagraph.synthesis.states import SynthesisError, read_states
from tests.synthesis.talking import VOICE, WORDS, aloud, speech, talking


def stances(project: Project) -> list[str]:
    return [i for i in list_usable_clips(project) if project.clips[i].name.endswith("__stance")]


def told(project: Project, clip: str) -> Project:
    """The project with a conversation whose second side was recorded along with a clip; the partner
    hesitates.
    """
    ada = Side(name="Ada", segments=(Segment("hesitation", 3.0, 3.5),))
    ben = Side(
        name="Ben", take=clip, segments=(Segment("clause", 1.0, 2.0, 1.5), Segment("hesitation", 5.0, 5.4))
    )
    return replace(project, conversations={"v1": Conversation(name="talk", length=6.0, sides=(ada, ben))})


def test_takes_are_clips_that_move_on_the_projects_skeleton_the_longest_first(sample: Project) -> None:
    found = list_usable_clips(sample)
    lengths = [sample.clips[i].duration for i in found]
    assert len(found) == len(sample.clips) and lengths == sorted(lengths, reverse=True)
    lost = replace(sample, clips={**sample.clips, found[0]: replace(sample.clips[found[0]], motion=None)})
    assert list_usable_clips(lost) == found[1:]
    assert list_usable_clips(Project()) == []


def test_a_take_knows_what_was_heard_during_it_the_partners_hesitations_and_not_its_own(
    sample: Project,
) -> None:
    clip, other = stances(sample)[:2]
    project = told(sample, clip)
    takes = choose_takes(project, [other, clip])
    assert find_recorded_side(project, clip) == ("v1", 1) and find_recorded_side(project, other) is None
    assert [[s.kind for s in speech] for speech in takes.speech] == [["clause", "hesitation"], []]
    assert takes.told and not choose_takes(project, [other]).told


def test_what_goes_on_after_a_takes_end_was_not_heard_during_it(sample: Project) -> None:
    said = (
        Segment("clause", 1.0, 2.0, 1.5),
        Segment("clause", 3.0, 5.0, 4.5, "so on"),
        Segment("response", 6.0, 7.0),
    )
    assert cut_to_take(said, 10.0) == said
    assert cut_to_take(said, 4.0) == (said[0], Segment("clause", 3.0, 4.0, None, "so on"))
    assert cut_to_take(said, 3.0) == said[:1]
    clip = stances(sample)[0]
    end = sample.clips[clip].duration
    ben = Side(take=clip, segments=tuple(Segment("clause", n + 0.1, n + 0.9) for n in range(60)))
    project = replace(
        sample, conversations={"v1": Conversation(name="long", length=60.0, sides=(Side(), ben))}
    )
    assert choose_takes(project, [clip]).speech[0][-1].end <= end


def test_clips_that_cannot_be_takes_are_told_with_the_reason(sample: Project) -> None:
    from metagraph.motion.skeleton import Skeleton

    a, b, c = stances(sample)[:3]
    still = replace(sample.clips[a], motion=sample.clips[a].motion.trimmed(0, 1), frames=1)
    lost = replace(sample.clips[b], motion=None)
    own = sample.clips[c].motion
    longer = Skeleton(
        own.skeleton.names,
        own.skeleton.parents,
        own.skeleton.rest_rotations,
        2 * own.skeleton.rest_translations,
    )
    odd = replace(sample.clips[c], motion=replace(own, skeleton=longer))
    project = replace(sample, clips={**sample.clips, a: still, b: lost, c: odd})
    assert describe_unusable_clips(sample) == ""
    told = describe_unusable_clips(project)
    for reason in ("one frame", "another skeleton", "missing"):
        assert told.count("1 clip ") == 3 and reason in told, told
    assert not {a, b, c} & set(list_usable_clips(project))


@pytest.mark.nightly
def test_new_motion_goes_with_speech_where_the_takes_know_theirs(sample: Project) -> None:
    ids = stances(sample)
    takes = choose_takes(told(sample, ids[0]), ids)
    from metagraph.synthesis.constraints import find_change_states
    from metagraph.synthesis.states import key_states

    states = read_states(takes.clips)
    graph = build_graph(states, keys=key_states(states, changes=find_change_states(states, takes.speech)))
    found = synthesise(graph, takes, Wish(2.0, (Segment("clause", 0.5, 1.5, 1.0),)), "new")
    assert (
        found.clip.duration == pytest.approx(2.0, abs=0.05)
        and found.clip.name == "new"
        and "cost" in found.words()
    )
    other = synthesise(graph, takes, Wish(2.0, (Segment("response", 0.5, 1.5),), tolerance=0.0), "new")
    assert "Dropped: responses" in other.words() and "repeats within 3 s" in other.words()


@pytest.mark.parametrize(("exact", "search"), [(True, "find_best_path"), (False, "search_greedily")])
def test_where_speech_does_not_constrain_nothing_is_said_of_it(
    sample: Project, monkeypatch: pytest.MonkeyPatch, exact: bool, search: str
) -> None:
    from metagraph.synthesis.search import ruled_search as searches

    def stuck(*_: object, **__: object) -> None:
        raise SynthesisError("no motion goes with this speech beyond 0.0 s: allow more tolerance")

    takes = choose_takes(sample, stances(sample)[:2])
    monkeypatch.setattr(searches, search, stuck)
    with pytest.raises(SynthesisError, match=r"for 9 s .*takes"):
        synthesise(
            build_graph(read_states(takes.clips)),
            takes,
            Wish(9.0, (Segment("clause", 0.5, 1.5, 1.0),), exact),
            "new",
        )


def test_speech_nobody_told_the_takes_about_constrains_nothing(sample: Project) -> None:
    takes = choose_takes(sample, stances(sample))
    from metagraph.synthesis.states import read_states

    found = synthesise(
        build_graph(read_states(takes.clips)), takes, Wish(4.0, (Segment("response", 0.0, 4.0),)), "new"
    )
    assert found.clip.duration == pytest.approx(4.0, abs=0.05)


def test_the_table_counts_frames_and_transitions_before_and_after_for_each_k(sample: Project) -> None:
    rows = count_graph_states(
        choose_takes(sample, stances(sample)), (2, 3, 4), 0.95, lambda *_: None, lambda: False
    )
    assert [rows[k][0] for k in (2, 3, 4)] == [rows[2][0]] * 3
    assert rows[2][1] < rows[3][1] < rows[4][1]
    assert all(after <= before for *_, before, after in [(r[0], r[2]) for r in rows.values()])


def test_pieces_are_kept_as_files_that_read_back_under_names_that_are_free(
    sample: Project, tmp_path: Path
) -> None:
    clip = sample.clips[stances(sample)[0]].motion
    assert clip is not None
    cut = cut_into_pieces(clip, [(0.0, 1.0), (1.5, 3.0)])
    assert [round(c.duration, 2) for c in cut] == [1.0, 1.5]
    loaded = save(cut, tmp_path, "cuts", {f"{clip.name}_01"})
    again = save(cut, tmp_path, "cuts")
    assert len({path for path, *_ in (*loaded, *again)}) == 4
    assert loaded[0][3].name != f"{clip.name}_01"
    for path, take, digest, motion in loaded:
        read = read_clips(tmp_path / path)[take]
        assert read.frames == motion.frames and len(digest) == 64
        assert read.skeleton == clip.skeleton


def test_names_that_cannot_be_files_are_made_such(sample: Project, tmp_path: Path) -> None:
    clip = sample.clips[stances(sample)[0]].motion
    assert clip is not None
    path = save([clip.trimmed(0, 5).renamed("a/b: c?")], tmp_path, "cuts")[0][0]
    assert path == "cuts/a_b_ c_.glb" and (tmp_path / path).is_file()


def test_words_and_sounds_of_the_sides_are_compared(tmp_path: Path) -> None:
    segments = speech(16, 1)
    steps, words, samples = aloud(segments, 16, 1)
    soundfile.write(tmp_path / "ann.wav", samples, VOICE)
    clip = talking("take", segments, 16, 1, sizes=[1 + 0.5 * step for step in steps])
    ann = Side(name="Ann", audio="ann.wav", segments=tuple(segments), words=words)
    states = read_states([clip])
    graph = build_graph(states)
    takes = ChosenTakes(("c1",), (clip,), (tuple(segments),), (ann,))
    soft = SoftWish(0.5, 0.5, tuple(parse_word_wish(text) for text in WORDS), retime=0.15)
    wish = Wish(
        4.0, tuple(cut_segments(segments, 8.0, 4.0)), soft=soft, side=ann, whole=tuple(segments), start=8.0
    )
    found = synthesise(graph, takes, wish, "new", folder=tmp_path)
    assert (
        "loudness differs by 0.00 standard deviations" in found.beside
        and "rate differs by 0.00 standard deviations" in found.beside
    )
    assert "words have the motion of a take" in found.words()
    plain = synthesise(graph, takes, replace(wish, soft=SoftWish()), "new", folder=tmp_path / "nowhere")
    assert plain.beside == ""
    with pytest.raises(FileError, match="the sound file does not exist"):
        synthesise(graph, takes, wish, "new", folder=tmp_path / "nowhere")
