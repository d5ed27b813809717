"""The import dialog: what is guessed, corrected, doubted, taken over and remembered."""

from __future__ import annotations

import dataclasses

import pytest
from PySide6.QtCore import QSettings, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QInputDialog

from app.features.models.annotation_dialog import (
    REMEMBERED,
    SAMPLE,
    AnnotateDialog,
    describe_label_meaning,
    list_meanings,
    recall_roles,
    remember_roles,
)
from app.project.annotation_reading import begin_reading
from app.project.document import Document
from app.stage.session import StageSession
from metagraph.formats.elan import read_elan
from metagraph.playback.learning.annotation import (
    MEANINGS,
    Annotation,
    AnnotationInterval,
    AnnotationTier,
    is_meaning,
)


@pytest.fixture
def document(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    document = Document()
    yield document
    document.close_journal()


@pytest.fixture
def open_dialog(document, qtbot):
    def inner(annotation: Annotation, name: str = "talk.eaf") -> AnnotateDialog:
        session = StageSession(document)
        reading = begin_reading(
            annotation,
            document.project.tiers,
            recall_roles("tiers"),
            labels=(document.project.labels, recall_roles("labels")),
        )
        dialog = AnnotateDialog(document, session, reading, name)
        dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, False)  # the test looks at it afterwards
        qtbot.addWidget(dialog)
        dialog.show()
        return dialog

    return inner


def tier(name: str, *texts: str, participant: str = "") -> AnnotationTier:
    return AnnotationTier(
        name, tuple(AnnotationInterval(n, n + 0.5, t) for n, t in enumerate(texts)), participant
    )


def rows(table) -> list[tuple[str, ...]]:
    return [(*row.cells, row.chosen) for row in table.rows]


def test_every_meaning_has_words_of_its_own_and_odd_ones_are_among_what_can_be_chosen():
    assert len({describe_label_meaning(m) for m in MEANINGS}) == len(MEANINGS)
    for meaning in (*MEANINGS, "gesture positive", "gesture calm and slow", "fidget calm"):
        values = [value for _, value, _ in list_meanings(meaning)]
        assert meaning in values
        assert sum(not is_meaning(str(v)) for v in values) == 1, "but for the question for tags"


def test_the_sample_is_read_without_a_word(open_dialog, document):
    dialog = open_dialog(read_elan(SAMPLE))
    assert rows(dialog.tiers)[0] == ("Left arm", "30", "Left arm")
    assert rows(dialog.tiers)[-1] == ("Speech", "11", "Speech"), "what is no motion comes last"
    assert ("nodding", "head", "33", "▲ gesture, positive") in rows(dialog.labels)
    assert {layer: box.text() for layer, box in dialog.learn.items()} == {
        "body": "Body (12 actions)", "arms": "Arms (52 actions)", "head": "Head (46 actions)",
    }  # fmt: skip
    assert all(box.isChecked() for box in dialog.learn.values())
    assert dialog.called.text() == "talk" and dialog.go.isEnabled() and dialog.as_states.isEnabled()
    assert "12 actions" in dialog.doubts.text()
    dialog.as_states.setChecked(True)
    told = []
    dialog.imported.connect(lambda observed, kept: told.append((observed, kept)))
    dialog.accept()
    project = document.project
    assert document.undo_stack.count() == 1 and document.undo_stack.undoText() == "Import annotation"
    assert set(project.markov) == {"body", "arms", "head"} and project.markov["head"].tags
    assert [p.name for p in project.performances.values()] == ["talk"]
    assert told == [(dialog.reading.observed, next(iter(project.performances)))]
    assert dialog.session.onstage.performance == told[0][1], "it is on stage"
    document.undo()
    assert document.project.markov == {} and document.project.tiers == {}


def test_cancelling_changes_and_remembers_nothing(open_dialog, document):
    dialog = open_dialog(read_elan(SAMPLE))
    dialog.tiers.chosen.emit(0, "body")
    dialog.reject()
    assert document.undo_stack.count() == 0 and recall_roles("tiers") == {}


def test_nothing_that_is_read_is_said_and_cannot_be_imported(open_dialog):
    dialog = open_dialog(Annotation((tier("speech", "hello"),)))
    assert not dialog.go.isEnabled()
    assert "tier" in dialog.doubts.text()
    assert not any(box.isEnabled() for box in dialog.learn.values()) and not dialog.as_shares.isEnabled()
    assert dialog.labels.topLevelItem(0).text(0).startswith("Choose what the tiers mean")
    dialog.tiers.chosen.emit(0, "left arm")
    assert dialog.go.isEnabled(), "to be kept"
    assert dialog.learn["arms"].text() == "Arms (1 action)" and not dialog.learn["arms"].isChecked(), (
        "one is no model"
    )
    dialog.keep.setChecked(False)
    assert not dialog.go.isEnabled() and not dialog.called.isEnabled()
    dialog.learn["arms"].setChecked(True)
    assert dialog.go.isEnabled()
    dialog.keep.setChecked(True)
    dialog.called.setText("  ")
    assert not dialog.go.isEnabled(), "a performance needs a name"


def test_another_annotators_tiers_are_offered_and_read_when_chosen(open_dialog):
    first = dataclasses.replace(tier("LH", "gesture", "gesture"), annotator="AK")
    second = dataclasses.replace(tier("LH again", "fidget"), annotator="BM")
    dialog = open_dialog(Annotation((first, second)))
    assert "AK is read" in dialog.doubts.text() and "LH again" in dialog.doubts.text()
    assert [dialog.annotator.itemText(n) for n in range(dialog.annotator.count())] == ["AK", "BM"]
    assert dialog.annotator.isVisibleTo(dialog)
    dialog.annotator.setFocus()
    QTest.keyClick(dialog.annotator, Qt.Key.Key_Down)
    assert dialog.reading.roles == {"LH": "ignore", "LH again": "left arm"}
    assert "BM is read" in dialog.doubts.text()
    assert rows(dialog.labels) == [("fidget", "arms", "1", "◆ fidget")]
    QTest.keyClick(dialog.annotator, Qt.Key.Key_Up)
    assert dialog.reading.roles == {"LH": "left arm", "LH again": "ignore"}
    alone = open_dialog(Annotation((first,)))
    assert not alone.annotator.isVisibleTo(alone), "nothing to choose"


def test_an_annotation_without_tiers_opens_too(open_dialog):
    dialog = open_dialog(Annotation())
    assert dialog.tiers.topLevelItemCount() == 1 and "no tier" in dialog.tiers.topLevelItem(0).text(0)
    assert not dialog.go.isEnabled()


def test_what_a_label_means_is_said_otherwise(open_dialog, monkeypatch):
    dialog = open_dialog(Annotation((tier("LH", "cup", "cup", "rest"),)))
    assert rows(dialog.labels) == [("cup", "arms", "2", "▲ gesture"), ("rest", "arms", "1", "Ignore")]
    dialog.labels.chosen.emit(0, "fidget")
    assert rows(dialog.labels)[0][-1] == "◆ fidget"
    assert {a.kind for a in dialog.strip.acts["arms"]} == {"fidget"}
    asked = []
    monkeypatch.setattr(
        QInputDialog, "getText", lambda *a, **k: (asked.append(a[2]), (" Calm, slow ", True))[1]
    )
    dialog.labels.chosen.emit(0, "other")
    assert len(asked) == 1 and "'cup'" in asked[0]
    assert rows(dialog.labels)[0][-1] == "▲ gesture, calm, slow"
    monkeypatch.setattr(QInputDialog, "getText", lambda *a, **k: ("x", False))
    dialog.labels.chosen.emit(0, "other")
    assert rows(dialog.labels)[0][-1] == "▲ gesture, calm, slow", "cancelled"


def test_corrections_are_remembered_by_the_project_and_for_the_next_one(open_dialog, document):
    annotation = Annotation((tier("LH", "cup", "gesture"), tier("B", "cup")))
    dialog = open_dialog(annotation)
    dialog.tiers.chosen.emit(1, "body")
    dialog.labels.chosen.emit([r[0] for r in rows(dialog.labels)].index("cup"), "fidget")
    dialog.accept()
    assert document.project.tiers == {"LH": "left arm", "B": "body"} == recall_roles("tiers")
    assert document.project.labels == {"arms: cup": "fidget"} == recall_roles("labels")
    document.undo()
    again = open_dialog(annotation)
    assert rows(again.tiers) == [("LH", "2", "Left arm"), ("B", "1", "Body")], (
        "though the project knows no more of it"
    )
    assert ("cup", "arms", "1", "◆ fidget") in rows(again.labels)


def test_memory_is_bounded_and_nonsense_in_it_is_forgotten():
    remember_roles("tiers", {f"t{n}": "body" for n in range(REMEMBERED)})
    remember_roles("tiers", {"new": "arms", "t3": "ignore"})
    found = recall_roles("tiers")
    assert (
        len(found) == REMEMBERED and found["new"] == "arms" and found["t3"] == "ignore" and "t0" not in found
    )
    for nonsense in ("[1]", "{", "3", '{"a": 3}'):
        QSettings().setValue("annotation/tiers", nonsense)
        assert all(isinstance(v, str) for v in recall_roles("tiers").values())


def test_of_several_people_it_is_told_who_is_read(open_dialog):
    dialog = open_dialog(
        Annotation((tier("LH", "beat", participant="A"), tier("LH 2", "beat", "beat", participant="B")))
    )
    assert "2 people; these are read: B." in dialog.facts.text()
