"""Figures of a report as PDF, drawn by Qt without a screen."""

from __future__ import annotations

import re

EPOCH = b"19700101000000"


def find_pdf_maker():
    """Return a function that turns the text of an SVG file into a PDF page of the same size. The same text
    gives the same bytes.
    """
    from PySide6.QtCore import QBuffer, QByteArray, QIODevice, QMarginsF, QRectF, QSizeF
    from PySide6.QtGui import QPageSize, QPainter, QPdfWriter
    from PySide6.QtSvg import QSvgRenderer

    from app.cli.screenless import make_screenless_application

    app = make_screenless_application()

    def paper(drawing: str) -> bytes:
        assert app is not None
        renderer = QSvgRenderer(QByteArray(drawing.encode()))
        wide, high = (float(v) for v in re.findall(r'(?:width|height)="([\d.]+)mm"', drawing)[:2])
        buffer = QBuffer()
        buffer.open(QIODevice.OpenModeFlag.WriteOnly)
        writer = QPdfWriter(buffer)
        writer.setResolution(300)
        writer.setCreator("metagraph")
        writer.setPageSize(QPageSize(QSizeF(wide, high), QPageSize.Unit.Millimeter, "figure"))
        writer.setPageMargins(QMarginsF(0, 0, 0, 0))
        painter = QPainter(writer)
        renderer.render(painter, QRectF(0, 0, writer.width(), writer.height()))
        painter.end()
        return strip_pdf_dates(bytes(buffer.data().data()))

    return paper


def strip_pdf_dates(content: bytes) -> bytes:
    """Return a PDF without its date and its random numbers, with the same length."""
    content = re.sub(rb"D:\d{14}", b"D:" + EPOCH, content)
    content = re.sub(rb"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d", b"1970-01-01T00:00:00", content)
    blank = lambda m: m[1] + re.sub(rb"[0-9a-fA-F]", b"0", m[2]) + m[3]  # noqa: E731
    content = re.sub(rb"(/ID \[)([^\]]*)(\])", blank, content)
    return re.sub(rb"(uuid:)([0-9a-f-]{36})()", blank, content)
