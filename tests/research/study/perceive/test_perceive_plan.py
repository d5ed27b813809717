"""Plans of perceptual studies: read to the last field, refused with line, cause and remedy."""

from __future__ import annotations

from pathlib import Path

import pytest

from metagraph.errors import FileError
from metagraph.research.study.perceive.perceive_plan import parse_perceive_plan, read_perceive_plan
from tests.research.study.perceive.perceive_makers import CHOICE, RATING, plan, text


def test_the_least_plan_is_read_and_compares_all_pairs() -> None:
    made = plan(conditions="{a: {clip: x}, b: {clip: y}, c: {clip: z, title: The third}}")
    assert made.pairs == (("a", "b"), ("a", "c"), ("b", "c")) and made.ids == ("P01", "P02", "P03", "P04")
    assert made.name("c") == "The third" and made.name("a") == "a" and made.training == 1


@pytest.mark.parametrize(
    ("words", "cause", "place"),
    [
        ("", "is no perceptual study", "line 1"),
        ("- 1\n", "is no perceptual study", "line 1"),
        ("perceive: 2\n", "is of a newer version", "perceive"),
        ("perceive: true\n", "should be the version", "line 1"),
        ("perceive: 1\n\ttitle: x", "not valid YAML", "line"),
        (text(more="oops: 1\n"), "there is no field 'oops'", "(oops)"),
        (text(people=0), "expected `int` >= 1", "line 3"),
        (text(people="[A1, a1]"), "'A1' is there twice", "line 3"),
        (text(asked=""), "nothing is asked", "line 1"),
        (text(conditions="{a: {clip: x}}"), "nothing to choose between", "line 5"),
        (text(conditions="{a: {clip: x}, b: {}}"), "give one of", "conditions.b"),
        (text(conditions="{a: {clip: x, video: y.mp4}, b: {clip: z}}"), "give one of", "conditions.a"),
        (
            text(conditions="{a: {clip: x, without: [clause]}, b: {clip: z}}"),
            "are of conversations",
            "conditions.a",
        ),
        (
            text(conditions="{a: {conversation: x, motion: m.bvh}, b: {clip: z}}"),
            "one for each side",
            "conditions.a",
        ),
        (text(conditions="{a: {motion: [m.bvh, n.bvh]}, b: {clip: z}}"), "one for each side", "conditions.a"),
        (
            text(conditions="{a: {video: 'v/{clip}.mp4'}, b: {clip: z}}"),
            "only {item} is filled in",
            "conditions.a",
        ),
        (text(conditions="{a: {clip: x, seed: 3}, b: {clip: z}}"), "nothing is drawn here", "conditions.a"),
        (text(conditions="{a: {performance: x, audio: s.wav}, b: {clip: z}}"), "own sound", "conditions.a"),
        (text(conditions="{a: {clip: x}, b: {clip: z, sound: none}}"), "present: after", "choice.present"),
        (
            text(items=1, conditions="{a: {clip: x}, b: {clip: z, sound: mismatched}}"),
            "only one item",
            "conditions.b",
        ),
        (text(more="compare: [[all, who]]\n"), "there is no condition 'who'", "compare[0]"),
        (text(more="compare: [[all, all]]\n"), "not compared with itself", "compare[0]"),
        (text(more="compare: [[all, deaf], [deaf, all]]\n"), "compared twice", "compare[1]"),
        (text(asked="choice: {question: Q, each: 9}\n"), "only 3 pairs", "choice.each"),
        (text(asked=RATING + "  each: 4\n"), "only 3 items", "rating.each"),
        (
            text(asked="rating: {questions: [{id: a, text: A, words: true}]}\n"),
            "give 'scale'",
            "rating.questions[0]",
        ),
        (
            text(asked="rating: {questions: [{id: a, text: A, scale: {from: 1, to: 90}}]}\n"),
            "2 to 11",
            "scale",
        ),
        (
            text(asked=RATING + "  - {id: natural, text: B, scale: {from: 1, to: 3}}\n"),
            "same id",
            "rating.questions",
        ),
        (text(more="checks: {told: 1, allow: 1}\n"), "nobody would ever be excluded", "checks.allow"),
        (text(more="smallest: 0.4\n"), "0.5", "smallest"),
        (text(items=300, asked=CHOICE + RATING), "more than 500", "rating"),
    ],
)
def test_what_is_wrong_is_told_with_its_place_and_a_remedy(words: str, cause: str, place: str) -> None:
    with pytest.raises(FileError) as told:
        parse_perceive_plan(words, Path("my.yaml"))
    assert cause in told.value.cause and place in told.value.where and told.value.remedy
    assert "my.yaml" in str(told.value)


def test_sounds_may_differ_where_videos_follow_each_other() -> None:
    made = plan(
        asked="choice: {question: Q, present: after}\n",
        conditions="{a: {conversation: x}, b: {conversation: x, sound: mismatched}}",
    )
    assert made.choice is not None and made.choice.present == "after"


def test_a_project_is_only_needed_where_something_is_of_one() -> None:
    words = text(conditions="{a: {video: a.mp4}, b: {motion: 'm/{item}.bvh'}}").replace(
        "project: sample.metagraph.yaml\n", ""
    )
    assert parse_perceive_plan(words).project is None
    with pytest.raises(FileError, match="which project"):
        parse_perceive_plan(words.replace("video: a.mp4", "clip: x"))


def test_a_folder_s_plan_is_read_and_what_is_no_text_is_told(tmp_path: Path) -> None:
    (tmp_path / "perceive.yaml").write_text(text())
    assert read_perceive_plan(tmp_path) == read_perceive_plan(tmp_path / "perceive.yaml") == plan()
    (tmp_path / "perceive.yaml").write_bytes(b"perceive: 1\n\xff")
    with pytest.raises(FileError, match="is not text"):
        read_perceive_plan(tmp_path)
    with pytest.raises(FileError):
        read_perceive_plan(tmp_path / "none.yaml")
