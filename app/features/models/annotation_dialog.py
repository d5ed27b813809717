"""Import an annotation: set the roles of tiers and the meanings of labels, preview the result, and choose
what to make of it.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QSettings, Qt, Signal
from PySide6.QtGui import QIcon
from PySide6.QtWidgets import (
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QFormLayout,
    QHBoxLayout,
    QInputDialog,
    QLabel,
    QLineEdit,
    QMessageBox,
    QPushButton,
    QRadioButton,
    QVBoxLayout,
    QWidget,
)

from app.features.models.meaning_choices import ChoiceTable, Entries, MeaningRow
from app.look.plural import list_in_words
from app.look.theme import KIND_MARKS, get_theme, strengthen
from app.project.annotation_reading import (
    AnnotationReading,
    apply_reading,
    begin_reading,
    describe_doubts,
)
from app.project.document import Document
from app.stage.session import StageSession
from app.translation import group_thousands, make_lazy_texts, tr, tr_context, tr_error, tr_noop, tr_plural
from app.widgets.act_strip import ActStrip, format_clock
from app.widgets.form_fields import Seconds
from app.widgets.making import make_widget
from app.widgets.quiet_fields import ComboBox
from app.widgets.within_screen import resize_within_screen
from metagraph.common.studio import find_start_folder
from metagraph.formats.elan import read_elan
from metagraph.graph.model import LAYERS, Layer
from metagraph.playback.learning.annotation import (
    IGNORE,
    PHASES,
    ROLES,
    SPEECH,
    Annotation,
    Label,
    split_meaning,
)
from metagraph.playback.learning.learn import Act

if TYPE_CHECKING:
    from app.shell.context import Shell

SAMPLE = Path(__file__).resolve().parents[3] / "sample_clips" / "annotation" / "conversation.eaf"
FILTER = tr_noop("ELAN annotations (*.eaf);;All files (*)")
MOST = 1000  # labels that can be said otherwise; those beyond are rare
REMEMBERED = 400  # tiers and labels that are kept for the next project
WORTH = 10  # acts from which a model is learned unless said otherwise
OTHER = "other"
LEGEND = make_lazy_texts(
    lambda: (("gesture", tr("gesture")), ("fidget", tr("fidget")), ("transition", tr("change of stance")))
)
ROLE_TIPS = make_lazy_texts(
    lambda: {
        "left arm": tr("What the left arm does: gestures, fidgets, changes of stance"),
        "right arm": tr("What the right arm does: gestures, fidgets, changes of stance"),
        "arms": tr("Gestures, if the annotation does not say which arm makes them"),
        "head action": tr("Nods, head shakes and similar actions"),
        "head stance": tr("How the head is held, or changes of that stance"),
        "body": tr("How body, legs and spine are held, or changes of that stance"),
        "speech": tr(
            "When the annotated person speaks. The models learn what is done while talking, "
            "listening and idle."
        ),
        "partner's speech": tr("When the partner speaks"),
    }
)
ROLE_TITLES = (
    tr_noop("Left arm"),
    tr_noop("Right arm"),
    tr_noop("Head action"),
    tr_noop("Head stance"),
    tr_noop("Partner's speech"),
    tr_noop("Ignore"),
)  # beside layers, as they are shown
ROLE_ENTRIES: Entries = make_lazy_texts(
    lambda: [(tr(role.capitalize()), role, ROLE_TIPS.get(role, "")) for role in (*ROLES, *SPEECH, IGNORE)]
)
MEANING_TIPS = make_lazy_texts(
    lambda: {
        "stance": tr("The label names the stance. The stance changes where another label begins."),
        **dict.fromkeys(PHASES, tr("A phase of a gesture. Consecutive phases form one gesture.")),
    }
)


def list_meanings(meaning: str) -> list[tuple[str, object, str]]:
    """Return the choices for the meaning of a label: words, meaning, tip. The present meaning is one of
    them.
    """
    known = [
        "gesture",
        "gesture positive",
        "gesture negative",
        "fidget",
        "transition",
        "stance",
        *PHASES,
        IGNORE,
    ]
    if meaning not in known:
        known.insert(3, meaning)
    out: list[tuple[str, object, str]] = [
        (describe_label_meaning(m), m, MEANING_TIPS.get(split_meaning(m)[0], "")) for m in known
    ]
    out.insert(
        -1,
        (
            tr("With other tags…"),
            OTHER,
            tr("A gesture with your own tags. The graph needs actions with the same tags."),
        ),
    )
    return out


def describe_label_meaning(meaning: str) -> str:
    """Return what a label means in words of the window, behind the mark of its kind."""
    first, tags = split_meaning(meaning)
    if first == IGNORE:
        return tr("Ignore")
    mark = KIND_MARKS["gesture" if first in PHASES else first]
    words = {"transition": tr("change of stance"), "stance": tr("stance held")}.get(first) or tr(first)
    return f"{mark} {', '.join((words, *map(tr, tags)))}"


class AnnotateDialog(QDialog):
    """imported: signals (layer -> acts, id of the performance or None) after the import."""

    imported = Signal(object, object)

    def __init__(
        self,
        document: Document,
        session: StageSession,
        reading: AnnotationReading,
        name: str,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self.name, self.reading = document, session, name, reading
        annotation = reading.annotation
        self.order = sorted(
            annotation.tiers,
            key=lambda t: (*SPEECH, IGNORE).count(reading.roles[t.name]) + (reading.roles[t.name] == IGNORE),
        )  # those that are read first
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Import annotation"))
        resize_within_screen(self, 1040, 780)
        self._build(annotation)
        self._show_tiers()
        self._changed(first=True)

    # --- building

    def _build(self, annotation: Annotation) -> None:
        layout = QVBoxLayout(self)
        layout.setContentsMargins(18, 16, 18, 14)
        layout.setSpacing(10)
        people = sorted({t.whose for t in annotation.tiers if t.whose})
        read = sorted({t.whose for t in annotation.tiers if t.whose and self.reading.roles[t.name] != IGNORE})
        count = sum(len(t.intervals) for t in annotation.tiers)
        facts = [
            format_clock(round(annotation.end, 1)),
            tr_plural("{count:,} tier", "{count:,} tiers", len(annotation.tiers)),
            tr_plural("{count:,} interval", "{count:,} intervals", count),
        ]
        if len(people) > 1:
            facts.append(
                tr(
                    "{people} people; these are read: {names}. You can choose another person's tiers "
                    "instead.",
                    people=len(people),
                    names=list_in_words(read) or tr("none"),
                )
            )
        title = QLabel(self.name, self)
        title.setProperty("title", True)
        layout.addWidget(title)
        self.facts = QLabel(" · ".join(facts), self, wordWrap=True)
        self.facts.setProperty("dim", True)
        layout.addWidget(self.facts)
        self._add_annotators(layout)
        tables = QHBoxLayout()
        tables.setSpacing(18)
        self.tiers = self._table(
            tables,
            tr("Meaning of the tiers"),
            (tr("Tier"), tr("Intervals"), tr("Read as")),
            138,
            5,
            lambda _: ROLE_ENTRIES,
        )
        self.labels = self._table(
            tables, tr("Meaning of the labels"),
            (tr_context("annotation", "Label"), tr("Layer"), tr("Times"), tr("Means")), 188, 6,
            lambda row: list_meanings(self.reading.labels[row].meaning),
        )  # fmt: skip
        self.tiers.chosen.connect(lambda row, role: self._set_role(self.order[row].name, role))
        self.labels.chosen.connect(lambda row, meaning: self._set_meaning(self.reading.labels[row], meaning))
        layout.addLayout(tables, 3)
        row = QHBoxLayout()
        row.setSpacing(12)
        caption = QLabel(tr("Preview"), self)
        caption.setProperty("title", True)
        row.addWidget(caption)
        marks = "    ".join(f"{KIND_MARKS[kind]} {words}" for kind, words in LEGEND)
        legend = QLabel(
            tr("{marks}    left arm: upper half, right arm: lower half, both arms: full height", marks=marks),
            self,
        )
        legend.setProperty("dim", True)
        row.addWidget(legend)
        row.addStretch(1)
        layout.addLayout(row)
        self.strip = ActStrip(self.session, self)
        self.strip.setToolTipDuration(20000)
        layout.addWidget(self.strip, 1)
        self.doubts = QLabel(self, wordWrap=True)
        layout.addWidget(self.doubts)
        layout.addLayout(self._options())
        self.buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Cancel, self)
        self.buttons.button(QDialogButtonBox.StandardButton.Cancel).setIcon(QIcon())
        self.go = QPushButton(tr("Import"), self)
        strengthen(self.go)
        self.buttons.addButton(self.go, QDialogButtonBox.ButtonRole.AcceptRole)
        self.go.setDefault(True)
        self.buttons.accepted.connect(self.accept)
        self.buttons.rejected.connect(self.reject)
        layout.addWidget(self.buttons)

    def _add_annotators(self, layout: QVBoxLayout) -> None:
        """Offer a choice of who annotated, if several people annotated the same."""
        names = self.reading.annotators
        self.annotator = ComboBox(self)
        self.annotator.setAccessibleName(tr("Annotator"))
        for name in names:
            self.annotator.addItem(name or tr("No name"), name)
        self.annotator.activated.connect(lambda _: self._set_annotator(self.annotator.currentData()))
        row = QHBoxLayout()
        label = QLabel(tr("Annotator"), self)
        label.setBuddy(self.annotator)
        for widget in (label, self.annotator):
            widget.setVisible(len(names) > 1)
            row.addWidget(widget)
        row.addStretch(1)
        layout.addLayout(row)

    def _table(
        self,
        row: QHBoxLayout,
        title: str,
        heads: tuple[str, ...],
        wide: int,
        stretch: int,
        entries: Callable[[int], Entries],
    ) -> ChoiceTable:
        box = QVBoxLayout()
        box.setSpacing(4)
        caption = QLabel(title, self)
        caption.setProperty("title", True)
        box.addWidget(caption)
        table = ChoiceTable(self.session, title, heads, wide, entries, self)
        box.addWidget(table, 1)
        row.addLayout(box, stretch)
        return table

    def _options(self) -> QFormLayout:
        form = QFormLayout()
        form.setHorizontalSpacing(18)
        form.setVerticalSpacing(8)
        row = QHBoxLayout()
        row.setSpacing(16)
        self.learn = {layer: QCheckBox(tr(layer.capitalize()), self) for layer in LAYERS}
        for box in self.learn.values():
            box.toggled.connect(self._enable)
            row.addWidget(box)
        self.smoothing = Seconds(
            self,
            tr("Added to every count, so that actions that were not seen can still happen; the paper uses 0"),
            10,
            "",
            0.1,
            1,
        )
        self.smoothing.show_value(0.0)
        row.addSpacing(12)
        row.addWidget(QLabel(tr("Smoothing"), self))
        row.addWidget(self.smoothing)
        row.addStretch(1)
        form.addRow(tr("Learn a model of"), row)
        row = QHBoxLayout()
        row.setSpacing(16)
        self.as_shares = make_widget(
            QRadioButton,
            tr("a share of all gestures"),
            self,
            toolTip=tr("A fixed share of the gestures is positive, whatever came before"),
        )
        self.as_states = make_widget(
            QRadioButton,
            tr("separate states"),
            self,
            toolTip=tr("Other actions can follow a positive gesture than follow other gestures"),
        )
        self.as_shares.setChecked(True)
        row.addWidget(self.as_shares)
        row.addWidget(self.as_states)
        row.addStretch(1)
        form.addRow(tr("Positive and negative are"), row)
        row = QHBoxLayout()
        row.setSpacing(10)
        self.keep = make_widget(
            QCheckBox,
            tr("as a performance named"),
            self,
            toolTip=tr("Plays the annotated sequence. Another seed plays it with other actions."),
        )
        self.keep.setChecked(True)
        self.keep.toggled.connect(self._enable)
        self.called = QLineEdit(Path(self.name).stem, self)
        self.called.setAccessibleName(tr("Name of the performance"))
        self.called.setMaximumWidth(280)
        self.called.textChanged.connect(self._enable)
        row.addWidget(self.keep)
        row.addWidget(self.called, 1)
        row.addStretch(1)
        form.addRow(tr("Keep the sequence"), row)
        return form

    # --- showing

    def _show_tiers(self) -> None:
        rows = []
        for tier in self.order:
            of = tr("{name} of {whose}", name=tier.name, whose=tier.whose) if tier.whose else tier.name
            some = ", ".join(x or tr("(empty)") for x in list(tier.labels)[:6])
            role = self.reading.roles[tier.name]
            tip = f"{of}: {some}" if some else tr("{of}: empty", of=of)
            rows.append(
                MeaningRow(
                    (tier.name, group_thousands(len(tier.intervals))),
                    tr(role.capitalize()),
                    role == IGNORE,
                    tip,
                )
            )
        self.tiers.show_rows(rows, tr("This annotation has no tiers."))

    def _show_labels(self) -> None:
        rows = [
            MeaningRow(
                (x.text or tr("(empty)"), tr(x.layer), group_thousands(x.count)),
                describe_label_meaning(x.meaning),
                x.meaning == IGNORE,
                x.text,
            )
            for x in self.reading.labels[:MOST]
        ]
        self.labels.show_rows(rows, tr("Choose what the tiers mean. Their labels then appear here."))

    def _changed(self, first: bool = False) -> None:
        """Show what comes of the tiers and labels as they are read now."""
        seen = self.reading.observed
        self._show_labels()
        self.strip.show_acts(seen or {"arms": ()}, max(1.0, self.reading.annotation.end))
        for layer, box in self.learn.items():
            count = len(seen.get(layer, ()))
            fresh = first or not box.isEnabled()
            box.setEnabled(count > 0)
            name = tr(layer.capitalize())
            box.setText(
                f"{name} ({tr_plural('{count:,} action', '{count:,} actions', count)})" if count else name
            )
            if fresh or not count:
                box.setChecked(count >= WORTH)
        tagged = any(act.tags for acts in seen.values() for act in acts)
        for button in (self.as_shares, self.as_states):
            button.setEnabled(tagged)
        doubts = describe_doubts(self.reading)
        self.doubts.setText("\n".join(doubts[:4]))
        self.doubts.setVisible(bool(doubts))
        self.doubts.setStyleSheet(f"color: {get_theme(self.session.look.name).warning}")
        self._enable()

    def _enable(self) -> None:
        some = any(self.reading.observed.values())
        self.called.setEnabled(self.keep.isChecked())
        kept = self.keep.isChecked() and bool(self.called.text().strip())
        wanted = any(box.isChecked() for box in self.learn.values())
        self.go.setEnabled(some and (wanted or kept) and not (self.keep.isChecked() and not kept))

    # --- choosing

    def _set_role(self, tier: str, role: str) -> None:
        self.reading = self.reading.with_role(tier, role)
        self._show_tiers()
        self._changed()

    def _set_annotator(self, name: str) -> None:
        if name in (one.annotator for one in self.reading.again):
            self.reading = self.reading.with_annotator(name)
            self._show_tiers()
            self._changed()

    def _set_meaning(self, label: Label, meaning: str) -> None:
        if meaning == OTHER:
            words, ok = QInputDialog.getText(
                self,
                tr("Tags"),
                tr("Tags of the gesture '{label}'", label=label.text),
                text=" ".join(split_meaning(label.meaning)[1]),
            )
            meaning = (
                f"gesture {' '.join(words.replace(',', ' ').casefold().split())}".strip()
                if ok
                else label.meaning
            )
        self.reading = self.reading.with_meaning(label, meaning)
        self._changed()

    def accept(self) -> None:
        """Import as one undo step, and show the performance if one is made."""
        learned = [layer for layer, box in self.learn.items() if box.isChecked()]
        name = " ".join(self.called.text().split()) if self.keep.isChecked() else None
        tagged = self.as_states.isChecked() and self.as_states.isEnabled()
        made = apply_reading(
            self.document.project, self.reading, learned, tagged, name, max(0.0, self.smoothing.value())
        )
        self.document.edit(tr("Import annotation"), lambda _: made.project)
        remember_roles("tiers", self.reading.roles)
        remember_roles("labels", made.project.labels)
        if made.performance is not None:
            self.session.onstage.set_performance(made.performance)
            self.session.transport.show_plan()
            self.session.transport.seek(0.0)
        self.imported.emit(self.reading.observed, made.performance)
        super().accept()


def recall_roles(what: str) -> dict[str, str]:
    """Return the roles of tiers (or meanings of labels) of the last import, in any project."""
    try:
        found = json.loads(str(QSettings().value(f"annotation/{what}") or "{}"))
    except ValueError:
        return {}
    return {str(k): str(v) for k, v in found.items()} if isinstance(found, dict) else {}


def remember_roles(what: str, said: Mapping[str, str]) -> None:
    """Remember roles and meanings for the next project. The oldest are forgotten first."""
    both = {k: v for k, v in recall_roles(what).items() if k not in said} | dict(said)
    QSettings().setValue(f"annotation/{what}", json.dumps(dict(list(both.items())[-REMEMBERED:])))


def open_annotation(
    shell: Shell, path: str | Path | None = None, done: Callable[[AnnotateDialog], object] | None = None
) -> None:
    """Ask for an annotation (or take `path`, "sample" for our own), read it on a thread and open the
    dialog.
    """
    if not path:
        start = str(find_start_folder(shell.document.folder))
        path, _ = QFileDialog.getOpenFileName(shell.widget, tr("Import annotation"), start, tr(FILTER))
        if not path:
            return
    file = SAMPLE if str(path) == "sample" else Path(path)

    project = shell.document.project
    tiers, labels = (project.tiers, recall_roles("tiers")), (project.labels, recall_roles("labels"))

    def work(_: object) -> AnnotationReading:
        reading = begin_reading(read_elan(file), *tiers, labels=labels)
        _ = reading.observed  # worked out here, not on the window's thread
        return reading

    def show(reading: AnnotationReading) -> None:
        dialog = AnnotateDialog(shell.document, shell.stage.session, reading, file.name, shell.widget)
        dialog.imported.connect(lambda observed, kept: _taken(shell, observed, kept))
        dialog.open()
        if done is not None:
            done(dialog)

    def failed(error: Exception) -> None:
        QMessageBox.warning(shell.widget, tr("Not imported"), tr_error(error))

    shell.jobs.start(tr("Reading {name}", name=file.name), work, show, failed)


def _taken(shell: Shell, observed: Mapping[Layer, Sequence[Act]], performance: str | None) -> None:
    count = sum(len(acts) for acts in observed.values())
    shell.tell(
        tr(
            "Read {count} from the annotation.",
            count=tr_plural("{count:,} action", "{count:,} actions", count),
        )
    )
    shell.panel("models").show_imported(observed, performance)
    shell.show("models")
