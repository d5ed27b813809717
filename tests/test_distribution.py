"""What is installed: the wheel has every file the program reads, goes by a name of its own, and plays an
export in an environment that has nothing but what the Python runtime's README names.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tomllib
import zipfile
from email import message_from_bytes
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = ("app", "metagraph", "preview", "sample_clips")
BESIDE = ("pyproject.toml", "README.md", "LICENSE")
NAME = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["name"]
LIBRARY = ("numpy", "numpy.libs", "msgspec", "yaml", "_yaml")  # packages of numpy, msgspec and pyyaml
PLAYS = """
import sys
from pathlib import Path
import metagraph
from metagraph import Character
from metagraph.engines.vectors import check_vectors
home = Path(metagraph.__file__).parent
vectors = home / "engines" / "conformance"
character = Character(vectors / "stick" / "stick.json")
asked = character.ask({"do": "gesture", "tags": ["greeting"], "layer": "arms"})
pose = character.update(0.5)
print(home, pose.rotations.shape, character.answer(asked).state, check_vectors(vectors / "sparse").failures)
assert not {"app", "preview", "PySide6"} & set(sys.modules)
"""


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel of what lies here, made without a network and without touching the sources' folder."""
    place = tmp_path_factory.mktemp("wheel")
    for name in (*PACKAGES, *BESIDE):
        try:
            (place / name).symlink_to(ROOT / name)
        except OSError:
            pytest.skip("links cannot be made here")
    made = run(sys.executable, "-c", "import setuptools.build_meta as b; b.build_wheel('out')", cwd=place)
    assert made.returncode == 0, made.stdout + made.stderr
    (found,) = (place / "out").glob("*.whl")
    return found


def run(*command: object, **options: object) -> subprocess.CompletedProcess[str]:
    environ = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
    return subprocess.run(
        [*map(str, command)], capture_output=True, text=True, timeout=120, env=environ, **options
    )  # type: ignore[call-overload]


@pytest.mark.nightly
def test_the_wheel_goes_by_a_name_that_is_nobody_elses(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as inside:
        (path,) = (n for n in inside.namelist() if n.endswith(".dist-info/METADATA"))
        told = message_from_bytes(inside.read(path))
    assert told["Name"] == NAME != "metagraph", "that one is a solver of graph algorithms"
    assert set(told.get_all("Provides-Extra")) >= {"fbx", "lab", "train", "cluster", "compiled"}


def test_nobody_is_told_to_install_another_company_s_package() -> None:
    wrong = re.compile(r"\bmetagraph\[\w+\]|\binstall\b[^\n`]*?\s['\"]?metagraph\b(?![-\w./])['\"]?")
    pages = [ROOT / "README.md", ROOT / "CHANGELOG.md", ROOT / "pyproject.toml", ROOT / "run.py"]
    pages += [p for folder in (*PACKAGES, "docs") for s in ("*.py", "*.md") for p in (ROOT / folder).rglob(s)]
    assert wrong.search("pip install --no-deps metagraph && pip") and wrong.search("run metagraph[lab]")
    assert not wrong.search("pip install metagraph-studio") and not wrong.search(
        "install it in metagraph/live"
    )
    assert [p for p in pages if wrong.search(p.read_text(encoding="utf-8"))] == []


@pytest.mark.nightly
def test_every_file_of_the_packages_is_in_the_wheel(wheel: Path) -> None:
    lies = {
        path.relative_to(ROOT).as_posix()
        for package in PACKAGES
        for path in (ROOT / package).rglob("*")
        if path.is_file()
        and "__pycache__" not in path.parts
        and path.suffix not in (".pyc", ".nbi", ".nbc")
        and not path.name.startswith(".")  # for Git, and locks of projects that other tests have open
    }
    with zipfile.ZipFile(wheel) as inside:
        held = set(inside.namelist())
    assert sorted(lies - held) == []
    for needed in (
        "metagraph/engines/metagraph.schema.json",
        "metagraph/live/live.schema.json",
        "metagraph/engines/runtimes/unity/Runtime/Core/Planner.cs",
        "metagraph/engines/runtimes/godot/addons/metagraph/plugin.cfg",
        "metagraph/engines/runtimes/javascript/index.js",
        "metagraph/engines/runtimes/cpp/conformance.cpp",
        "metagraph/engines/runtimes/unreal/Metagraph.uplugin",
        "metagraph/engines/runtimes/unreal/Source/Metagraph/Private/MetagraphCore.h",
        "sample_clips/sample.metagraph.yaml",
        "sample_clips/ada.glb",
        "sample_clips/ben.glb",
        "sample_clips/mannequin.glb",
    ):
        assert needed in held


@pytest.mark.nightly
@pytest.mark.skipif(find_spec("pip") is None, reason="pip is not here")
def test_installed_without_the_desktop_it_plays_an_export_as_the_preview_does(
    wheel: Path, tmp_path: Path
) -> None:
    made = run(sys.executable, "-m", "venv", "--without-pip", tmp_path / "fresh")
    assert made.returncode == 0, made.stderr
    programs = tmp_path / "fresh" / ("Scripts" if os.name == "nt" else "bin")
    python = programs / Path(sys.executable).name
    put = run(
        *(sys.executable, "-m", "pip", "--python", python, "--disable-pip-version-check", "install"),
        *("--no-index", "--no-deps", "--no-compile", "-q", wheel),
    )
    assert put.returncode == 0, put.stderr
    (packages,) = {Path(p) for p in (tmp_path / "fresh").rglob("site-packages")}
    for name in LIBRARY:
        spec = find_spec("numpy" if name == "numpy.libs" else name)
        assert spec is not None and spec.origin is not None
        there = Path(spec.origin).parents[1] / name
        if there.exists():
            (packages / name).symlink_to(there)
    played = run(python, "-c", PLAYS, cwd=tmp_path)
    assert played.returncode == 0, played.stderr
    assert played.stdout.split()[:1] == [str(packages / "metagraph")], "it is the wheel's own"
    assert re.search(r" \(\d+, 4\) planned \[\]\n$", played.stdout), played.stdout
    told = run(programs / "metagraph", "--version", cwd=tmp_path)
    assert told.returncode == 0 and told.stdout.startswith("metagraph "), told.stderr


def test_there_is_one_version_number(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    from app.cli.parser import main
    from app.shell.system_report import make_system_report
    from metagraph import __version__
    from metagraph.engines.export import write_project_files
    from tests.conftest import Toy

    declared = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    assert "version" in declared["project"]["dynamic"] and "version" not in declared["project"]
    assert declared["tool"]["setuptools"]["dynamic"]["version"] == {"attr": "metagraph.__version__"}
    with pytest.raises(SystemExit):
        main(["--version"])
    assert capsys.readouterr().out == f"metagraph {__version__}\n"
    assert make_system_report()["Metagraph"].startswith(f"{__version__}, ")
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert f"## [{__version__}]" in text or "## [Unreleased]" in text
    runtimes = ROOT / "metagraph" / "engines" / "runtimes"
    blender = tomllib.loads(
        (runtimes / "blender" / "metagraph_blender" / "blender_manifest.toml").read_text("utf-8")
    )
    unreal = json.loads((runtimes / "unreal" / "Metagraph.uplugin").read_text("utf-8"))
    assert blender["version"] == unreal["VersionName"] == __version__
    exported = write_project_files(Toy().project(), tmp_path).json
    assert json.loads(exported.read_text("utf-8"))["exporter"] == f"Metagraph {__version__}"
    elsewhere = [
        path
        for folder in PACKAGES
        for path in (ROOT / folder).rglob("*.py")
        if re.search(rf"""["']{re.escape(__version__)}["']""", path.read_text("utf-8"))
    ]
    assert elsewhere == [ROOT / "metagraph" / "__init__.py"], "elsewhere it is imported"
