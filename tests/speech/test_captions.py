"""Captions: as much as can be read, a new one after a sentence or a pause, at the words' own times."""

from __future__ import annotations

from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from metagraph.graph.conversation.model import Conversation, Side, Word
from metagraph.graph.requests import Line
from metagraph.playback.life.items import Speech
from metagraph.playback.life.line_timing import LineTiming, SpokenWord
from metagraph.speech import captions as c


def words(text: str, start: float = 0.0, each: float = 0.3) -> tuple[Word, ...]:
    return tuple(
        Word(text=w, start=start + n * each, end=start + (n + 1) * each) for n, w in enumerate(text.split())
    )


def test_a_new_caption_begins_after_a_sentence_and_after_a_pause():
    some = (*words("So it is. Yes"), *words("and then", 5.0))
    assert [x.text for x in c.make_captions(some)] == ["So it is.", "Yes", "and then"]


@given(st.lists(st.text("abcdefgh", min_size=1, max_size=20), min_size=1, max_size=80))
def test_captions_hold_all_words_in_two_lines_of_42_and_never_overlap(texts):
    found = c.make_captions(words(" ".join(texts)))
    assert " ".join(x.text.replace("\n", " ") for x in found) == " ".join(texts)
    for x in found:
        lines = x.text.split("\n")
        assert len(lines) <= c.LINES and all(len(line) <= c.LINE for line in lines)
    assert all(x.end <= y.start + 1e-9 for x, y in pairwise(found))


def test_a_short_word_stands_long_enough_to_be_seen():
    (found,) = c.make_captions([Word(text="Yes.", start=2.0, end=2.2)])
    assert found.end == 2.0 + c.BRIEFEST


def test_words_come_from_what_a_synthesiser_told_or_a_textgrid(tmp_path):
    told = LineTiming((SpokenWord("so", 0.1), SpokenWord("it", 0.4, 0.6)))
    speech = Speech("r1", 2.0, 4.0, timing=told)
    assert [(w.text, w.start, w.end) for w in c.list_timed_words(speech, {})] == [
        ("so", 2.1, 2.4),
        ("it", 2.4, 2.6),
    ]
    grid = tmp_path / "x.TextGrid"
    grid.write_text(
        'File type = "ooTextFile"\nObject class = "TextGrid"\n\n0\n1\n<exists>\n1\n'
        '"IntervalTier"\n"words"\n0\n1\n3\n'
        '0\n0.2\n""\n0.2\n0.6\n"so"\n0.6\n1\n"what"\n'
    )
    some = {"7": c.describe_line(Line(phones="x.TextGrid"), tmp_path)}
    said = c.list_timed_words(Speech("r2", 5.0, 5.7, line="7"), some)
    assert [(w.text, w.start, w.end) for w in said] == [("so", 5.2, 5.6), ("what", 5.6, 5.7)]
    assert c.describe_line(Line(phones="none.TextGrid"), tmp_path) == c.describe_line(Line(), tmp_path) == ()


def test_a_text_without_times_is_shared_out_over_what_it_takes():
    found = c.make_captions_of_text(Speech("r1", 1.0, 9.0), "One two three. Four five six.")
    assert [x.text for x in found] == ["One two three.", "Four five six."] and found[1].end == 9.0


def test_all_who_talk_have_captions_and_both_are_read_at_once():
    sides = (Side(name="Ada", words=words("so it was")), Side(name="Bo", words=words("yes", 0.2)))
    found = c.make_conversation_captions(Conversation(name="x", length=4.0, sides=sides))
    assert [x.side for x in c.find_captions_at(found, 0.5)] == [0, 1] and c.find_captions_at(found, 3.0) == []
