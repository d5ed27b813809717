"""Widgets made with their properties."""

import pytest
from PySide6.QtWidgets import QLabel, QPushButton, QToolButton, QWidget

from app.widgets.making import make_widget


def test_a_property_a_widget_has_not_is_refused(qtbot):
    with pytest.raises(AttributeError, match="rootIsDecorated"):
        make_widget(QLabel, rootIsDecorated=True)


def test_a_widget_has_its_parent_words_and_properties(qtbot):
    parent = QWidget()
    qtbot.addWidget(parent)
    button = make_widget(QPushButton, "Go", parent, toolTip="Let it go")
    switch = make_widget(QToolButton, parent, text="On", checkable=True)
    assert (button.parent(), button.text(), button.toolTip()) == (parent, "Go", "Let it go")
    assert (switch.parent(), switch.text(), switch.isCheckable()) == (parent, "On", True)
