"""The commands in a folder that somebody prepared: nothing that lies there, or beside the project or the
export, is run, whatever it is called.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from metagraph.engines.targets import web_tools
from tests.engines.web_tools_kept import kept_web_tools

ROOT = Path(__file__).resolve().parents[2]
KAYDARA = b"Kaydara FBX Binary  \x00\x1a\x00" + (7400).to_bytes(4, "little")

MODULES = sorted({
    *(name for name in sys.stdlib_module_names if not name.startswith("_")),
    "app", "av", "conftest", "glcontext", "metagraph", "moderngl", "msgspec", "numba", "numpy", "pip", "PIL",
    "preview", "PySide6", "pyqtgraph", "sample_clips", "setuptools", "sitecustomize", "soundfile", "soxr",
    "torch", "ufbx", "usercustomize", "websockets", "yaml",
})  # fmt: skip
PROGRAMS = (
    "node", "npm", "npx", "esbuild", "ffmpeg", "git", "ps", "pip", "pip3", "python", "python3", "xdg-open",
    "gio", "kde-open", "gnome-open", "open", "explorer", "gcc", "cc", "ld", "ldconfig", "objdump", "sh",
    "bash", "env", "nice", "uname", "lsb_release", "which", "apt-get", "sudo", "portaudio-config", "file",
)  # fmt: skip

HELPERS = """
import queue, sys, time
from pathlib import Path
from metagraph.common import programs
from metagraph.common.child_channel import Child
from metagraph.live.relay import Relay
from metagraph.live.server import Options

done = {}
for module in ("app.stage.picture_process", "metagraph.formats.fbx.child", "metagraph.generation.training",
               "preview.drawing_child", "metagraph.live.relay_child"):
    done[module] = programs.run_program(programs.make_python_command(module), 100)
relay = Relay(Options(port=0, osc=None))
relay.start()
assert relay._in.get(timeout=60)  # that it is ready
relay.close(wait=True)
for name in ("npm", "ps", "explorer", "open", "git"):
    found = programs.find_system_program(name)
    assert found is None or not found.startswith(str(Path.cwd())), found
from metagraph.formats import locking
locking._machine = lambda: ""  # as where there is no /proc, so that `ps` is asked
locking._started(1)
from app.project import reveal
reveal.reveal(Path.cwd() / "gone" / "x.bvh") if sys.argv[1:] else None
print("all started", {m: code for m, (code, _) in done.items()})
"""


def _prepare(folder: Path, ran: Path) -> None:
    """Put into a folder what would be run if anything looked for it there. Who is run leaves a file in
    `ran`.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for name in MODULES:
        (folder / f"{name}.py").write_text(
            f"open({str(ran / f'module-{name}')!r}, 'w').close()\nraise ImportError\n"
        )
    places = (".", ".venv/bin", "bin", "node_modules/.bin", "venv/bin", ".venv/Scripts")
    programs = {f"{place}/{name}": name for place in places for name in PROGRAMS}
    programs |= {f"node_modules/@esbuild/{system}/bin/esbuild": "esbuild" for system in web_tools.PROGRAMS}
    programs["node_modules/esbuild/bin/esbuild"] = "esbuild"
    for place, name in programs.items():
        path = folder / place
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"#!/bin/sh\n: > '{ran}/program-{name}'\nexit 1\n")
        path.chmod(0o755)
    for name in web_tools.NEEDED:
        path = folder / "node_modules" / "three" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("export const hostile = 1;\n")
    (folder / "pyvenv.cfg").write_text(f"home = {folder}\n")
    (folder / ".venv" / "pyvenv.cfg").write_text(f"home = {folder}\n")
    (folder / ".npmrc").write_text(f"script-shell={folder}/sh\nnode-options=--require {folder}/x.js\n")
    (folder / "package.json").write_text('{"scripts": {"preinstall": "./sh", "install": "./sh"}}')
    (folder / ".numba_config.yaml").write_text(f"cache_dir: {folder}\n")
    (folder / "pip.conf").write_text(f"[global]\nfind-links = {folder}\n")
    (folder / "x.js").write_text(f"require('fs').writeFileSync('{ran}/node-required', '')\n")


@pytest.fixture
def hostile(tmp_path: Path, few: Path) -> tuple[Path, Path, dict[str, str]]:
    """The folder with a project and clips, where files appear when something was run, and the environment."""
    if os.name == "nt":
        pytest.skip("fakes are POSIX's")
    folder, ran, home = tmp_path / "work", tmp_path / "ran", tmp_path / "home"
    for place in (ran, home):
        place.mkdir()
    for place in (folder, folder / "project", folder / "project" / "out"):
        _prepare(place, ran)
    shutil.copytree(few.parent, folder / "project" / "few", dirs_exist_ok=True)
    (folder / "project" / "clips").mkdir()
    (folder / "project" / "clips" / "a.fbx").write_bytes(KAYDARA)
    environ = {
        **os.environ,
        "PATH": os.pathsep.join(["", ".", "bin", os.environ["PATH"], ""]),
        "HOME": str(home),
        "XDG_CACHE_HOME": str(home / "cache"),
        "XDG_CONFIG_HOME": str(home / "config"),
        "XDG_DATA_HOME": str(home / "data"),
        "QT_QPA_PLATFORM": "offscreen",
        "NODE_PATH": ".",
        "OPENBLAS_NUM_THREADS": "1",
        "LP_NUM_THREADS": "1",
    }
    environ.pop("PYTHONPATH", None)
    return folder, ran, environ


def _run(folder: Path, environ: dict[str, str], *words: str) -> subprocess.CompletedProcess[str]:
    """Run a command of ours in a folder, as the installed `metagraph` does: without the folder in its
    path.
    """
    code = f"import sys; sys.path.insert(0, {str(ROOT)!r}); from app.cli.parser import main; sys.exit(main())"
    return subprocess.run(
        [sys.executable, "-P", "-c", code, *words],
        cwd=folder, env=environ, capture_output=True, text=True, timeout=300,
    )  # fmt: skip


def _was_run(ran: Path) -> list[str]:
    return sorted(path.name for path in ran.iterdir())


def test_the_fakes_are_run_by_what_looks_for_them(hostile: tuple[Path, Path, dict[str, str]]) -> None:
    folder, ran, environ = hostile
    subprocess.run(
        [sys.executable, "-c", "import json"], cwd=folder, env=environ, capture_output=True, timeout=60
    )
    subprocess.run(["node"], cwd=folder, env=environ, capture_output=True, timeout=60)
    assert {"module-json", "program-node"} <= set(_was_run(ran))


@pytest.mark.nightly
@pytest.mark.parametrize(
    "words",
    [
        ("import", "new.metagraph.yaml", "project/clips"),
        ("label", "project/few", "--no-pictures", "--play", "0"),
        ("check", "project/few/{few}"),
        ("info", "project/few/{few}"),
        ("export", "project/few/{few}", "-o", "project/out/plain"),
        ("export", "project/few/{few}", "-t", "web", "-o", "project/out/web"),
        pytest.param(("render", "project/few/{few}", "-o", "x.png", "-s", "2"), marks=pytest.mark.gl),
        pytest.param(
            ("render", "project/few/{few}", "-o", "x.mp4", "-s", "1", "--size", "64x48"), marks=pytest.mark.gl
        ),
        ("--help",),
    ],
    ids=lambda words: " ".join(words[:1]) + ("-web" if "web" in words else "") + words[-1][-4:].strip("/{}"),
)
def test_commands_run_nothing_of_it(
    hostile: tuple[Path, Path, dict[str, str]], few: Path, words: tuple[str, ...]
) -> None:
    folder, ran, environ = hostile
    done = _run(folder, environ, *(word.format(few=few.name) for word in words))
    assert "Traceback" not in done.stderr, done.stderr
    assert done.returncode in (0, 3) or words[0] == "import", done.stderr  # the FBX file is broken
    assert not _was_run(ran)


@pytest.mark.nightly
def test_an_export_with_the_bundler_at_hand_runs_that_one(
    hostile: tuple[Path, Path, dict[str, str]], few: Path
) -> None:
    folder, ran, environ = hostile
    kept = Path(environ["XDG_CACHE_HOME"]) / "metagraph" / f"web-{web_tools.THREE}-{web_tools.ESBUILD}"
    with kept_web_tools(kept):
        done = _run(
            folder, environ, "export", f"project/few/{few.name}", "-t", "web", "-o", "project/out/web"
        )
    assert done.returncode in (0, 3), done.stderr
    assert not _was_run(ran)
    content = (folder / "project" / "out" / "web" / "metagraph-character.js").read_bytes()
    assert len(content) > 500_000 and b"hostile" not in content


@pytest.mark.nightly
def test_helpers_run_nothing_of_it(hostile: tuple[Path, Path, dict[str, str]]) -> None:
    folder, ran, environ = hostile
    code = f"import sys; sys.path.insert(0, {str(ROOT)!r})\n" + HELPERS
    done = subprocess.run(
        [sys.executable, "-P", "-c", code],
        cwd=folder,
        env=environ,
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0 and "all started" in done.stdout, done.stderr
    assert not _was_run(ran)


def test_the_window_runs_nothing_of_it(hostile: tuple[Path, Path, dict[str, str]]) -> None:
    """It shows a folder, for which Qt looks for a program along PATH."""
    folder, ran, environ = hostile
    code = (
        f"import sys; sys.path.insert(0, {str(ROOT)!r})\n"
        "from pathlib import Path\n"
        "from app.main import prepare_application\napp = prepare_application()\n"
        "from app.project.reveal import open_folder, reveal\n"
        "reveal(Path.cwd() / 'gone' / 'x.bvh')\nopen_folder(Path.cwd())\n"
        "open_folder(Path.cwd() / 'node')\nprint('shown')\n"
    )
    done = subprocess.run(
        [sys.executable, "-P", "-c", code],
        cwd=folder,
        env=environ,
        capture_output=True,
        text=True,
        timeout=100,
    )
    assert "shown" in done.stdout, done.stderr
    assert not _was_run(ran)


@pytest.mark.nightly
def test_setting_up_runs_nothing_of_it(hostile: tuple[Path, Path, dict[str, str]]) -> None:
    """run.py, started in such a folder, makes an environment: as far as that goes without a network."""
    folder, ran, environ = hostile
    place = folder.parent / "checkout"
    for name in (
        "run.py",
        "requirements.txt",
        "requirements-compiled.txt",
        "requirements-test.txt",
        "pyproject.toml",
    ):
        place.mkdir(exist_ok=True)
        shutil.copy(ROOT / name, place)
    (place / "requirements.txt").write_text("nothing-of-this-name-0 @ file:///nowhere\n")
    done = subprocess.run(
        [sys.executable, str(place / "run.py"), "install"],
        cwd=folder, env=environ, capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert "could not be installed" in done.stderr + done.stdout or "could not be made" in done.stderr, done
    assert not _was_run(ran)
