"""What is requested many times in one go is done once."""

from __future__ import annotations

from PySide6.QtCore import QObject
from PySide6.QtWidgets import QApplication

from app.widgets.soon import Soon


def asked(times: int = 3) -> tuple[Soon, list[int], QObject]:
    called: list[int] = []
    owner = QObject()
    soon = Soon(lambda: called.append(len(called)), owner)
    for _ in range(times):
        soon.ask()
    return soon, called, owner


def test_it_is_called_once_when_the_event_loop_goes_on(qapp):
    _, called, _owner = asked()
    assert called == []
    QApplication.processEvents()
    QApplication.processEvents()
    assert called == [0]


def test_who_cannot_wait_has_it_at_once_and_not_again(qapp):
    soon, called, _owner = asked()
    soon.now()
    assert called == [0]
    soon.now()
    QApplication.processEvents()
    assert called == [0], "it was asked for once"
    soon.ask()
    QApplication.processEvents()
    assert called == [0, 1]


def test_what_has_been_done_elsewhere_is_not_done_again(qapp):
    soon, called, _owner = asked()
    soon.done()
    QApplication.processEvents()
    assert called == []


def test_what_is_called_may_ask_again(qapp):
    called: list[int] = []
    owner = QObject()

    def call() -> None:
        called.append(0)
        if len(called) < 3:
            soon.ask()

    soon = Soon(call, owner)
    soon.ask()
    for _ in range(4):
        QApplication.processEvents()
    assert len(called) == 3
