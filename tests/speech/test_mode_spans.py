"""What a side does when: whoever hears a question and waits thinks, whoever answers in passing reacts."""

from __future__ import annotations

from metagraph.graph.conversation.model import Conversation, Segment, Side
from metagraph.speech.mode_spans import list_modes


def modes(side, *sides, length=20.0):
    made = tuple(
        Side(name=str(n), segments=tuple(Segment(k, a, b) for k, a, b in s)) for n, s in enumerate(sides)
    )
    return list(list_modes(Conversation(name="x", length=length, sides=made), side))


def test_who_answers_after_a_pause_thinks_before():
    assert modes(1, [("clause", 1.0, 4.0)], [("clause", 5.5, 8.0)]) == [
        (0.0, "idle"), (1.0, "listening"), (4.3, "thinking"), (5.5, "talking"), (8.0, "listening"),
    ]  # fmt: skip


def test_who_answers_at_once_does_not_think():
    assert "thinking" not in [m for _, m in modes(1, [("clause", 1.0, 4.0)], [("clause", 4.4, 8.0)])]


def test_who_begins_without_a_question_does_not_think():
    assert modes(0, [("clause", 3.0, 5.0)], []) == [(0.0, "idle"), (3.0, "talking"), (5.0, "listening")]


def test_a_hesitation_before_a_silence_is_thought():
    said = [("clause", 1.0, 3.0), ("hesitation", 3.5, 3.8), ("clause", 4.5, 6.0)]
    assert modes(0, said, []) == [
        (0.0, "idle"), (1.0, "talking"), (3.5, "thinking"), (4.5, "talking"), (6.0, "listening"),
    ]  # fmt: skip


def test_an_answer_in_passing_is_a_reaction_unless_it_goes_on():
    assert modes(1, [("clause", 1.0, 6.0)], [("response", 3.0, 3.4)]) == [
        (0.0, "idle"), (1.0, "listening"), (2.8, "reacting"), (4.3, "listening"),
    ]  # fmt: skip
    goes_on = modes(1, [("clause", 1.0, 2.9)], [("response", 3.0, 3.4), ("clause", 3.6, 6.0)])
    assert goes_on[-3:] == [(2.8, "reacting"), (3.6, "talking"), (6.0, "listening")]
