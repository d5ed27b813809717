"""How programs are started: by one module, by their whole path, with nothing of the working folder."""

from __future__ import annotations

import ast
import os
import stat
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from metagraph.common import programs

ROOT = Path(__file__).resolve().parents[2]
PRODUCT = ("app", "metagraph", "preview")
STARTER = "metagraph/common/programs.py"

# What starts a program, and who may, with the reason.
STARTS = {
    "subprocess": ("run", "Popen", "call", "check_call", "check_output", "getoutput", "getstatusoutput"),
    "os": ("system", "popen", "startfile", "fork", "forkpty", "posix_spawn", "posix_spawnp"),
    "asyncio": ("create_subprocess_exec", "create_subprocess_shell"),
    "shutil": ("which",),  # along PATH
}
MODULES = ("multiprocessing", "pty", "webbrowser", "concurrent.futures.process", "ctypes.util")
NAMES = ("QProcess", "ProcessPoolExecutor", "ForkServer")
SYSTEM_LIBRARIES = {
    None,
    "kernel32",
    "libEGL.so.1",
    "libc.so.6",
    "libm.so.6",
}  # by names that the system knows
OPENS = {
    "app/project/reveal.py",
    "app/features/export/export_dialog.py",
    "app/features/help/news_dialog.py",
}  # a folder; a page of this program's own; the https page of a release, by a click
LOOKS = {"app/cli/system_libraries.py"}  # whether the system has libraries that it lists by name
UNPICKLES = {  # from a process that this program started
    "app/features/character/character_portraits.py",
    "app/stage/picture_process.py",
    "app/stage/thumbnails.py",
    "metagraph/playback/played_poses.py",
    "metagraph/playback/watching_child.py",
    "preview/drawing_child.py",
}


def _sources() -> Iterator[tuple[str, ast.Module]]:
    for folder in PRODUCT:
        for path in sorted((ROOT / folder).rglob("*.py")):
            if path.is_relative_to(ROOT / "app" / "bundle"):
                continue  # whoever makes a bundle runs it; nothing of the program imports it
            yield path.relative_to(ROOT).as_posix(), ast.parse(path.read_text(encoding="utf-8"))


def _misuses(name: str, tree: ast.Module) -> Iterator[str]:
    for node in ast.walk(tree):
        line = f"{name}:{getattr(node, 'lineno', 0)}"
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            module = node.module or ""
            names = [module, *(f"{module}.{alias.name}" for alias in node.names)]
            starting = STARTS.get(module, ())
            for alias in node.names:
                if alias.name in NAMES or alias.name in starting or _starts(module, alias.name):
                    yield f"{line} imports {module}.{alias.name}"
        else:
            names = []
        for found in names:
            if any(found == module or found.startswith(module + ".") for module in MODULES):
                yield f"{line} imports {found}"
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            called, of = node.func.attr, node.func.value
            owner = of.id if isinstance(of, ast.Name) else ""
            if called in STARTS.get(owner, ()) or _starts(owner, called) or owner in NAMES:
                yield f"{line} calls {owner}.{called}"
            if (
                called in ("load", "loads")
                and owner in ("pickle", "marshal", "dill")
                and name not in UNPICKLES
            ):
                yield f"{line} calls {owner}.{called}"
            if (owner, called) in (("torch", "load"), ("yaml", "load"), ("yaml", "unsafe_load")):
                yield f"{line} calls {owner}.{called}"
            if called in ("CDLL", "WinDLL", "PyDLL", "OleDLL", "LoadLibrary"):
                first = node.args[0] if node.args else None
                known = isinstance(first, ast.Constant) and first.value in SYSTEM_LIBRARIES
                if not known and name not in LOOKS:
                    yield f"{line} loads a library"
            if called == "openUrl" and name not in OPENS:
                yield f"{line} calls openUrl"
            for word in node.keywords:
                if word.arg == "allow_pickle" and not (
                    isinstance(word.value, ast.Constant) and word.value.value is False
                ):
                    yield f"{line} allows pickles"


def _starts(module: str, name: str) -> bool:
    return module == "os" and name.startswith(("exec", "spawn"))


@pytest.mark.nightly
def test_one_module_starts_all_programs() -> None:
    found = [said for name, tree in _sources() if name != STARTER for said in _misuses(name, tree)]
    assert not found, "use metagraph/common/programs.py: " + "; ".join(found)


@pytest.mark.parametrize(
    "text",
    [
        "import subprocess\nsubprocess.run(['ps'])",
        "from subprocess import Popen",
        "import os\nos.execvp('ps', ['ps'])",
        "from os import spawnl",
        "import multiprocessing",
        "from multiprocessing import get_context",
        "from concurrent.futures import ProcessPoolExecutor",
        "from PySide6.QtCore import QProcess",
        "import shutil\nshutil.which('npm')",
        "import ctypes\nctypes.CDLL('libanything.so')",
        "import numpy as np\nnp.load('x', allow_pickle=True)",
        "import pickle\npickle.loads(b'')",
        "import webbrowser",
    ],
)
def test_the_walk_finds_what_it_is_for(text: str) -> None:
    assert list(_misuses("app/some.py", ast.parse(text)))


@pytest.mark.parametrize("command", [["ps"], ["./ps"], ["bin/ps"]])
def test_a_program_without_its_folder_is_refused(command: list[str]) -> None:
    with pytest.raises(ValueError, match="has no folder"):
        programs.start(command)


def test_a_child_finds_what_its_parent_does_and_nothing_of_the_working_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "known_here.py").write_text(
        "import os, sys\nimport metagraph, numpy\n"
        "print(metagraph.__file__, os.getcwd(), sys.flags.isolated, sys.argv[1:], __name__, sys.path)"
    )
    (tmp_path / "numpy.py").write_text("raise SystemExit('the wrong one')")
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path / "elsewhere"))
    for entry in (str(tmp_path), "", "."):
        monkeypatch.syspath_prepend(entry)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    code, said = programs.run_program(programs.make_python_command("known_here", "a b", ""))
    assert code == 0, said
    assert (
        str(ROOT / "metagraph" / "__init__.py") in said
        and f" {programs.find_working_folder()} 1 ['a b', '']" in said
    )
    assert "__main__" in said and f"'{tmp_path}'" not in said


def test_variables_that_name_code_are_not_passed_on(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    code = ("PYTHONPATH", "PYTHONSTARTUP", "PYTHONHOME", "NODE_OPTIONS", "NODE_PATH", "LD_PRELOAD",
            "LD_AUDIT", "BASH_ENV", "ENV", "GIT_SSH_COMMAND", "DYLD_INSERT_LIBRARIES", "ESBUILD_BINARY_PATH",
            "NPM_CONFIG_NODE_OPTIONS", "npm_config_script_shell", "PERL5OPT", "RUBYOPT")  # fmt: skip
    for name in code:
        monkeypatch.setenv(name, str(tmp_path))
    monkeypatch.setenv("PATH", os.pathsep.join(["", ".", "bin", str(tmp_path)]))
    monkeypatch.setenv("LD_LIBRARY_PATH", os.pathsep.join(["", "lib", "/opt/lib"]))
    monkeypatch.setenv("DISPLAY", ":7")
    given = programs.make_program_environment({"OURS": "1"})
    assert not set(code) & set(given)
    assert given["DISPLAY"] == ":7" and given["OURS"] == "1"
    if os.name != "nt":
        assert given["LD_LIBRARY_PATH"] == "/opt/lib"
    places = given["PATH"].split(os.pathsep)
    assert all(Path(place).is_absolute() for place in places) and str(tmp_path) not in places


def test_path_loses_the_working_folder_where_a_program_begins(monkeypatch: pytest.MonkeyPatch) -> None:
    here = str(ROOT)
    monkeypatch.setenv("PATH", os.pathsep.join(["", here, ".", "bin", ""]))
    programs.leave_working_folder()
    assert os.environ["PATH"] == here


def test_programs_begin_in_an_empty_folder_of_the_users(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    for name in ("XDG_CACHE_HOME", "LOCALAPPDATA", "HOME"):
        monkeypatch.setenv(name, str(tmp_path / "home"))
    place = programs.find_working_folder()
    assert place.is_dir() and not list(place.iterdir()) and place.is_relative_to(tmp_path)
    if os.name != "nt":
        assert stat.S_IMODE(place.stat().st_mode) == 0o700


def test_a_folder_that_others_wrote_to_is_closed_to_them_or_not_used(tmp_path: Path) -> None:
    if os.name == "nt":
        pytest.skip("modes are POSIX's")
    (tmp_path / "metagraph" / "x").mkdir(parents=True)
    (tmp_path / "metagraph" / "x").chmod(0o777)
    assert programs.make_own(tmp_path / "metagraph" / "x")
    assert stat.S_IMODE((tmp_path / "metagraph" / "x").stat().st_mode) == 0o755
    tmp_path.chmod(0o777)  # others could put another folder in its place
    assert not programs.make_own(tmp_path / "metagraph" / "x")


@pytest.mark.parametrize(("mode", "own"), [(0o600, True), (0o644, True), (0o622, False), (0o666, False)])
def test_a_file_is_read_to_be_run_only_if_nobody_else_could_write_it(
    tmp_path: Path, mode: int, own: bool
) -> None:
    if os.name == "nt":
        pytest.skip("modes are POSIX's")
    path = tmp_path / "code"
    path.write_bytes(b"run me")
    path.chmod(mode)
    assert (programs.read_own(path, 100) == b"run me") == own
    assert programs.read_own(path, 5) is None
    (tmp_path / "link").symlink_to(path)
    assert programs.read_own(tmp_path / "link", 100) is None
    assert programs.read_own(tmp_path / "none", 100) is None


def test_systems_programs_are_not_looked_for_along_path(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    if os.name == "nt":
        pytest.skip("for programs of POSIX")
    fake = tmp_path / "only-there"
    fake.write_text("#!/bin/sh\n")
    fake.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert programs.find_system_program("only-there") is None
    assert programs.find_system_program("sh") in ("/bin/sh", "/usr/bin/sh")
    monkeypatch.setattr(programs, "_system_places", lambda: iter([tmp_path]))
    assert programs.find_system_program("only-there") == str(fake)
    fake.chmod(0o777)
    assert programs.find_system_program("only-there") is None


def test_a_program_that_takes_too_long_is_ended() -> None:
    with pytest.raises(TimeoutError, match=r"more than 0\.2 s"):
        programs.run_program([sys.executable, "-c", "import time; time.sleep(60)"], 0.2)


@pytest.mark.nightly
def test_numba_takes_no_settings_from_the_working_folder(tmp_path: Path) -> None:
    """It would load compiled code, which is pickled, from wherever a file there says."""
    pytest.importorskip("numba")
    (tmp_path / ".numba_config.yaml").write_text(f"cache_dir: {tmp_path / 'hostile'}\n")
    code = (
        "from metagraph.common.compiling import find_compiler\nfrom numba.core import config\n"
        "find_compiler()\nconfig.reload_config()\nprint(repr(config.CACHE_DIR))"
    )
    environ = {**os.environ, "PYTHONPATH": str(ROOT)}
    said = subprocess.run(
        [sys.executable, "-P", "-c", code],
        cwd=tmp_path,
        env=environ,
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert said.returncode == 0 and "hostile" not in said.stdout, said
