"""What the pages of the properties are made of."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFormLayout, QVBoxLayout, QWidget

# Makes an edit by its name, see `Document.edit`; False where it cannot be made, which is reported.
Edit = Callable[..., bool]
ANY = 16_777_215  # Qt's largest height of a widget


def make_page_box(page: QWidget) -> QVBoxLayout:
    """Return the layout of a page."""
    box = QVBoxLayout(page)
    box.setContentsMargins(14, 10, 14, 14)
    box.setSpacing(8)
    return box


def add_form(box: QVBoxLayout) -> QFormLayout:
    """Add a form to a layout."""
    form = QFormLayout()
    form.setHorizontalSpacing(14)
    form.setVerticalSpacing(7)
    form.setLabelAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
    form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
    box.addLayout(form)
    return form
