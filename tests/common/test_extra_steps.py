"""Extras are installed whole or not at all, seen to work, and removed with what they take."""

from __future__ import annotations

import io
import sys
import time
from pathlib import Path

import pytest

from metagraph.common import extra_steps, extras
from metagraph.common.extra_steps import ExtraError, StoppedError


@pytest.fixture
def bundle(tmp_path, monkeypatch):
    """A bundle and a home; pip is replaced by what `Pip` says."""
    (tmp_path / "program").mkdir()
    (tmp_path / "program" / "bundled").touch()
    for module in (extras, extra_steps):
        monkeypatch.setattr(module, "ROOT", tmp_path / "program")
    monkeypatch.setattr(extras, "find_user_folder", lambda kind: tmp_path / "home" / kind)
    (tmp_path / "home" / "data").mkdir(parents=True)
    monkeypatch.setattr(sys, "path", list(sys.path))
    monkeypatch.setattr(extra_steps, "_check", lambda name, folder, tell: tell(1.0, "Installed."))
    return tmp_path


class Pip:
    """Stands in for pip: writes files where it is told to, says lines, and ends with a code."""

    def __init__(self, code=0, said="", files=("made_up.py",), slow=0.0):
        self.code, self.said, self.files, self.slow = code, said, files, slow
        self.command, self.killed = [], False

    def __call__(self, command, **options):
        self.command = list(command)
        if "--target" in command:
            place = Path(command[command.index("--target") + 1])
            place.mkdir(parents=True)
            for name in self.files:
                (place / name).parent.mkdir(parents=True, exist_ok=True)
                (place / name).write_text("x = 1")
        self.stdout = self._lines() if self.slow else io.StringIO(self.said)
        return self

    def _lines(self):
        yield from self.said.splitlines()
        while not self.killed:
            time.sleep(0.01)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        return None

    def kill(self):
        self.killed = True

    def wait(self):
        return self.code


SAID = """Collecting pylsl>=1.16
  Downloading pylsl-1.18.6-py3-none-any.whl (0.5 MB)
Installing collected packages: pylsl
Successfully installed pylsl-1.18.6
"""


def test_an_extra_comes_into_a_folder_of_its_own_and_can_be_imported(bundle, monkeypatch):
    told = []
    monkeypatch.setattr(extra_steps, "start", Pip(said=SAID))
    extra_steps.install_extra("lab", lambda share, words: told.append((share, words)))
    place = extras.find_extras_folder() / "lab"
    assert (place / "made_up.py").is_file() and sys.path[-1] == str(place)
    assert [path.name for path in place.parent.parent.iterdir()] == [place.parent.name]
    assert [words for _, words in told] == [
        "Starting…",
        "Looking for pylsl…",
        "Downloading pylsl, 0.5 MB…",
        "Unpacking pylsl…",
        "Installed.",
    ]
    shares = [share for share, _ in told]
    assert shares == sorted(shares) and shares[-1] == 1.0
    assert extra_steps.remove_extra("lab") == 5 and not place.exists()
    assert str(place) not in sys.path
    assert extra_steps.remove_extra("lab") == 0, "it is gone"


def test_what_the_bundle_has_is_not_kept_twice(bundle, monkeypatch):
    (extras.ROOT / "numpy.py").touch()
    monkeypatch.setattr(extra_steps, "start", Pip(files=("numpy.py", "numba.py")))
    extra_steps.install_extra("lab")
    assert [path.name for path in (extras.find_extras_folder() / "lab").iterdir()] == ["numba.py"]


def test_what_is_needed_is_installed_once_and_said_on_the_other_stream(bundle, monkeypatch, capsys):
    monkeypatch.setattr(extra_steps, "start", Pip())
    there = []
    monkeypatch.setattr(extra_steps, "is_installed", lambda name: name in there)
    extra_steps.bring_extra("studies", "A report")
    told = capsys.readouterr()
    assert told.err.startswith("Installing scipy (35 MB") and not told.out
    assert (extras.find_extras_folder() / "studies").is_dir()
    there.append("studies")
    extra_steps.bring_extra("studies", "A report")
    assert not capsys.readouterr().err


def test_what_is_needed_and_may_not_be_installed_is_told_with_the_command(monkeypatch, capsys):
    monkeypatch.setattr(extra_steps, "is_installed", lambda name: False)
    monkeypatch.setattr(extra_steps, "can_install", lambda name: False)
    with pytest.raises(ExtraError, match=r"A report needs scipy.*35 MB to download.*pip install"):
        extra_steps.bring_extra("studies", "A report")
    assert not capsys.readouterr().err


def test_what_fails_half_way_leaves_what_was_there(bundle, monkeypatch):
    monkeypatch.setattr(extra_steps, "start", Pip())
    extra_steps.install_extra("lab")
    monkeypatch.setattr(extra_steps, "start", Pip(1, "ERROR: the server said no", ("half.py",)))
    with pytest.raises(ExtraError, match=r"the server said no.*Check the network"):
        extra_steps.install_extra("lab")
    place = extras.find_extras_folder()
    assert [path.name for path in (place / "lab").iterdir()] == ["made_up.py"]
    assert [path.name for path in place.parent.iterdir()] == [place.name]


def test_stopping_ends_pip_and_leaves_nothing(bundle, monkeypatch):
    pip = Pip(said=SAID, slow=1.0)
    monkeypatch.setattr(extra_steps, "start", pip)
    told = []
    with pytest.raises(StoppedError, match="Nothing was changed"):
        extra_steps.install_extra("lab", lambda _, words: told.append(words), lambda: len(told) > 2)
    place = extras.find_extras_folder()
    assert pip.killed and not list(place.iterdir())
    assert [path.name for path in place.parent.iterdir()] == [place.name]


def test_pip_that_hangs_is_ended(bundle, monkeypatch):
    pip = Pip(slow=1.0)
    monkeypatch.setattr(extra_steps, "start", pip)
    monkeypatch.setattr(extra_steps, "MINUTES", 0.001)
    with pytest.raises(ExtraError, match=r"more than 0\.06 s"):
        extra_steps.install_extra("lab")
    assert pip.killed


def test_from_a_folder_no_network_is_asked(bundle, monkeypatch):
    pip = Pip()
    monkeypatch.setattr(extra_steps, "start", pip)
    monkeypatch.chdir(bundle.parent)  # pip runs elsewhere
    extra_steps.install_extra("train", folder=Path(bundle.name))
    assert "--no-index" in pip.command and not [w for w in pip.command if "://" in w]
    assert pip.command[pip.command.index("--find-links") + 1] == str(bundle)


def test_an_extra_that_cannot_be_imported_is_not_kept(bundle, monkeypatch):
    monkeypatch.undo()
    (bundle / "program" / "bundled").touch()
    for module in (extras, extra_steps):
        monkeypatch.setattr(module, "ROOT", bundle / "program")
    monkeypatch.setattr(extras, "find_user_folder", lambda kind: bundle / "home" / kind)
    monkeypatch.setattr(extra_steps, "start", Pip(files=()))
    monkeypatch.setattr(extra_steps, "run_program", lambda command, seconds: (1, "OSError: no liblsl\n"))
    with pytest.raises(ExtraError, match=r"does not work here \(OSError: no liblsl\)"):
        extra_steps.install_extra("lab")
    assert not list(extras.find_extras_folder().iterdir())


def test_the_import_is_tried_in_a_process_of_its_own(tmp_path):
    from metagraph.common.programs import make_python_command, run_program

    (tmp_path / "good_one.py").write_text("")
    (tmp_path / "bad_one.py").write_text("raise OSError('its library is not here')")
    check = "metagraph.common.extra_check"
    assert run_program(make_python_command(check, "good_one", str(tmp_path)), 60) == (0, "")
    code, said = run_program(make_python_command(check, "bad_one", str(tmp_path)), 60)
    assert code == 1 and "OSError: its library is not here" in said


def test_an_extra_is_refused_where_the_disk_has_no_room(bundle, monkeypatch):
    class Full:
        free = 3e6

    monkeypatch.setattr(extra_steps.shutil, "disk_usage", lambda place: Full)
    with pytest.raises(ExtraError, match=r"has 3 MB free\. Make room"):
        extra_steps.install_extra("lab")


def test_elsewhere_the_command_is_named_and_nothing_is_run(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "prefix", str(tmp_path))
    monkeypatch.setattr(extra_steps, "start", None)
    with pytest.raises(ExtraError, match=r'pip install "pylsl'):
        extra_steps.install_extra("lab")
    with pytest.raises(ExtraError, match="pip uninstall pylsl"):
        extra_steps.remove_extra("lab")


def test_in_the_environment_of_run_py_the_pinned_versions_hold(tmp_path, monkeypatch):
    for module in (extras, extra_steps):
        monkeypatch.setattr(module, "ROOT", tmp_path)
    monkeypatch.setattr(sys, "prefix", str(tmp_path))
    for name in ("run.py", ".installed", "requirements.txt"):
        (tmp_path / name).touch()
    pip, ran = Pip(said=SAID), []
    monkeypatch.setattr(extra_steps, "start", pip)
    monkeypatch.setattr(extra_steps, "run_program", lambda *words: (ran.append(words), (0, ""))[1])
    extra_steps.install_extra("lab")
    assert pip.command[pip.command.index("--constraint") + 1] == str(tmp_path / "requirements.txt")
    assert "--target" not in pip.command and "extra_check" in " ".join(ran[0][0])


# --- extras that live apart


@pytest.fixture
def home(tmp_path, monkeypatch):
    """A home, and a Metagraph that is no bundle."""
    monkeypatch.setattr(extras, "find_user_folder", lambda kind: tmp_path / kind)
    monkeypatch.setattr(sys, "version_info", (3, 12, 1))
    return tmp_path


def test_an_extra_that_lives_apart_is_installed_anywhere_and_never_imported(home, monkeypatch):
    pip = Pip(files=extras.EXTRAS["camera"].holds)
    monkeypatch.setattr(extra_steps, "start", pip)
    assert not extras.is_installed("camera") and extras.find_extra_folder("camera") is None
    before = list(sys.path)
    extra_steps.install_extra("camera")
    folder = extras.find_extra_folder("camera")
    assert folder == home / "data" / "Metagraph" / "extras-3.12" / "camera"
    assert extras.is_installed("camera") and sys.path == before
    assert "--no-deps" in pip.command and "--constraint" not in pip.command
    assert set(extras.EXTRAS["camera"].wants) <= set(pip.command)
    extras.add_extras()
    assert sys.path == before
    assert extra_steps.remove_extra("camera") > 0 and not extras.is_installed("camera")


def test_a_package_without_its_models_is_not_kept(home, monkeypatch):
    monkeypatch.setattr(extra_steps, "start", Pip(files=["mediapipe/__init__.py"]))
    with pytest.raises(ExtraError, match="lacks the files"):
        extra_steps.install_extra("camera")
    assert not extras.is_installed("camera") and not list((home / "data" / "Metagraph").glob("*-new"))


def test_a_python_without_packages_is_told_which_there_are(home, monkeypatch):
    monkeypatch.setattr(sys, "version_info", (3, 13, 0))
    with pytest.raises(ExtraError, match=r"Python 3\.12 and older.*runs with Python 3\.13"):
        extra_steps.install_extra("camera")


def test_a_folder_that_others_write_to_is_not_used(home, monkeypatch):
    monkeypatch.setattr(extra_steps, "start", Pip(files=extras.EXTRAS["camera"].holds))
    extra_steps.install_extra("camera")
    (home / "data" / "Metagraph" / "extras-3.12" / "camera").chmod(0o777)
    assert not extras.is_installed("camera")
