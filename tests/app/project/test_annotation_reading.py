"""An annotation on its way into a project: how it is read, what is remembered of that, what is made of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from app.project.annotation_reading import apply_reading, begin_reading, describe_doubts, remember_reading
from metagraph.formats.elan import read_elan
from metagraph.formats.project.data import from_data, to_data
from metagraph.graph.model import LAYERS, Project
from metagraph.playback.learning.annotation import Annotation, AnnotationInterval, AnnotationTier
from metagraph.playback.learning.learn import read_acts_of_asks
from metagraph.playback.planning.running_plan import plan_performance

SAMPLE = Path(__file__).resolve().parents[3] / "sample_clips" / "annotation" / "conversation.eaf"


def tier(name: str, *texts: str) -> AnnotationTier:
    return AnnotationTier(name, tuple(AnnotationInterval(n, n + 0.5, t) for n, t in enumerate(texts)))


@pytest.fixture(scope="module")
def conversation() -> Annotation:
    return read_elan(SAMPLE)


def test_an_annotation_with_nothing_in_it_says_so_and_changes_nothing_but_the_memory() -> None:
    reading = begin_reading(Annotation((tier("words", "hello"),)))
    assert reading.observed == {} and reading.labels == ()
    assert "tier" in describe_doubts(reading)[0]
    made = apply_reading(Project(), reading, LAYERS, True, "talk")
    assert (made.learned, made.performance) == ((), None)
    assert made.project == Project(tiers={"words": "ignore"})


def test_people_who_are_not_read_are_told() -> None:
    def hand(name: str, who: str, count: int) -> AnnotationTier:
        return AnnotationTier(
            name, tuple(AnnotationInterval(n, n + 0.5, "stroke") for n in range(count)), participant=who
        )

    both = begin_reading(Annotation((hand("A_LH", "Ann", 2), hand("B_LH", "Bob", 3), tier("words", "hi"))))
    (told,) = [x for x in describe_doubts(both) if "Several people" in x]
    assert "Bob is read" in told and "A_LH" in told and "words" not in told
    alone = begin_reading(Annotation((hand("A_LH", "Ann", 2), hand("A_RH", "Ann", 3))))
    assert not any("Several people" in x for x in describe_doubts(alone))


def test_roles_and_meanings_can_be_said_otherwise_and_what_was_said_stays() -> None:
    reading = begin_reading(Annotation((tier("A", "cup", "box"), tier("B", "cup"))))
    assert reading.observed == {}
    reading = reading.with_role("A", "left arm")
    assert [a.kind for a in reading.observed["arms"]] == ["gesture", "gesture"]
    reading = reading.with_meaning(reading.labels[0], "fidget").with_role("B", "head action")
    assert [a.kind for a in reading.observed["arms"]] == ["fidget", "gesture"]
    assert [a.kind for a in reading.observed["head"]] == ["gesture"], (
        "what was said of the arms' label is not said of the head's"
    )
    assert list(reading.observed) == ["arms", "head"]
    assert list(reading.with_role("A", "ignore").observed) == ["head"]


def test_the_project_remembers_how_it_was_read_and_the_next_reading_begins_so() -> None:
    annotation = Annotation((tier("LH", "cup", "gesture"), tier("B", "cup")))
    reading = begin_reading(annotation).with_role("B", "body")
    reading = reading.with_meaning(reading.labels[0], "fidget")
    project = remember_reading(Project(labels={"arms: old": "hold", "body: cup": "gesture"}), reading)
    assert project.tiers == {"LH": "left arm", "B": "body"}
    assert project.labels == {"arms: old": "hold", "arms: cup": "fidget"}, (
        "what is as it would be guessed is not written down"
    )
    assert from_data(to_data(project)) == project
    again = begin_reading(annotation, project.tiers, labels=(project.labels,))
    assert again.observed == reading.observed
    guessed = again.with_meaning(again.labels[0], "gesture")
    assert remember_reading(project, guessed).labels == {"arms: old": "hold"}, (
        "and forgotten when it is taken back"
    )


def test_models_are_learned_of_the_layers_that_are_wanted_and_were_seen(conversation: Annotation) -> None:
    reading = begin_reading(conversation)
    made = apply_reading(Project(), reading, ("arms", "head"), False, None)
    assert made.learned == ("arms", "head") and made.performance is None
    assert set(made.project.markov) == {"arms", "head"}
    assert made.project.markov["head"].positive > 0.8 and made.project.markov["head"].tags == ()
    assert from_data(to_data(made.project)) == made.project
    tagged = apply_reading(Project(), reading, LAYERS, True, None, smoothing=0.5).project.markov
    assert tagged["head"].tags == ("positive", "negative", "")
    assert all(p > 0 for row in tagged["arms"].matrix for p in row)
    assert apply_reading(
        Project(), begin_reading(Annotation((tier("LH", "beat"),))), LAYERS, False, None
    ).learned == ("arms",)


def test_few_actions_are_doubted(conversation: Annotation) -> None:
    (doubt,) = describe_doubts(begin_reading(conversation))
    assert "12 actions" in doubt and "body" in doubt
    assert "contain no usable labels" in describe_doubts(begin_reading(Annotation((tier("LH", "rest"),))))[0]
    assert describe_doubts(begin_reading(Annotation((), notes=("one left out",))))[0] == "one left out"


def test_what_was_seen_is_kept_as_a_performance_of_its_own_name(conversation: Annotation) -> None:
    reading = begin_reading(conversation)
    first = apply_reading(Project(), reading, (), False, "talk")
    second = apply_reading(first.project, reading, (), False, "talk")
    assert [p.name for p in second.project.performances.values()] == ["talk", "talk 2"]
    kept = second.project.performances[second.performance or ""]
    assert not kept.idle and kept.length >= conversation.end
    for layer, acts in reading.observed.items():
        back = read_acts_of_asks(layer, kept.asks)
        assert [(a.kind, a.limb, a.tags) for a in back] == [(a.kind, a.limb, a.tags) for a in acts]
        assert all(
            abs(a.start - b.start) < 1e-3 and abs(a.end - b.end) < 2e-3
            for a, b in zip(back, acts, strict=True)
        )


def test_an_annotation_is_performed_as_it_was_seen_and_other_seeds_vary_the_actions(
    conversation: Annotation, sample: Project
) -> None:
    reading = begin_reading(conversation)
    made = apply_reading(sample, reading, (), False, "talk")
    kept = made.project.performances[made.performance or ""]
    plans = [
        plan_performance(made.project, kept.asks, kept.length, seed, dict(kept.stances), kept.idle)
        for seed in (1, 2)
    ]
    for layer, acts in reading.observed.items():
        names = []
        for plan in plans:
            cues = plan.layers[layer].cues
            assert 0.9 * len(acts) <= len(cues) <= len(acts) + 3, (
                "nearly everything that was seen plays, and nothing else"
            )
            kinds = {
                (ask.split("+")[0]): a.kind
                for ask, a in zip((f"{layer}{n + 1}" for n in range(len(acts))), acts, strict=True)
            }
            assert all(cue.action.kind == kinds[cue.meta.split("+")[0].split("/")[0]] for cue in cues)
            names.append([cue.action.name for cue in cues])
        assert names[0] != names[1]
        starts = {f"{layer}{n + 1}": a.start for n, a in enumerate(acts)}
        late = [cue.start - starts[cue.meta.split("+")[0]] for cue in plans[0].layers[layer].cues]
        assert sorted(late)[len(late) // 2] < 0.5, "most begin when they were seen to"


def test_a_change_of_one_arm_is_performed_by_any_transition(toy: Any) -> None:
    project = toy.project()
    reading = begin_reading(
        Annotation(
            (
                AnnotationTier(
                    "LH",
                    (AnnotationInterval(0.5, 1.5, "stance-transition"), AnnotationInterval(6, 7, "change")),
                ),
            )
        )
    )
    made = apply_reading(project, reading, (), False, "shift")
    kept = made.project.performances[made.performance or ""]
    assert [ask.limb for ask in kept.asks] == ["left", "left"]  # type: ignore[union-attr]
    plan = plan_performance(made.project, kept.asks, kept.length, 1, dict(kept.stances), kept.idle)
    assert [cue.action.kind for cue in plan.layers["arms"].cues] == ["transition", "transition"]
    assert [cue.action.limb for cue in plan.layers["arms"].cues] == ["both", "both"]
    assert not plan.reports
