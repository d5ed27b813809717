"""Sentences that give way."""

from __future__ import annotations

import pytest

from app.widgets.sentence import Sentence

pytestmark = pytest.mark.window


def test_a_narrow_sentence_stands_on_two_lines_of_whole_words(qtbot, qapp):
    label = Sentence(None)
    qtbot.addWidget(label)
    label.show()
    line, width = label.fontMetrics().height(), label.fontMetrics().horizontalAdvance
    label.resize(width("22 Aktionen") + 10, 2 * line)
    label.say("22 Aktionen in 60 s")
    assert label.text() == "22 Aktionen\nin 60 s" and not label.toolTip()
    label.resize(width("22 Aktionen in 60 s") + 10, 2 * line)
    assert label.text() == "22 Aktionen in 60 s"
    label.resize(width("22 Aktionen") + 10, line)
    assert "\n" not in label.text() and label.text().endswith("…")
    assert label.toolTip() == "22 Aktionen in 60 s"
