"""A page of the manual, drawn in the window's look."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from PySide6.QtCore import QEvent, Qt, QTimer, QUrl
from PySide6.QtGui import (
    QImage,
    QImageReader,
    QPalette,
    QTextBlock,
    QTextBlockFormat,
    QTextCharFormat,
    QTextCursor,
    QTextDocument,
    QTextFormat,
    QTextFrameFormat,
    QTextTable,
)
from PySide6.QtWidgets import QTextBrowser, QWidget

from app.features.help.manual_pages import DOCS, anchor, format_for_qt
from app.translation import tr

MARGIN = 28
WIDEST = 860  # pixels of a line: longer ones are hard to read


class ManualBrowser(QTextBrowser):
    """Shows pages by their files' addresses, and nothing from a network."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setOpenLinks(False)
        self.setFrameShape(QTextBrowser.Shape.NoFrame)
        self.setVerticalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOn)  # else the room changes
        self.setAccessibleName(tr("Page of the manual"))
        self.anchorClicked.connect(lambda link: self._go(self.source().resolved(link)))
        self.sourceChanged.connect(self._dress)
        self._drawn = 0  # the room the page was drawn for

    def go(self, page: str, heading: str = "") -> None:
        """Show a page of the manual at a heading."""
        url = QUrl.fromLocalFile(str(DOCS / page))
        if heading:
            url.setFragment(anchor(heading))
        self._go(url)

    def _go(self, url: QUrl) -> None:
        if url.isLocalFile():
            self.setSource(url, QTextDocument.ResourceType.MarkdownResource)

    def loadResource(self, kind: int, url: QUrl | str) -> Any:
        path = Path(self.source().resolved(QUrl(url)).toLocalFile())
        if kind == QTextDocument.ResourceType.ImageResource.value:
            return self._picture(path)
        text = path.read_text(encoding="utf-8", errors="replace") if path.is_file() else ""
        words = {"note": tr("Note"), "warning": tr("Warning"), "tip": tr("Tip")}
        return format_for_qt(text, words) if path.suffix == ".md" else f"```\n{text}\n```\n"

    def _picture(self, path: Path) -> QImage:
        reader, sharp = QImageReader(str(path)), self.devicePixelRatioF()
        size, room = reader.size(), self._room()
        if size.width() > room:
            reader.setScaledSize(size * (room * sharp / size.width()))
        image = reader.read()
        image.setDevicePixelRatio(sharp if size.width() > room else 1.0)
        return image

    def _room(self) -> int:
        return max(100, min(self.viewport().width() - 2 * MARGIN, WIDEST))

    def _dress(self, url: QUrl) -> None:
        """Give a page that was just read the window's look, and go to its heading."""
        self._drawn, root = self._room(), self.document().rootFrame()
        block = self.document().begin()
        while block.isValid():
            self._dress_block(QTextCursor(block))
            self._underline_links(block)
            block = block.next()
        for table in root.childFrames():
            if isinstance(table, QTextTable):
                self._dress_table(table)
        frame = root.frameFormat()
        frame.setMargin(MARGIN)
        frame.setRightMargin(max(MARGIN, self.viewport().width() - WIDEST - MARGIN))
        root.setFrameFormat(frame)
        QTimer.singleShot(0, self, lambda: self._to_heading(url.fragment()))

    def _dress_block(self, cursor: QTextCursor) -> None:
        was, form = cursor.blockFormat(), QTextBlockFormat()
        code, quoted = was.nonBreakableLines(), was.hasProperty(QTextFormat.Property.BlockQuoteLevel)
        after = cursor.block().next().blockFormat()
        if was.headingLevel():
            form.setTopMargin(0 if was.headingLevel() == 1 else 22)
            form.setBottomMargin(8)
        elif code or quoted:
            form.setBackground(self.palette().brush(QPalette.ColorRole.Midlight))
            last = not (after.nonBreakableLines() or after.hasProperty(QTextFormat.Property.BlockQuoteLevel))
            form.setBottomMargin(14 if last else 0)
        elif cursor.currentTable() is None and "\ufffc" not in cursor.block().text():  # no picture
            form.setBottomMargin(4 if cursor.currentList() else 10)
            form.setLineHeight(128, QTextBlockFormat.LineHeightTypes.ProportionalHeight.value)
        cursor.mergeBlockFormat(form)

    def _underline_links(self, block: QTextBlock) -> None:
        """Underline links: they have the colour of other text, since colour means kind."""
        links, place = [], block.begin()
        while not place.atEnd():
            part = place.fragment()
            if part.charFormat().isAnchor():
                links.append((part.position(), part.position() + part.length()))
            place += 1
        line, cursor = QTextCharFormat(), QTextCursor(block)
        line.setFontUnderline(True)
        for first, last in links:
            cursor.setPosition(first)
            cursor.setPosition(last, QTextCursor.MoveMode.KeepAnchor)
            cursor.mergeCharFormat(line)

    def _dress_table(self, table: QTextTable) -> None:
        form, head = table.format(), QTextCharFormat()
        form.setBorderStyle(QTextFrameFormat.BorderStyle.BorderStyle_Solid)
        form.setBorder(1)
        form.setBorderBrush(self.palette().brush(QPalette.ColorRole.Mid))
        form.setBorderCollapse(True)
        form.setCellPadding(6)
        form.setBottomMargin(14)
        table.setFormat(form)
        head.setBackground(self.palette().brush(QPalette.ColorRole.Midlight))
        for column in range(table.columns()):
            table.cellAt(0, column).setFormat(head)

    def _to_heading(self, name: str) -> None:
        block = self.document().begin()
        while name and block.isValid():
            if block.blockFormat().headingLevel() and anchor(block.text()) == name:
                top = self.document().documentLayout().blockBoundingRect(block).top()
                self.verticalScrollBar().setValue(int(top) - 8)
                return
            block = block.next()

    def event(self, event: QEvent) -> bool:
        """Draw the page again where the colours or the room for pictures have changed."""
        done = super().event(event)
        colors = event.type() == QEvent.Type.PaletteChange
        if not self.source().isEmpty() and (colors or self._drawn != self._room()):
            self._drawn = self._room()
            QTimer.singleShot(0, self, self._again)
        return done

    def _again(self) -> None:
        at = self.verticalScrollBar().value()
        self.document().clear()  # with the pictures as they were
        self.reload()
        QTimer.singleShot(0, self, lambda: self.verticalScrollBar().setValue(at))
