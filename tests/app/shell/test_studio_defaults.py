"""A studio's defaults in the window: shortcuts, what is hidden, theme and language; the user's choice wins."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import QSettings

from app.features import FEATURES, check_studio_features
from app.shell.studio_defaults import SHOW_ALL, find_hidden_commands, find_studio_shortcuts
from metagraph.common.studio import Studio, get_studio, use_studio

ROOT = Path(__file__).resolve().parents[3]
USUAL = {"export": ("Ctrl+E",), "save": ("Ctrl+S",), "note": ()}
START = """
import sys
from app.main import make_window, prepare_application, tell_news
from metagraph.common.studio import get_studio
app = prepare_application()
window = make_window()
window.show()
app.processEvents()
actions = window.shell.actions
actions.refresh()
from app.look.domain_words import COLOR_LABELS
from app.translation import get_language
tell_news(window)
print(get_language(), window.shell.stage.session.look.name, COLOR_LABELS["red"],
      actions["extras"].shortcut().toString(), actions["sample"].isVisible(), "study" in actions,
      actions["show_all"].isVisible(), window.shell.notice.text(), window.shell.settings.value("theme"), sep="|")
window.close()
"""


@pytest.fixture(autouse=True)
def fresh():
    before = get_studio()
    yield
    use_studio(before)


def test_a_shortcut_is_the_studio_s():
    use_studio(Studio(shortcuts={"export": "Ctrl+Alt+E", "save": ""}))
    assert find_studio_shortcuts(USUAL) == {"export": ("Ctrl+Alt+E",), "save": ()}
    assert get_studio().problems == ()


@pytest.mark.parametrize(
    ("shortcuts", "told"),
    [
        ({"exprot": "Ctrl+E"}, "there is no command 'exprot'"),
        ({"export": "Hello"}, "'Hello' is not a shortcut. Write it as"),
        ({"note": "Ctrl+S"}, "Ctrl+S belongs to 'save'. Give 'save' another"),
        ({"note": "Ctrl+Q", "export": "Ctrl+Q"}, "Ctrl+Q belongs to 'note'"),
    ],
)
def test_a_shortcut_that_cannot_be_is_told_and_not_used(shortcuts, told):
    path = Path("studio.yaml")
    use_studio(Studio(path=path, shortcuts=shortcuts, lines={f"shortcuts/{next(reversed(shortcuts))}": 7}))
    found = find_studio_shortcuts(USUAL)
    assert len(found) == len(shortcuts) - 1
    (problem,) = get_studio().problems
    assert problem.startswith("studio.yaml, line 7: ") and told in problem


def test_two_commands_can_swap_their_shortcuts():
    use_studio(Studio(shortcuts={"export": "Ctrl+S", "save": "Ctrl+E"}))
    assert find_studio_shortcuts(USUAL) == {"export": ("Ctrl+S",), "save": ("Ctrl+E",)}


def test_who_wants_to_sees_what_is_hidden(tmp_path):
    settings = QSettings(str(tmp_path / "s.ini"), QSettings.Format.IniFormat)
    use_studio(Studio(path=Path("s.yaml"), hidden_commands=("save", "gone")))
    assert find_hidden_commands(USUAL, settings) == {"save", "gone"}
    assert "no command 'gone'" in get_studio().problems[0]
    settings.setValue(SHOW_ALL, "true")
    assert find_hidden_commands(USUAL, settings) == frozenset()


def test_features_that_are_needed_or_unknown_are_not_hidden():
    found = check_studio_features(Studio(path=Path("s.yaml"), hidden_features=("study", "files", "nothing")))
    assert [p.split("'")[1] for p in found.problems] == ["files", "nothing"]


@pytest.mark.window
@pytest.mark.gl
def test_the_window_begins_as_the_studio_says_and_keeps_what_the_user_chose(qapp, tmp_path):
    (tmp_path / "studio.yaml").write_text(
        "language: de\ntheme: light\ncolours:\n  red: Retake\nshortcuts:\n  extras: Ctrl+Alt+E\n"
        "hide:\n  features: [study]\n  commands: [sample]\nwrong: 1\n"
    )
    environment = {
        **os.environ,
        "METAGRAPH_STUDIO": str(tmp_path / "studio.yaml"),
        "XDG_CONFIG_HOME": str(tmp_path),
        "XDG_DATA_HOME": str(tmp_path),
        "LANG": "C",
    }

    def start() -> list[str]:
        done = subprocess.run(
            [sys.executable, "-c", START],
            cwd=ROOT,
            env=environment,
            capture_output=True,
            text=True,
            timeout=120,
        )
        assert done.returncode == 0, done.stderr
        return done.stdout.strip().splitlines()[-1].split("|")

    language, theme, red, keys, sample, study, show, notice, kept = start()
    assert (language, theme, red, keys) == ("de", "light", "Retake", "Ctrl+Alt+E")
    assert (sample, study, show) == ("False", "False", "True")
    assert notice.endswith("…") and kept == "None", "a studio's theme is nobody's choice"
    settings = QSettings(str(tmp_path / "Metagraph" / "Metagraph.conf"), QSettings.Format.IniFormat)
    for key, value in (("language", "en"), ("theme", "dark"), (SHOW_ALL, "true")):
        settings.setValue(key, value)
    settings.sync()
    language, theme, _, _, sample, study, _, notice, _ = start()
    assert (language, theme, sample) == ("en", "dark", "True") and notice == "Check your studio's defaults…"


def test_each_feature_but_the_needed_ones_can_be_named():
    names = tuple(name for name in FEATURES if name not in ("files", "help"))
    assert check_studio_features(replace(Studio(), hidden_features=names)).problems == ()
