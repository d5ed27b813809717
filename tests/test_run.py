"""run.py: what it finds missing, what it says, what it starts. Nothing is installed here."""

from __future__ import annotations

import importlib.util
import os
import re
import shlex
import subprocess
import sys
import threading
import time
import tomllib
from itertools import pairwise
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from tests import prepare
from tests.conftest import LONG

ROOT = Path(__file__).resolve().parents[1]
ENVIRONMENT = ("PYTHONDONTWRITEBYTECODE", "PYTHONPYCACHEPREFIX", *(f"MALLOC_{x}" for x in (
    "MMAP_THRESHOLD_", "TRIM_THRESHOLD_", "ARENA_MAX"
)), "OPENBLAS_NUM_THREADS", "LP_NUM_THREADS")  # fmt: skip


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> ModuleType:
    """run.py as a module, in a folder of its own, forbidden to start anything."""
    spec = importlib.util.spec_from_file_location("run_py", ROOT / "run.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    for name in ("call", "run", "Popen"):
        monkeypatch.setattr(
            module.subprocess, name, lambda *args, **kwargs: pytest.fail(f"started {args[0]}")
        )
    for name in ENVIRONMENT:  # taken back afterwards, whatever becomes of it
        monkeypatch.setenv(name, "")
    monkeypatch.setattr(module, "ROOT", tmp_path)
    monkeypatch.setattr(module, "VENV", tmp_path / ".venv")
    monkeypatch.setattr(module, "PYTHON", tmp_path / ".venv" / "bin" / "python")
    return module


class Started(list[Any]):
    """Takes the place of subprocess.call: notes what was started and answers with given exit codes."""

    def __init__(self, *answers: int) -> None:
        super().__init__()
        self.answers = list(answers)

    def __call__(self, command: list[str], **more: Any) -> int:
        self.append([str(word) for word in command])
        self.more = more
        return self.answers.pop(0) if self.answers else 0


class Compiling:
    """Takes the place of subprocess.Popen."""

    waited = False

    def __call__(self, command: list[str], **more: Any) -> Compiling:
        assert command[1:] == ["-m", "tests.prepare"]
        return self

    def wait(self) -> int:
        self.waited = True
        return 0


class Terminal:
    def __init__(self, there: bool) -> None:
        self.there = there

    def isatty(self) -> bool:
        return self.there


def test_it_needs_nothing_but_python() -> None:
    code = (
        f"import sys; sys.path.insert(0, {str(ROOT)!r}); import run; print([m for m in sys.modules if m "
        "in ('numpy', 'yaml', 'PySide6')])"
    )
    made = subprocess.run(
        [sys.executable, "-S", "-c", code], cwd="/", capture_output=True, text=True, check=True, timeout=300
    )
    assert made.stdout.strip() == "[]"


@pytest.mark.parametrize(
    ("version", "fits"),
    [((3, 10), False), ((3, 11), True), ((3, 14), True), ((3, 15), False), ((2, 7), False)],
)
def test_the_wrong_python_is_refused_in_words(
    run: ModuleType, monkeypatch: pytest.MonkeyPatch, version: tuple[int, int], fits: bool
) -> None:
    monkeypatch.setattr(run.sys, "version_info", (*version, 0, "final", 0))
    monkeypatch.setattr(run, "system_libraries", lambda *args: "stopped here")
    monkeypatch.setattr(run, "environment", lambda *args: "stopped here")
    words = run.main([])
    assert words == "stopped here" if fits else f"this is {version[0]}.{version[1]}." in words


def test_a_complete_system_misses_nothing(run: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(run, "loads", lambda library: True)
    monkeypatch.setattr(run.shutil, "which", lambda program, path=None: "/usr/bin/" + program)
    assert run.missing(True, True) == []
    assert run.system_libraries(True, True) is None


def test_without_a_screen_only_drawing_is_needed_and_tests_need_it_all(
    run: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(run, "loads", lambda library: False)
    monkeypatch.setattr(run.shutil, "which", lambda program, path=None: None)
    assert run.missing(False, False) == ["libegl1", "libgl1"]
    assert set(run.missing(True, False)) == {*run.DRAWING.values(), *run.WINDOW.values()}
    assert set(run.missing(False, True)) == {
        *run.DRAWING.values(),
        *run.WINDOW.values(),
        "xvfb",
        "xauth",
        "xdotool",
        "espeak-ng",
    }


def test_a_library_that_cannot_be_loaded_is_missing(run: ModuleType) -> None:
    assert not run.loads("libnobody-has-this.so.9")


LINE = "sudo apt-get update && sudo apt-get install -y --no-install-recommends libegl1 libgl1"


@pytest.fixture
def bare(run: ModuleType, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """On a Debian without the drawing libraries."""
    monkeypatch.setattr(run, "loads", lambda library: False)
    monkeypatch.setattr(run.shutil, "which", lambda program, path=None: program)
    monkeypatch.setattr(run.sys, "stdin", Terminal(False))
    monkeypatch.setattr(run.os, "geteuid", lambda: 1000, raising=False)
    return run


def test_without_apt_the_line_for_debian_is_printed(
    bare: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bare.shutil, "which", lambda program, path=None: None)
    assert bare.system_libraries(False, False).endswith(LINE)


def test_without_a_terminal_to_ask_on_the_line_is_printed(bare: ModuleType) -> None:
    assert bare.system_libraries(False, False).endswith(f"\n  {LINE}")


def test_sudo_is_used_after_asking_and_not_without(bare: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bare.sys, "stdin", Terminal(True))
    monkeypatch.setattr("builtins.input", lambda words: "n")
    assert LINE in bare.system_libraries(False, False)
    monkeypatch.setattr("builtins.input", lambda words: "")
    started = Started()
    monkeypatch.setattr(bare.subprocess, "call", started)
    assert bare.system_libraries(False, False).endswith(": libegl1 libgl1")
    assert [command[:2] for command in started] == [["sudo", "apt-get"]] * 2


def test_the_administrator_is_not_asked(bare: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    started = Started()
    monkeypatch.setattr(bare.os, "geteuid", lambda: 0, raising=False)
    monkeypatch.setattr(
        bare.subprocess,
        "call",
        lambda *a, **k: (monkeypatch.setattr(bare, "loads", lambda library: True), started(*a, **k))[1],
    )
    assert bare.system_libraries(False, False) is None
    assert started[1] == ["apt-get", "install", "-y", "--no-install-recommends", "libegl1", "libgl1"]


def test_a_failed_installation_says_what_to_do(bare: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bare.os, "geteuid", lambda: 0, raising=False)
    monkeypatch.setattr(bare.subprocess, "call", Started(100))
    assert bare.system_libraries(False, False).endswith(f"\n  {LINE}")


@pytest.fixture
def pinned(run: ModuleType, tmp_path: Path) -> ModuleType:
    """With something to install."""
    for name in (*run.LISTS, "pyproject.toml"):
        (tmp_path / name).write_text(name)
    return run


def make_python(run: ModuleType) -> None:
    run.PYTHON.parent.mkdir(parents=True, exist_ok=True)
    run.PYTHON.write_text("")


def test_the_environment_is_made_once_and_again_when_what_is_pinned_changes(
    pinned: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    started = Started()
    monkeypatch.setattr(pinned.subprocess, "call", started)
    make_python(pinned)
    assert pinned.environment(0) is None
    assert any("requirements.txt" in word for word in started[1])
    assert not any("requirements-test.txt" in word for command in started for word in command)
    assert not any("requirements-compiled.txt" in word for command in started for word in command)
    count = len(started)
    assert pinned.environment(0) is None
    assert len(started) == count
    (pinned.ROOT / "requirements.txt").write_text("other")
    assert pinned.environment(0) is None
    assert len(started) > count


def listed(command: list[str]) -> list[str]:
    """Return which lists a command installs."""
    return [Path(word).name for flag, word in pairwise(command) if flag == "-r"]


def test_each_list_is_installed_with_those_before_it_and_serves_whoever_needs_less(
    pinned: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    started = Started()
    monkeypatch.setattr(pinned.subprocess, "call", started)
    make_python(pinned)
    for most in range(3):
        assert pinned.environment(most) is None
        lists = [listed(command) for command in started if listed(command)]
        assert sorted(name for names in lists for name in names) == sorted(pinned.LISTS[: most + 1])
        assert len(lists) == (2 if most == 2 else 1), "what only tests need comes at the same time"
        assert any("-e" in command for command in started) == (
            most == 0
        )  # what does not change is there already
        started.clear()
    assert pinned.environment(0) is pinned.environment(1) is None and not started
    pinned.stamp(0).unlink()
    assert pinned.environment(0) is None and not started  # all that the tests need is enough


def test_what_only_tests_need_is_installed_by_uv_and_by_pip_where_uv_fails(
    pinned: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    (pinned.ROOT / pinned.LISTS[2]).write_text("uv==1.0")
    make_python(pinned)
    for fails in (False, True):
        started: list[list[str]] = []

        def call(
            command: list[str], fails: bool = fails, started: list[list[str]] = started, **_: object
        ) -> int:
            started.append(command)
            return int(fails and "uv" in command)

        monkeypatch.setattr(pinned.subprocess, "call", call)
        assert pinned.environment(2) is None
        by = [command[2] for command in started if pinned.LISTS[2] in listed(command)]
        assert by == (["uv", "pip"] if fails else ["uv"])
        assert any("uv==1.0" in command for command in started)
        pinned.stamp(2).unlink()


def test_a_compiler_that_was_added_is_kept_up_to_date_with_the_rest(
    pinned: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    started = Started()
    monkeypatch.setattr(pinned.subprocess, "call", started)
    make_python(pinned)
    assert pinned.main(["install"]) is None
    assert listed(started[1]) == list(pinned.LISTS[:2])
    started.clear()
    assert pinned.main(["install"]) is None and not started
    (pinned.ROOT / "requirements.txt").write_text("other")
    assert pinned.environment(0) is None
    assert listed(started[1]) == list(pinned.LISTS[:2])


def test_what_is_pinned_is_pinned_once_and_names_no_place_to_load_it_from() -> None:
    names: list[str] = []
    for file in sorted(ROOT.glob("requirements*.txt")):
        lines = file.read_text().splitlines()
        assert all(
            re.fullmatch(r"[a-z0-9.-]+==[0-9][\w.]*( ; [a-z_]+ [<>!=]+ '[\w.]+')?", line) for line in lines
        ), file
        names += [f"{line.split('==')[0]} {line.partition(' ; ')[2]}" for line in lines]
    assert len(set(names)) == len(names)


def test_what_is_declared_is_pinned_in_the_list_of_those_who_need_it(run: ModuleType) -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    extras = project["optional-dependencies"]
    for name, declared in zip(
        run.LISTS, (project["dependencies"], extras["compiled"], extras["test"]), strict=True
    ):
        pinned = {line.split("==")[0] for line in (ROOT / name).read_text().splitlines()}
        missing = {re.split(r"[^\w.-]", word)[0].lower() for word in declared} - pinned
        assert missing <= ({"numba"} if name == "requirements-test.txt" else set()), name


def test_an_environment_that_cannot_be_made_leaves_nothing_and_names_the_package(
    pinned: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    failed = subprocess.CompletedProcess([], 1, "", "ensurepip is not available")
    monkeypatch.setattr(pinned.subprocess, "run", lambda *args, **kwargs: failed)
    words = pinned.environment(0)
    assert "ensurepip is not available" in words
    if sys.platform.startswith("linux"):
        assert "sudo apt-get install -y python3-venv" in words
    assert not pinned.VENV.exists()


def test_a_failed_download_is_told_and_tried_again_next_time(
    pinned: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    make_python(pinned)
    monkeypatch.setattr(pinned.subprocess, "call", Started(0, 1))
    assert "could not be installed" in pinned.environment(0)
    assert not list(pinned.VENV.glob(".installed*"))


def test_fbx_is_not_missed_where_it_cannot_be_installed(
    pinned: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    make_python(pinned)
    monkeypatch.setattr(pinned.subprocess, "call", Started(0, 0, 0, 1))
    assert pinned.environment(0) is None
    assert "FBX" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("screen", "arguments", "started"),
    [
        (True, [], ["window", "--sample"]),
        (False, [], ["demo"]),
        (True, ["check", "a.yaml"], ["check", "a.yaml"]),
        (False, ["plan", "a.yaml"], ["plan", "a.yaml"]),
    ],
)
def test_it_starts_the_window_or_the_same_job_without_one(
    run: ModuleType, monkeypatch: pytest.MonkeyPatch, screen: bool, arguments: list[str], started: list[str]
) -> None:
    if not sys.platform.startswith("linux"):
        pytest.skip("there is always a screen on this system")
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.setenv("DISPLAY", ":0") if screen else monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.setattr(run, "system_libraries", lambda *args: None)
    monkeypatch.setattr(run, "environment", lambda *args: None)
    calls = Started(5)
    monkeypatch.setattr(run.os, "execve", lambda path, command, environ: calls(command, env=environ))
    assert run.main(arguments) == 5
    assert calls[0][1:] == ["-P", "-m", "app.cli", *started]
    typed = shlex.split(calls.more["env"]["METAGRAPH_COMMAND"])
    assert typed == [Path(sys.executable).name, sys.argv[0]], "what it prints to type starts it again"


def test_the_tests_are_lint_types_imports_and_pytest_and_one_failure_is_a_failure(
    run: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(run.shutil, "which", lambda program, path=None: None)
    calls, compiling = Started(0, 0, 1, 0, 0), Compiling()
    monkeypatch.setattr(run.subprocess, "call", calls)
    monkeypatch.setattr(run.subprocess, "Popen", compiling)
    assert run.run_tests([]) == 1
    assert compiling.waited
    assert [Path(command[0]).name.removesuffix(".exe") for command in calls] == [
        "ruff",
        "ruff",
        "mypy",
        "lint-imports",
        "python",
    ]
    monkeypatch.setattr(run, "spread", lambda arguments: ["--spread"])
    calls = Started(0)
    monkeypatch.setattr(run.subprocess, "call", calls)
    assert run.run_tests(["-k", "journal"]) == 0
    assert [command[1:] for command in calls] == [["-m", "pytest", "--spread", "-k", "journal"]]


def test_engines_are_installed_meanwhile_and_only_the_tests_wait_for_them(
    run: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    order: list[str] = []
    linted = threading.Event()

    def engines() -> None:
        assert linted.wait(30), "the environment and the lint waited for the engines"
        order.append("engines")

    def call(command: list[str], **more: Any) -> int:
        order.append(Path(command[0]).name.removesuffix(".exe"))
        if order[-1] == "lint-imports":
            linted.set()
        return 0

    monkeypatch.setattr(run.os, "geteuid", lambda: 0, raising=False)
    monkeypatch.setattr(run, "engines", engines)
    monkeypatch.setattr(run, "node_packages", lambda: order.append("node packages"))
    monkeypatch.setattr(run, "environment", lambda most: order.append(f"environment {most}"))
    monkeypatch.setattr(run.subprocess, "call", call)
    monkeypatch.setattr(run.subprocess, "Popen", Compiling())
    assert run.prepare_and_test([]) == 0
    assert order == [
        "environment 2",
        "ruff",
        "ruff",
        "mypy",
        "lint-imports",
        "engines",
        "node packages",
        "python",
    ]


def test_nothing_else_is_said_while_somebody_may_be_asked(
    run: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    order: list[str] = []
    monkeypatch.setattr(run.os, "geteuid", lambda: 1000, raising=False)
    monkeypatch.setattr(run, "engines", lambda: (time.sleep(0.05), order.append("asked")))
    monkeypatch.setattr(run, "node_packages", lambda: None)
    monkeypatch.setattr(run, "environment", lambda most: order.append("environment") or "no network")
    assert run.prepare_and_test([]) == "no network"
    assert order == ["asked", "environment"]


def test_bytecode_that_is_unwanted_beside_the_sources_is_kept_with_the_tests(
    run: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYTHONDONTWRITEBYTECODE", "1")
    monkeypatch.delenv("PYTHONPYCACHEPREFIX", raising=False)
    run.keep_bytecode()
    assert "PYTHONDONTWRITEBYTECODE" not in run.os.environ
    assert Path(run.os.environ["PYTHONPYCACHEPREFIX"]) == run.ROOT / ".pytest_cache" / "bytecode"
    monkeypatch.delenv("PYTHONPYCACHEPREFIX")
    run.keep_bytecode()
    assert "PYTHONPYCACHEPREFIX" not in run.os.environ  # beside the sources, as usual


def test_what_somebody_says_of_memory_stands(run: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MALLOC_ARENA_MAX", "7")
    monkeypatch.delenv("MALLOC_TRIM_THRESHOLD_", raising=False)
    run.give_memory_back()
    assert run.os.environ["MALLOC_ARENA_MAX"] == "7" and int(run.os.environ["MALLOC_TRIM_THRESHOLD_"]) > 0


def test_each_process_has_one_thread_for_matrices_and_drawing_unless_somebody_says_otherwise(
    run: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("LP_NUM_THREADS", "3")
    monkeypatch.delenv("OPENBLAS_NUM_THREADS", raising=False)
    run.one_thread_each()
    assert run.os.environ["LP_NUM_THREADS"] == "3" and run.os.environ["OPENBLAS_NUM_THREADS"] == "1"


@pytest.mark.parametrize(
    ("arguments", "cores", "processes"),
    [
        ([], 1, 1), ([], 2, 3), ([], 16, 17), (["tests/app"], 2, 3), (["-k", "journal", "-x"], 4, 5),
        (["tests/test_run.py"], 2, 1), (["tests/test_run.py::test_it"], 2, 1), (["-n", "4"], 8, 1),
        (["-n0"], 8, 1),
        (["tests/app", "--dist=load"], 8, 1), (["-s"], 8, 1), (["--pdb"], 8, 1), (["-p", "no:xdist"], 8, 1),
    ],
)  # fmt: skip
def test_tests_are_spread_over_all_cores_unless_asked_otherwise(
    run: ModuleType, monkeypatch: pytest.MonkeyPatch, arguments: list[str], cores: int, processes: int
) -> None:
    monkeypatch.setattr(run.os, "sched_getaffinity", lambda process: set(range(cores)), raising=False)
    found = run.spread(arguments)
    assert found[:2] == (["-n", str(processes)] if processes > 1 else [])


def test_files_that_are_begun_first_are_there() -> None:
    assert [name for name in LONG if not (ROOT / "tests" / name).is_file()] == []


@pytest.mark.nightly
def test_to_prepare_the_tests_leaves_the_bytecode_that_they_are_run_from(tmp_path: Path) -> None:
    environ = {**os.environ, "PYTHONPYCACHEPREFIX": str(tmp_path / "kept")}
    environ.pop("PYTHONDONTWRITEBYTECODE", None)
    test = tmp_path / "test_it.py"
    test.write_text("def test_it():\n    assert print('it was run') is None\n")
    command = [*prepare.collected(), "-c", os.devnull, "--rootdir", str(tmp_path), str(test)]
    made = subprocess.run(command, env=environ, cwd=ROOT, capture_output=True, text=True, timeout=300)
    assert made.returncode == 0 and "it was run" not in made.stdout
    (left,) = (tmp_path / "kept").rglob("test_it.*-pytest-*.pyc")
    assert b"it was run" in left.read_bytes()


# --- engines exports are tested in


@pytest.fixture
def without(run: ModuleType, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """A Debian that has apt and nothing to test exports in."""
    monkeypatch.setattr(run.sys, "platform", "linux")
    monkeypatch.setattr(
        run.shutil, "which", lambda program, path=None: "/usr/bin/apt-get" if program == "apt-get" else None
    )
    return run


def test_what_exports_are_run_in_is_installed_as_far_as_there_is_any(
    without: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    packages = list(without.ENGINES.values())
    monkeypatch.setattr(without.os, "geteuid", lambda: 0, raising=False)
    calls = Started(0, 0)
    monkeypatch.setattr(without.subprocess, "call", calls)
    without.engines()
    assert calls[1][4:] == packages
    calls = Started(
        0, 100, *(0 for _ in packages[1:]), 100
    )  # together they fail, then the last of them alone
    monkeypatch.setattr(without.subprocess, "call", calls)
    without.engines()
    assert [command[-1] for command in calls[2:]] == packages
    assert f"({packages[-1]} could not be" in capsys.readouterr().out


def test_engines_are_not_asked_for_where_nobody_answers(
    without: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(without.os, "geteuid", lambda: 1000, raising=False)
    calls = Started()
    monkeypatch.setattr(without.subprocess, "call", calls)
    without.engines()
    assert not calls and "sudo apt-get install" in capsys.readouterr().out


def test_nothing_is_installed_where_all_engines_are_or_no_apt_is(
    run: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls = Started()
    monkeypatch.setattr(run.subprocess, "call", calls)
    for which in (lambda program, path=None: f"/usr/bin/{program}", lambda program, path=None: None):
        monkeypatch.setattr(run.shutil, "which", which)
        run.engines()
    assert not calls
