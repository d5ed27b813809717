"""Edits of conversations: whatever is done to segments, they stay sorted, apart, inside the conversation,
with their peaks inside.
"""

from __future__ import annotations

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph.conversation import edits as c
from metagraph.graph.conversation.model import (
    EVERYBODY,
    SHORTEST,
    SPOKEN,
    Conversation,
    Segment,
    Side,
    Word,
    get_word_lists,
    with_sides,
)
from metagraph.graph.edit_error import EditError
from metagraph.graph.model import Project

WORDS = (
    Word(text="we", start=1.0, end=1.2),
    Word(text="meet", start=1.3, end=1.6),
    Word(text="here", start=1.7, end=2.0),
)
FIRST = (
    Segment("clause", 1.0, 2.0, 1.4, "we meet here"),
    Segment("hesitation", 2.5, 2.8, None, "um"),
    Segment("clause", 3.0, 4.0, 3.9, "by the door"),
)
SECOND = (Segment("response", 2.1, 2.4, None, "Yeah."),)


def project(**fields: object) -> tuple[Project, str]:
    sides = (Side(name="Ann", words=WORDS, segments=FIRST), Side(name="Ben", segments=SECOND))
    return c.add_conversation(Project(), Conversation(name="Talk", length=10.0, sides=sides, **fields))


def segments(of: Project, ident: str, side: int = 0) -> tuple[Segment, ...]:
    return of.conversations[ident].sides[side].segments


def test_a_conversation_is_kept_under_an_id_and_a_name_of_its_own() -> None:
    before, one = project()
    after, other = c.add_conversation(before, before.conversations[one])
    assert one != other
    assert [x.name for x in after.conversations.values()] == ["Talk", "Talk 2"]
    assert list(c.remove_conversation(after, one).conversations) == [other]


def test_what_is_not_there_is_refused() -> None:
    before, ident = project()
    for bad in (
        lambda: c.remove_conversation(before, "v99"),
        lambda: c.set_peak(before, ident, 0, 3, 1.0),
        lambda: c.set_peak(before, ident, 0, -1, 1.0),
        lambda: c.merge_segments(before, ident, 0, 2, 3),
        lambda: c.merge_segments(before, ident, 0, -1, 0),
        lambda: c.change_conversation(before, ident, name="  "),
        lambda: c.change_conversation(before, ident, distance=99),
        lambda: c.change_side(before, ident, 0, colour="red"),
        lambda: c.set_rates(before, ident, 0, clause=1.2),
        lambda: c.relabel_segments(before, ident, {(0, 0)}, "idle"),
        lambda: c.split_segment(before, ident, 0, 0, 1.01),
        lambda: c.add_segment(before, ident, 0, "clause", 1.2, 1.6),
        lambda: c.add_segment(before, ident, 0, "clause", 5.0, 5.01),
    ):
        with pytest.raises(EditError):
            bad()


def test_fields_and_rates_are_set_and_nothing_changes_where_they_are_the_same() -> None:
    before, ident = project()
    after = c.set_rates(
        c.change_side(c.change_conversation(before, ident, distance=2), ident, 1, name=" Bea "),
        ident,
        1,
        clause=0.62,
    )
    of = after.conversations[ident]
    assert (of.distance, of.sides[1].name, of.sides[1].rates.clause, of.sides[1].rates.response) == (
        2.0,
        "Bea",
        0.62,
        0.58,
    )
    assert c.set_rates(after, ident, 1, clause=0.62) is after
    moved = c.change_side(before, ident, 1, project="other.metagraph.yaml")
    assert [s.project for s in moved.conversations[ident].sides] == [None, "other.metagraph.yaml"]


def test_a_move_stops_at_the_neighbours_and_takes_the_peak_along() -> None:
    before, ident = project()
    after = segments(c.move_segment(before, ident, 0, 0, 0.8), ident)[0]
    assert (after.start, after.end, after.peak) == pytest.approx((1.5, 2.5, 1.9))
    after = segments(c.move_segment(before, ident, 0, 0, -5), ident)[0]
    assert (after.start, after.end, after.peak) == pytest.approx((0.0, 1.0, 0.4))
    assert segments(c.move_segment(before, ident, 0, 2, 99), ident)[2].end == pytest.approx(10.0)


def test_an_edge_stops_at_the_neighbour_and_before_the_other_edge_and_pushes_the_peak() -> None:
    before, ident = project()
    assert segments(c.resize_segment(before, ident, 0, 0, end=9.0), ident)[0].end == 2.5
    short = segments(c.resize_segment(before, ident, 0, 0, end=0.0), ident)[0]
    assert (short.end, short.peak) == (pytest.approx(1.0 + SHORTEST), pytest.approx(1.0 + SHORTEST))
    assert segments(c.resize_segment(before, ident, 0, 2, start=0.0), ident)[2].start == 2.8


def test_a_peak_stays_inside_its_segment_and_can_be_taken_away() -> None:
    before, ident = project()
    assert segments(c.set_peak(before, ident, 0, 0, 7.0), ident)[0].peak == 2.0
    assert segments(c.set_peak(before, ident, 0, 0, None), ident)[0].peak is None


def test_several_are_relabelled_and_removed_at_once() -> None:
    before, ident = project()
    after = c.relabel_segments(before, ident, {(0, 0), (1, 0)}, "hesitation")
    assert [s.kind for s in segments(after, ident)] == ["hesitation", "hesitation", "clause"]
    assert segments(after, ident)[0].peak == 1.4, "labelled back, nothing is lost"
    after = c.remove_segments(after, ident, {(0, 0), (0, 2), (1, 0)})
    assert [s.text for s in segments(after, ident)] == ["um"]
    assert segments(after, ident, 1) == ()


def test_a_split_parts_the_words_and_a_merge_makes_them_one_again() -> None:
    before, ident = project()
    after = c.split_segment(before, ident, 0, 0, 1.65, peak=1.8)
    assert [(s.text, s.peak) for s in segments(after, ident)[:2]] == [("we meet", 1.4), ("here", 1.8)]
    assert segments(c.merge_segments(after, ident, 0, 0, 1), ident) == FIRST


def test_a_split_without_timed_words_keeps_the_text_in_the_first_part() -> None:
    before, ident = project()
    assert [s.text for s in segments(c.split_segment(before, ident, 0, 2, 3.5), ident)[2:]] == [
        "by the door",
        "",
    ]


def test_a_merge_with_a_clause_is_a_clause() -> None:
    before, ident = project()
    made = segments(c.merge_segments(before, ident, 0, 1, 2), ident)[1]
    assert made == Segment("clause", 2.5, 4.0, 3.9, "um by the door")


def test_a_new_segment_is_held_in_its_gap_and_takes_the_words_in_it() -> None:
    before, ident = project()
    after, at = c.add_segment(before, ident, 0, "response", 2.3, 1.99)
    assert (at, segments(after, ident)[1].start) == (1, 2.0)
    after, at = c.add_segment(
        c.remove_segments(before, ident, {(0, 0)}), ident, 0, "clause", 1.25, 2.2, peak=9.0
    )
    assert (at, segments(after, ident)[0].text, segments(after, ident)[0].peak) == (0, "meet here", 2.2)


def test_word_lists_label_anew_but_not_what_was_labelled_by_hand() -> None:
    before, ident = project()
    assert segments(before, ident, 1)[0].kind == "response"
    hand = c.relabel_segments(before, ident, {(0, 2)}, "response")  # the lists say a clause
    after = c.set_word_lists(hand, ident, ["um", "we meet here"], ["yeah", "yeah", " "])
    assert [s.kind for s in segments(after, ident)] == ["response", "response", "response"]
    assert segments(after, ident, 1)[0].kind == "hesitation"
    assert after.conversations[ident].hesitations == ("yeah",)
    assert [s.kind for s in segments(c.set_word_lists(after, ident, [], []), ident)] == [
        "clause",
        "clause",
        "response",
    ]


def test_each_side_may_have_lists_and_a_language_of_its_own() -> None:
    before, ident = project()
    after = c.set_word_lists(before, ident, ["ja"], ["yeah"], 1, "de")
    of = after.conversations[ident]
    assert get_word_lists(of, 1) == (("ja",), ("yeah",)) and get_word_lists(of, 0) == get_word_lists(
        before.conversations[ident], 0
    )
    assert [s.language for s in of.sides] == ["", "de"] and segments(after, ident, 1)[0].kind == "hesitation"
    assert segments(after, ident) == segments(before, ident)
    both = c.set_word_lists(after, ident, ["yeah"], ["um"], None, "en")
    assert [get_word_lists(both.conversations[ident], n) for n in (0, 1)] == [(("yeah",), ("um",))] * 2
    assert segments(both, ident, 1)[0].kind == "response"
    with pytest.raises(EditError):
        c.set_word_lists(before, ident, ["x" * 201], [], 0)


def test_what_is_said_of_both_lists_answers() -> None:
    assert c.classify_words("嗯", ["嗯", "对"], ["嗯", "呃"]) == "response"
    assert c.classify_words("हाँ।", ["हाँ"], []) == "response" and c.classify_words("ह", ["हाँ"], []) == "clause"


def test_the_language_conversations_are_read_in_is_kept() -> None:
    assert Project().language == "auto" and c.set_language(Project(), "de").language == "de"
    assert c.set_language(Project(), " ").language == "auto"


def test_words_are_compared_without_case_hyphens_and_punctuation() -> None:
    assert c.classify_words("Uh-huh, yeah!", ["uh huh", "yeah"], ["uh"]) == "response"
    assert c.classify_words("%HESITATION", [], ["%hesitation"]) == "hesitation"
    assert c.classify_words("um, right", ["right"], ["um"]) == "response"
    assert c.classify_words("um, the door", ["right"], ["um"]) == "clause"
    assert c.classify_words("...", ["right"], ["um"]) == "clause"


times = st.floats(-1, 12)


def edited(now: Project, ident: str, what: int, side: int, at: int, a: float, b: float, kind: str) -> Project:
    return (
        lambda: c.move_segment(now, ident, side, at, a),
        lambda: c.resize_segment(now, ident, side, at, start=a),
        lambda: c.resize_segment(now, ident, side, at, end=a),
        lambda: c.resize_segment(now, ident, side, at, start=a, end=b),
        lambda: c.set_peak(now, ident, side, at, a),
        lambda: c.split_segment(now, ident, side, at, a, b),
        lambda: c.merge_segments(now, ident, side, at, at + 1),
        lambda: c.add_segment(now, ident, side, kind, a, b, a)[0],
        lambda: c.remove_segments(now, ident, {(side, at), (side, 0)}),
    )[what]()


@given(
    st.lists(
        st.tuples(
            st.integers(0, 8), st.integers(0, 1), st.integers(0, 6), times, times, st.sampled_from(SPOKEN)
        ),
        max_size=25,
    )
)
def test_any_edits_keep_segments_sorted_apart_and_inside(
    steps: list[tuple[int, int, int, float, float, str]],
) -> None:
    now, ident = project()
    for step in steps:
        try:
            now = edited(now, ident, *step)
        except EditError:
            continue
        for of in now.conversations[ident].sides:
            end = 0.0
            for s in of.segments:
                assert end <= s.start < s.end <= 10.0
                assert s.end - s.start >= SHORTEST - 1e-9
                assert s.peak is None or s.start <= s.peak <= s.end
                end = s.end
    kept = msgspec.json.decode(msgspec.json.encode(now.conversations[ident]), type=Conversation)
    assert kept == now.conversations[ident]


# --- more than two


def three() -> Project:
    made = Conversation(
        name="three",
        length=9.0,
        sides=tuple(Side(name=n, segments=(Segment("clause", k, k + 1.0),)) for k, n in enumerate("abc")),
    )
    return c.add_conversation(Project(), made)[0]


def test_whom_segments_are_said_to_is_set_and_taken_back() -> None:
    project = three()
    (ident,) = project.conversations
    said = c.address_segments(project, ident, {(0, 0), (2, 0)}, 1)
    assert [s.segments[0].to for s in said.conversations[ident].sides] == [1, None, 1]
    said = c.address_segments(said, ident, {(2, 0)}, EVERYBODY)
    assert said.conversations[ident].sides[2].segments[0].to == EVERYBODY
    both = {(0, 0), (2, 0)}
    assert c.address_segments(said, ident, both, None) == project
    for to in (0, 3, -2):
        with pytest.raises(EditError, match="another speaker"):
            c.address_segments(project, ident, {(0, 0)}, to)


def test_some_of_those_who_talk_in_another_order_still_speak_to_the_same() -> None:
    project = three()
    (ident,) = project.conversations
    said = c.address_segments(project, ident, {(0, 0)}, 2)
    said = c.address_segments(said, ident, {(2, 0)}, 1)
    whole = said.conversations[ident]
    assert with_sides(whole, (0, 1, 2)) is whole
    some = with_sides(whole, (2, 0))
    assert [s.name for s in some.sides] == ["c", "a"]
    assert [s.segments[0].to for s in some.sides] == [None, 0]
    for order in ((0,), (0, 0), (1, 1, 2)):
        with pytest.raises(ValueError, match="two or more"):
            with_sides(whole, order)
