"""Whose words a transcript's are, where it does not say."""

from __future__ import annotations

from metagraph.formats.conversations.words import _keep_lines_whole
from metagraph.graph.conversation.model import Word


def words(*times: tuple[float, float]) -> list[Word]:
    return [Word(text="x", start=start, end=end) for start, end in times]


def test_a_subtitle_is_not_shared_out_between_speakers_word_by_word() -> None:
    cue = words((0.0, 0.2), (0.2, 0.5), (0.5, 0.9), (1.2, 1.5))
    assert _keep_lines_whole(cue, [1, 0, 1, 0]) == [1, 1, 1, 0]


def test_words_with_times_of_their_own_stay_with_whom_they_were_heard_from() -> None:
    heard = words((0.0, 0.2), (0.25, 0.5), (0.55, 0.9))
    assert _keep_lines_whole(heard, [1, 0, 1]) == [1, 0, 1]
    assert _keep_lines_whole([], []) == []
