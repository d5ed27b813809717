"""Two annotators agree as far as their time, their annotations and their labels are the same."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.playback.learning.annotation import Annotation, AnnotationInterval, AnnotationTier
from metagraph.research.agreement import match_tiers, measure_agreement


def tier(name: str, *rows: tuple[float, float, str]) -> AnnotationTier:
    return AnnotationTier(name, tuple(AnnotationInterval(*row) for row in rows))


def test_cohens_own_example_has_his_kappa() -> None:
    """Cohen 1960, table 1: proportions of three categories; kappa is .492 there."""
    shares = [(0.25, 0.13, 0.12), (0.12, 0.02, 0.16), (0.03, 0.15, 0.02)]
    at, ones, others = 0.0, [], []
    for a, row in zip("ABC", shares, strict=True):
        for b, share in zip("ABC", row, strict=True):
            ones.append((at, at + share, a))
            others.append((at, at + share, b))
            at += share
    found = measure_agreement(tier("x", *ones), tier("y", *others))
    seen = 0.25 + 0.02 + 0.02
    chance = 0.5 * 0.4 + 0.3 * 0.3 + 0.2 * 0.3
    assert found.same == pytest.approx(seen)
    assert found.kappa == pytest.approx((seen - chance) / (1 - chance))


def test_the_same_tier_agrees_whole_and_another_order_of_labels_not() -> None:
    one = tier("x", (0, 1, "beat"), (2, 3, "rest"), (4, 5, "beat"))
    same = measure_agreement(one, one)
    assert (same.same, same.kappa, same.matched, same.labels_kappa) == (1.0, 1.0, 3, 1.0)
    assert (same.starts, same.ends) == (0.0, 0.0)
    turned = measure_agreement(one, tier("y", (0, 1, "rest"), (2, 3, "beat"), (4, 5, "rest")))
    assert turned.matched == 3 and turned.labels_same == 0.0 and turned.labels_kappa is not None
    assert turned.labels_kappa < 0 and turned.same == pytest.approx(2 / 5), "both have nothing between"
    assert next(iter(turned.confusion)) in {("", ""), ("beat", "rest")}


def test_annotations_belong_together_within_the_tolerance_and_the_nearest_do() -> None:
    one = tier("x", (1.0, 2.0, "a"), (1.2, 2.2, "b"))
    other = tier("y", (1.15, 2.15, "b"))
    assert measure_agreement(one, other, 0.1).matched == 1
    assert measure_agreement(one, other, 0.1).labels_same == 1.0
    assert measure_agreement(one, other, 0.01).matched == 0
    later = measure_agreement(tier("x", (1, 2, "a")), tier("y", (1.1, 2.2, "a")))
    assert later.starts == pytest.approx(0.1) and later.ends == pytest.approx(0.2)
    assert later.kappa == pytest.approx((0.9 / 1.2 - later_chance()) / (1 - later_chance()))


def later_chance() -> float:
    """1.2 s: the first has a for 1.0, the second for 1.1."""
    return (1.0 * 1.1 + 0.2 * 0.1) / 1.2**2


def test_one_label_for_all_the_time_has_no_kappa() -> None:
    found = measure_agreement(tier("x", (0, 2, "a")), tier("y", (0, 2, "a")))
    assert found.kappa is None and found.same == 1.0


@given(
    st.lists(
        st.tuples(st.floats(0.05, 3), st.floats(0.05, 3), st.sampled_from("abc")), min_size=1, max_size=8
    )
)
def test_nobody_agrees_more_than_with_himself_and_either_may_come_first(
    rows: list[tuple[float, float, str]],
) -> None:
    at, spans = 0.0, []
    for gap, long, label in rows:
        spans.append((at + gap, at + gap + long, label))
        at = spans[-1][1]
    one, other = tier("x", *spans), tier("y", *((a, b, "a") for a, b, _ in spans))
    there, back = measure_agreement(one, other), measure_agreement(other, one)
    assert there.same == pytest.approx(back.same) and there.matched == back.matched == len(rows)
    assert there.same <= measure_agreement(one, one).same == pytest.approx(1.0)
    if there.kappa is not None and back.kappa is not None:
        assert there.kappa == pytest.approx(back.kappa) and there.kappa <= 1 + 1e-9


def test_tiers_are_paired_by_name_in_two_files_and_by_annotator_in_one() -> None:
    rows = ((0, 1, "a"),)
    two = Annotation((tier("Arms", *rows), tier("Speech", *rows))), Annotation((tier("arms", *rows),))
    assert [(a.name, b.name) for a, b in match_tiers(*two)] == [("Arms", "arms")]
    one = Annotation(
        (tier("Arms@Ann", *rows), tier("Arms@Ben", *rows), tier("Head_1", *rows), tier("Head_2", *rows))
    )
    assert [(a.name, b.name) for a, b in match_tiers(one, None)] == [
        ("Arms@Ann", "Arms@Ben"),
        ("Head_1", "Head_2"),
    ]
    assert match_tiers(one, None, [("Head_1", "Arms@Ben")])[0][1].name == "Arms@Ben"
    raters = Annotation(
        (tier("LH_form", *rows), tier("LH_phase rater 1", *rows), tier("LH_phase rater 2", *rows))
    )
    assert [(a.name, b.name) for a, b in match_tiers(raters, None)] == [
        ("LH_phase rater 1", "LH_phase rater 2")
    ]


def test_what_cannot_be_compared_is_refused_with_the_names_that_there_are() -> None:
    rows = ((0, 1, "a"),)
    with pytest.raises(ValueError, match=r"name them with --tiers A=B\. There are 'Arms'"):
        match_tiers(Annotation((tier("Arms", *rows),)), None)
    with pytest.raises(ValueError, match="there is no tier 'Legs'; there are 'Arms'"):
        match_tiers(Annotation((tier("Arms", *rows),)), None, [("Legs", "Arms")])
    with pytest.raises(ValueError, match="'Empty' has no annotations"):
        measure_agreement(tier("x", *rows), tier("Empty"))
    with pytest.raises(ValueError, match="0 to 60 seconds"):
        measure_agreement(tier("x", *rows), tier("y", *rows), -1)
