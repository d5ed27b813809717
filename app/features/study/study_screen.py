"""Full screens of a sitting, over everything else in the window: consent, instructions, breaks,
questionnaires, pauses, thanks.
"""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QEvent, QObject, Qt, QTimer
from PySide6.QtGui import QFont, QTextBlockFormat, QTextCharFormat, QTextCursor, QTextDocument
from PySide6.QtWidgets import (
    QApplication,
    QCheckBox,
    QFrame,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from app.features.study.study_answers import Question
from app.look.theme import get_theme, strengthen
from app.stage.session import StageSession
from app.translation import tr
from metagraph.research.study.questionnaires import Questionnaire

WIDE = 720  # pixels of a column that reads well
Run = Callable[[], object]
WITHOUT_HTML = (
    QTextDocument.MarkdownFeature.MarkdownDialectGitHub | QTextDocument.MarkdownFeature.MarkdownNoHTML
)


class StudyPage(QWidget):
    """A title, text (Markdown), what else there is, and buttons below: the last one leads on."""

    def __init__(self, title: str, text: str = "") -> None:
        super().__init__()
        self.title = QLabel(title, self)
        self.title.setProperty("page", True)
        self.title.setWordWrap(True)
        self.text = QLabel(format_markdown(text, 15), self)
        self.text.setTextFormat(Qt.TextFormat.RichText)
        self.text.setWordWrap(True)
        self.text.setVisible(bool(text))
        self.column = QVBoxLayout(self)
        self.column.setContentsMargins(24, 24, 24, 24)
        self.column.setSpacing(16)
        self.column.addWidget(self.title)
        self.column.addWidget(self.text)
        self.buttons = QHBoxLayout()
        self.buttons.addStretch(1)
        self.go: QPushButton | None = None

    def button(self, words: str, run: Run, strong: bool = False) -> QPushButton:
        """Add a button below."""
        button = QPushButton(words, self)
        button.clicked.connect(run)
        button.setMinimumSize(120, 34)
        if strong:
            strengthen(button)
            self.go = button
        self.buttons.addWidget(button)
        return button

    def finish(self) -> StudyPage:
        """Put the buttons below what was added."""
        self.column.addSpacing(8)
        self.column.addLayout(self.buttons)
        self.column.insertStretch(0, 1)  # a short page stands somewhat above the middle
        self.column.addStretch(2)
        return self


def make_text_page(title: str, text: str, go: str, run: Run) -> StudyPage:
    page = StudyPage(title, text)
    page.button(go, run, strong=True)
    return page.finish()


def make_question_page(title: str, text: str, yes: str, run: Run, no: str, back: Run) -> StudyPage:
    """Return a page with a way on and a way back."""
    page = StudyPage(title, text)
    page.button(no, back)
    page.button(yes, run, strong=True)
    return page.finish()


class ConsentPage(StudyPage):
    """Nobody goes on without having agreed."""

    def __init__(self, title: str, text: str, agreed: Run, declined: Run) -> None:
        super().__init__(title, text)
        self.tick = QCheckBox(tr("I have read this, and I agree to take part"), self)
        self.column.addWidget(self.tick)
        self.button(tr("I do not want to take part"), declined)
        go = self.button(tr("Continue"), agreed, strong=True)
        go.setEnabled(False)
        self.tick.toggled.connect(go.setEnabled)
        self.finish()


class BreakPage(StudyPage):
    """Counts a break down; it may be ended before, and last longer."""

    def __init__(self, minutes: float, run: Run) -> None:
        super().__init__(
            tr("Time for a break"), tr("Get up, look out of the window, have something to drink.")
        )
        self.left = round(minutes * 60)
        self.clock = QLabel(self)
        self.clock.setProperty("clock", True)
        self.column.addWidget(self.clock)
        self.button(tr("Continue"), run, strong=True)
        self.finish()
        self._timer = QTimer(self, interval=1000)
        self._timer.timeout.connect(self._tick)
        self._timer.start()
        self._show()

    def _tick(self) -> None:
        self.left -= 1
        self._show()

    def _show(self) -> None:
        self.clock.setText(format_minutes(self.left) if self.left > 0 else tr("Continue when you are ready."))


class ClapPage(StudyPage):
    """All white with a black number, to be found in any recording of the screen."""

    def __init__(self, number: int) -> None:
        super().__init__("")
        self.mark = QLabel(str(number), self)
        self.mark.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.mark.setMinimumHeight(500)
        self.mark.setStyleSheet("background: #ffffff; color: #000000; font-size: 240px; font-weight: 700")
        self.column.addWidget(self.mark)
        self.finish()


class QuestionsPage(StudyPage):
    """A questionnaire; what has to be answered and is not is shown when one would go on."""

    def __init__(
        self,
        asked: Questionnaire,
        about: str,
        given: dict[str, object],
        answer: Callable[[str, object], None],
        done: Run,
    ) -> None:
        super().__init__(
            asked.title or tr("Some questions"),
            "\n\n".join(filter(None, (f"**{about}**" if about else "", asked.instructions))),
        )
        self._answer, self._done = answer, done
        self.questions = [
            Question(item, n, self, given.get(item.id)) for n, item in enumerate(asked.items, 1)
        ]
        for question in self.questions:
            question.answered.connect(answer)
            self.column.addWidget(question)
        self.button(tr("Done"), self.leave, strong=True)
        self.finish()

    def leave(self) -> None:
        """Go on, or show the first question that is open."""
        open_ones = [q for q in self.questions if q.lacks]
        for question in self.questions:
            question.missing.setVisible(question in open_ones)
        if open_ones:
            first = open_ones[0]
            first.field.setFocus()
            viewport = self.parentWidget()
            area = viewport.parentWidget() if viewport is not None else None
            if isinstance(area, QScrollArea):
                area.ensureWidgetVisible(first)
            return
        for question in self.questions:
            if question.item.words and question.value:
                self._answer(question.item.id, question.value)
        self._done()


class Screen(QWidget):
    """Lies over the whole window while a page is shown, so that nothing below can be seen or used."""

    def __init__(self, window: QWidget, session: StageSession) -> None:
        super().__init__(window)
        self.covered, self.session = window, session
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)  # else nothing hides what is below
        self.place = QLabel(self)
        self.place.setProperty("dim", True)
        self.area = QScrollArea(self, widgetResizable=True)
        self.area.setFrameShape(QFrame.Shape.NoFrame)
        self.area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        outer = QVBoxLayout(self)
        outer.setContentsMargins(28, 20, 28, 12)
        outer.addWidget(self.place)
        row = QHBoxLayout()
        row.addStretch(1)
        row.addWidget(self.area, 100)
        row.addStretch(1)
        self.area.setMaximumWidth(WIDE)
        outer.addLayout(row, 1)
        self.page: StudyPage | None = None
        session.look.changed.connect(self.restyle)
        self.restyle()
        window.installEventFilter(self)
        self.hide()

    def restyle(self) -> None:
        look = get_theme(self.session.look.name)
        self.setStyleSheet(f"""
            Screen, Screen QScrollArea, Screen QScrollArea > QWidget > QWidget {{ background: {look.panel}; }}
            Screen QLabel {{ font-size: 15px; color: {look.text}; }}
            Screen QLabel[page="true"] {{ font-size: 26px; font-weight: 600; }}
            Screen QLabel[clock="true"] {{ font-size: 40px; color: {look.dim}; }}
            Screen QLabel[title="true"] {{ font-size: 15px; font-weight: 600; }}
            Screen QLabel[dim="true"] {{ font-size: 13px; color: {look.dim}; }}
            Screen QLabel[missing="true"] {{ font-size: 13px; color: {look.warning}; }}
            Screen QCheckBox, Screen QRadioButton {{ font-size: 14px; color: {look.text}; spacing: 7px; }}
            Screen QRadioButton::indicator {{ width: 14px; height: 14px; border: 1px solid {look.dim}; border-radius: 8px;
                background: {look.field}; }}
            Screen QRadioButton::indicator:checked {{ background: {look.text}; border: 4px solid {look.field}; outline: none;
                width: 8px; height: 8px; }}
            Screen QRadioButton::indicator:focus {{ border-color: {look.text}; }}
        """)

    def show_page(self, page: StudyPage, place: str = "") -> None:
        """Show a page, on top of everything."""
        self.place.setText(place)
        self.page = page
        self.area.setWidget(page)  # which deletes the one before
        self.area.verticalScrollBar().setValue(0)
        self.setGeometry(self.covered.rect())
        self.show()
        self.raise_()
        first = page.questions[0].field if isinstance(page, QuestionsPage) else page.go
        if first is not None:
            first.setFocus()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Resize:
            self.setGeometry(self.covered.rect())
        return False


def format_markdown(markdown: str, size: int) -> str:
    """Return Markdown as a label shows it, with air between paragraphs. size: of the letters, pixels.

    HTML is shown as it is written and a picture as its words: whoever wrote the study opens no file here.
    """
    document = QTextDocument()
    font = QFont(QApplication.font())
    font.setPixelSize(size)
    document.setDefaultFont(font)
    document.setMarkdown(markdown, WITHOUT_HTML)
    cursor = QTextCursor(document)
    while not (cursor := document.find("\ufffc", cursor)).isNull():  # what stands for a picture
        shown = cursor.charFormat()
        cursor.insertText(str(shown.property(shown.Property.ImageAltText) or ""), QTextCharFormat())
    cursor = QTextCursor(document)
    block = document.begin()
    while block.isValid():
        cursor.setPosition(block.position())
        shape = block.blockFormat()
        shape.setBottomMargin(
            size * 0.3 if block.textList() is not None and block.next().textList() is not None else size * 0.7
        )
        shape.setLineHeight(125, QTextBlockFormat.LineHeightTypes.ProportionalHeight.value)
        cursor.setBlockFormat(shape)
        block = block.next()
    return document.toHtml()


def format_minutes(seconds: float) -> str:
    """Return minutes and seconds."""
    whole = max(0, round(seconds))
    return f"{whole // 60}:{whole % 60:02}"
