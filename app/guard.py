"""An error in a method that Qt calls is reported and goes no further.

PySide hands what is raised there back to whoever called Qt, and some kinds end the program with a fault of
the system's: what C code raises, such as a division by zero, beneath a call from Python into Qt. So every
class made of one of Qt's has its overrides guarded when it is made, `stand` having been called before. What
is raised goes to `sys.excepthook`, as what slots raise does; Qt is given an answer it can go on with.
"""

from __future__ import annotations

import functools
import sys
import traceback
from collections.abc import Callable
from types import CodeType, FunctionType
from typing import Any

# What Qt is given by methods that failed; those that answer nothing are in SILENT.
ANSWERS: dict[str, Callable[[], Any]] = {
    **dict.fromkeys(("event", "eventFilter", "viewportEvent", "editorEvent", "setData", "mergeWith"), bool),
    **dict.fromkeys(("hasHeightForWidth", "focusNextPrevChild", "dropMimeData", "isValid"), bool),
    "filterAcceptsRow": lambda: True,  # better one too many than none
    "lessThan": bool,
    **dict.fromkeys(
        ("rowCount", "columnCount", "count", "horizontalOffset", "verticalOffset", "childCount"), int
    ),
    "isIndexHidden": bool,
    **dict.fromkeys(("visualRect", "rect"), lambda: _qt("QtCore", "QRect")()),
    "visualRegionForSelection": lambda: _qt("QtGui", "QRegion")(),
    **dict.fromkeys(("heightForWidth", "id", "indexOfChild"), lambda: -1),
    **dict.fromkeys(("object", "window", "child", "childAt", "focusChild"), lambda: None),
    **dict.fromkeys(("data", "headerData", "createEditor", "itemAt", "takeAt", "mimeData"), lambda: None),
    **dict.fromkeys(("sizeHint", "minimumSizeHint", "minimumSize"), lambda: _qt("QtCore", "QSize")()),
    **dict.fromkeys(("text",), str),
    "role": lambda: _qt("QtGui", "QAccessible").Role.NoRole,
    "state": lambda: _qt("QtGui", "QAccessible").State(),
    "loadResource": lambda: "",  # an empty page
    **dict.fromkeys(("boundingRect",), lambda: _qt("QtCore", "QRectF")()),
    **dict.fromkeys(("index", "indexAt", "moveCursor", "parent"), lambda: _qt("QtCore", "QModelIndex")()),
    "shape": lambda: _qt("QtGui", "QPainterPath")(),
    **dict.fromkeys(("displayText", "textFromValue"), str),
    "valueFromText": float,
    "flags": lambda: _qt("QtCore", "Qt").ItemFlag.NoItemFlags,
    "expandingDirections": lambda: _qt("QtCore", "Qt").Orientation(0),
}
SILENT = frozenset(
    (
        "accept",
        "addItem",
        "setText",
        "doItemsLayout",
        "done",
        "initializeGL",
        "paint",
        "paintGL",
        "redo",
        "reject",
    )
    + (
        "resizeGL",
        "run",
        "setEditorData",
        "setGeometry",
        "setModelData",
        "sort",
        "startDrag",
        "stepBy",
        "undo",
    )
    + ("scrollContentsBy", "scrollTo", "selectAll", "setSelection", "updateGeometries")
)
_MARK = "__guarded__"


def guard_all() -> None:
    """Guard all classes that are made of Qt's from now on."""
    from shiboken6 import Shiboken

    root: Any = Shiboken.Object
    root.__init_subclass__ = classmethod(_made)


def _made(cls: Any, /, **more: Any) -> None:
    for name, function in list(vars(cls).items()):
        if isinstance(function, FunctionType) and is_overridden(cls, name):
            setattr(cls, name, guard_method(function))


def is_overridden(cls: type, name: str) -> bool:
    """Return whether a method stands in the place of one of Qt's."""
    if name.startswith("__"):
        return False
    return any(name in vars(base) for base in cls.__mro__[1:] if base.__module__.startswith("PySide6."))


def is_guarded(function: object) -> bool:
    return hasattr(function, _MARK)


def has_known_answer(name: str) -> bool:
    """Return whether it is known what Qt is told when a method of that name has failed."""
    return name in ANSWERS or name in SILENT or name.endswith("Event")


def guard_method(function: FunctionType) -> FunctionType:
    """Return a method that tells what it raises and answers all the same. It takes as many arguments as
    before: Qt leaves out what a slot does not take.
    """
    call: Any = functools.wraps(function)(_with_arguments_of(function))
    call.__defaults__, call.__kwdefaults__ = function.__defaults__, function.__kwdefaults__
    setattr(call, _MARK, True)
    guarded_one: FunctionType = call
    return guarded_one


def _with_arguments_of(function: FunctionType) -> FunctionType:
    code: CodeType = function.__code__
    names = ", ".join(code.co_varnames[: code.co_argcount])
    if code.co_flags & 0x0C or code.co_kwonlyargcount or code.co_posonlyargcount:  # *args, **kwargs
        given = taken = "*args, **kwargs"
    else:
        given = taken = names
    room = {"f__": function, "t__": functools.partial(_told, function.__name__)}
    return FunctionType(_calling(taken, given), room)


@functools.cache
def _calling(taken: str, given: str) -> CodeType:
    """Return the code of a function that calls another: many methods take the same."""
    source = (
        f"def call({taken}):\n try:\n  return f__({given})\n except Exception as e__:\n  return t__(e__)\n"
    )
    whole = compile(source, "<guard>", "exec")
    return next(part for part in whole.co_consts if isinstance(part, CodeType))


def _told(name: str, error: Exception) -> Any:
    sys.excepthook(type(error), error, error.__traceback__)
    # A painter that is left open would be closed after its widget's turn, which Qt does not survive.
    traceback.clear_frames(error.__traceback__)
    return ANSWERS[name]() if name in ANSWERS else None


def _qt(module: str, name: str) -> Any:
    return getattr(sys.modules[f"PySide6.{module}"], name)
