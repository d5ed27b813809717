"""The compiler that comes when it is needed: when it is asked for, by which command, and what is said where
it cannot be had.
"""

from __future__ import annotations

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Barrier
from typing import Any

import pytest

from metagraph.common import compiling
from metagraph.common.compiling import CompilerError, find_compiler
from metagraph.common.extras import EXTRAS

ROOT = Path(__file__).resolve().parents[2]


class Setup:
    """Takes the place of programs.run: notes what was started; numba is there afterwards, where it may."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, works: bool, said: str = "") -> None:
        self.started: list[list[str]] = []
        self.works, self.said, self.is_there = works, said, False
        monkeypatch.setattr(compiling, "run_program", self)
        monkeypatch.setattr(compiling, "is_numba_installed", lambda: self.is_there)

    def __call__(self, command: list[str], **more: Any) -> tuple[int, str]:
        self.started.append(command)
        self.is_there = self.works
        return 0 if self.works else 1, self.said


@pytest.fixture
def ours(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """In an environment that run.py made."""
    (tmp_path / ".installed").write_text("")
    monkeypatch.setattr(sys, "prefix", str(tmp_path))
    return tmp_path


def test_a_loop_is_compiled_by_the_options_given() -> None:
    pytest.importorskip("numba")

    @find_compiler(nogil=True)
    def twice(x: float) -> float:
        return 2 * x

    assert twice(21.0) == 42.0 and twice.targetoptions["nogil"]


def test_run_py_installs_it_into_the_environment_it_made_and_says_so(
    ours: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("numba")
    setup = Setup(monkeypatch, works=True)
    find_compiler()
    assert setup.started == [[sys.executable, "-I", str(ROOT / "run.py"), "install"]]
    said = capsys.readouterr()
    assert "Installing the compiler" in said.err and not said.out  # there may be JSON on the other
    find_compiler()
    assert len(setup.started) == 1


def test_two_threads_that_need_it_install_it_once(ours: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("numba")
    setup = Setup(monkeypatch, works=True)
    together = Barrier(2)

    def need(_: int) -> None:
        together.wait(10)
        find_compiler()

    with ThreadPoolExecutor(2) as pool:
        list(pool.map(need, range(2)))
    assert len(setup.started) == 1


def test_without_a_network_the_reason_and_the_command_for_later_are_told_and_it_is_tried_again(
    ours: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    setup = Setup(
        monkeypatch,
        works=False,
        said="trying\nERROR: No matching distribution found for numba\nThe compiler could not be installed",
    )
    for _ in range(2):
        with pytest.raises(
            CompilerError,
            match=r"found for numba\).*run\.py install",
        ):
            find_compiler()
    assert len(setup.started) == 2


def test_an_environment_of_somebody_else_is_left_alone_and_its_command_is_told(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    setup = Setup(monkeypatch, works=True)
    monkeypatch.setattr(sys, "prefix", str(tmp_path))
    with pytest.raises(CompilerError) as told:
        find_compiler()
    assert f'{sys.executable} -m pip install "numba>=' in str(told.value) and not setup.started
    monkeypatch.setattr(compiling, "ROOT", tmp_path)  # nor if there is no run.py
    (tmp_path / ".installed").write_text("")
    with pytest.raises(CompilerError, match="pip install"):
        find_compiler()
    assert not setup.started


def test_the_motion_graph_says_what_is_missing_in_its_own_words() -> None:
    """In a process of its own, which has no numba and no environment of run.py's."""
    code = (
        "import sys; sys.modules['numba'] = None; sys.prefix = '/'\n"
        "from metagraph.common.compiling import CompilerError\n"
        "try:\n    import metagraph.synthesis.kernels\nexcept CompilerError as error:\n    print(error)"
    )
    made = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True, timeout=300
    )
    assert "needs numba" in made.stdout


def test_the_range_that_is_told_is_the_one_that_is_declared() -> None:
    import tomllib

    extras = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    assert extras["compiled"] == list(EXTRAS["compiled"].wants)
