"""What is left out of imports for a fast start is not missed."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def told(code: str) -> list[str]:
    """Return the lines that a fresh process prints."""
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def test_qts_signatures_are_split_when_somebody_asks_and_all_other_patterns_are_compiled_at_once():
    code = """
import re
compile_now = re.compile
import app.main
from PySide6.QtCore import QObject
from shibokensupport.signature import parser
print(type(parser.arglistParser._finditer).__name__)
print(re.compile is compile_now, type(re.compile("a")).__name__)
print(parser._parse_arglist("parent:PySide6.QtCore.QObject|None=None,name:tuple[int,str]"))
from PySide6.support.signature import get_signature
print(len(get_signature(QObject.setProperty).parameters))
try:
    QObject().setObjectName(5, 6)
except TypeError as error:
    print("setObjectName" in str(error))
"""
    assert told(code) == [
        "_Method",
        "True Pattern",
        "['parent:PySide6.QtCore.QObject|None=None', 'name:tuple[int,str]']",
        "3",
        "True",
    ]


def test_imports_ask_for_no_other_spellings_and_bring_all_of_qts_names_where_all_are_wanted():
    code = """
import app.main
print(__import__.__name__)
from PySide6.QtGui import *
print(QColor.__name__)
"""
    first, colour = told(code)
    assert first != "__feature_import__" and colour == "QColor"


def test_what_is_made_of_numpy_does_without_its_texts_of_help():
    code = """
import app.main, numpy
print(numpy.zeros.__doc__ is None)
import numpy.ma, numpy.random, numpy.testing, pyqtgraph
print(numpy.ma.array([1, 2], mask=[True, False]).mean())
"""
    assert told(code) == ["True", "2.0"]


def test_numpy_that_was_imported_before_keeps_its_texts():
    assert told("import numpy, app.main; print('zeros' in numpy.zeros.__doc__)") == ["True"]
