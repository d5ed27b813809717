"""Stands in for the person who is asked what becomes of what crashes left."""

from __future__ import annotations

import re
from typing import Any

import pytest
from PySide6.QtWidgets import QDialog, QLabel

from app.project.recovering import RecoverDialog


def answers(monkeypatch: pytest.MonkeyPatch, person: Any) -> None:
    """Let the next of the person's answers fill the dialog: a tuple of choices, None to put it off. Its words
    are kept with what was asked.
    """

    def fill(dialog: RecoverDialog) -> QDialog.DialogCode:
        words = [re.sub("<[^>]*>", " ", label.text()) for label in dialog.findChildren(QLabel)]
        person.asked.append("\n".join(words))
        wanted = person.next.pop(0)
        if wanted is None:
            return QDialog.DialogCode.Rejected
        for field, choice in zip(dialog.fields, wanted, strict=True):
            field.setCurrentIndex(field.findData(choice))
            assert field.currentData() == choice, "it is not offered"
            field.activated.emit(field.currentIndex())
        return QDialog.DialogCode.Accepted

    monkeypatch.setattr(RecoverDialog, "exec", fill)
