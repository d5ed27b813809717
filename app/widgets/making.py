"""Widgets made with their properties in one call, as PySide takes them but its stubs do not tell."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypedDict, TypeVar, Unpack

W = TypeVar("W")


class Properties(TypedDict, total=False):
    """The properties of Qt's that widgets are made with here; lengths in pixels."""

    checkable: bool
    checked: bool
    headerHidden: bool
    maximumWidth: int
    rootIsDecorated: bool
    text: str
    textVisible: bool
    toolTip: str
    uniformRowHeights: bool


def make_widget(kind: Callable[..., W], *arguments: object, **properties: Unpack[Properties]) -> W:
    """Return a widget of a kind, made with its arguments and properties that the stubs of its constructor
    leave out.

    Raises AttributeError for a property that the kind has not.
    """
    return kind(*arguments, **properties)
