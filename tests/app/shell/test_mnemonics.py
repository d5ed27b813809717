"""Keys of menus: one for one entry, in every menu and every language."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections import Counter

import pytest

from app import translation
from app.shell.mnemonics import read_mnemonic_key, with_distinct_keys


@pytest.mark.parametrize(
    ("text", "key"),
    [("&Save", "s"), ("S&ave && go", "a"), ("R&&D", ""), ("none", ""), ("end&", ""), ("", "")],
)
def test_a_text_marks_one_key_or_none(text: str, key: str) -> None:
    assert read_mnemonic_key(text) == key


def test_the_first_keeps_a_key_and_another_has_one_of_its_other_letters() -> None:
    assert with_distinct_keys(("&Save", "&Sample", "Save &as")) == ("&Save", "Sa&mple", "Save &as")
    assert with_distinct_keys(("&Open", "&Onion skin")) == ("&Open", "Onion &skin"), (
        "beginnings of words first"
    )


def test_a_text_without_a_mark_gets_none_and_one_without_a_free_letter_loses_it() -> None:
    assert with_distinct_keys(("&a", "&A", "plain")) == ("&a", "A", "plain")
    assert with_distinct_keys(("&b", "&B && b")) == ("&b", "B && b")
    assert with_distinct_keys(()) == ()


_WINDOW = """
import json, os
from PySide6.QtWidgets import QApplication
from app import translation
translation.choose_language(None)
from app.main import make_window
app = QApplication([])
window = make_window()
window.make_late_panels()
menus = {"": [a.text() for a in window.menuBar().actions()]}
for bar in window.menuBar().actions():
    bar.menu().aboutToShow.emit()
    menus[bar.text()] = [a.text() for a in bar.menu().actions() if not a.isSeparator()]
print(json.dumps(menus), flush=True)
os._exit(0)
"""


@pytest.mark.window
@pytest.mark.parametrize(
    "code",
    [pytest.param(x, marks=() if x == "de" else pytest.mark.nightly) for x in sorted(translation.NAMES)],
)
def test_no_menu_has_a_key_twice(code: str) -> None:
    environment = {**os.environ, "METAGRAPH_LANGUAGE": code}
    done = subprocess.run(
        [sys.executable, "-c", _WINDOW], capture_output=True, text=True, timeout=120, env=environment
    )
    assert done.returncode == 0, done.stderr[-2000:]
    menus = json.loads(done.stdout.splitlines()[-1])
    assert len(menus) > 8 and sum(map(len, menus.values())) > 100
    assert menus[""][0] == {"en": "&File", "de": "&Datei", "pl": "&Plik"}[code]
    for menu, texts in menus.items():
        keys = Counter(key for text in texts if (key := read_mnemonic_key(text)))
        assert not [key for key, count in keys.items() if count > 1], (menu, texts)
