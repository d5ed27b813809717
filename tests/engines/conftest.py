"""What several engines are tested with."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from metagraph.graph.model import Project
from tests.engines import csharp_runtime, godot_runtime, javascript_runtime
from tests.made_once import made_once
from tests.processes import started
from tests.thorough import many

ROOT = Path(__file__).resolve().parents[2]


SHARE = many(3, 1)  # of the sample's cases one in so many is played; the shipped vectors have all of a kind
NOTICING = ("head: holds and preparations", "nods")  # what mutants are found with


@pytest.fixture(scope="session")
def sample_export(sample: Project, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder called sample: the sample project's export with its character, and vectors. Written once;
    tests change copies.
    """
    from metagraph.engines.export import export_project
    from metagraph.engines.reading import read_export
    from metagraph.engines.vectors import list_cases, write_vectors

    def make(folder: Path) -> None:
        path = export_project(sample, folder, character=ROOT / "sample_clips" / "mannequin.glb").json
        every = enumerate(list_cases(read_export(path, resolved=True)))
        write_vectors(path, [case for n, case in every if n % SHARE == 0 or case.name in NOTICING])

    return made_once(tmp_path_factory, "sample", make)


@pytest.fixture(scope="session")
def cpp_probe(sample: Project, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A program that does in C++ what a test says: one for all, since to compile takes longer than to run."""
    from tests.engines import cpp_program

    def make(folder: Path) -> None:
        cpp_program.make_probe(folder, cpp_program.every_part(sample))

    return made_once(tmp_path_factory, "cpp", make) / "probe"


@pytest.fixture(scope="session")
def single(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where folders with the vectors of single cases are made."""
    return tmp_path_factory.mktemp("single")


@pytest.fixture(scope="module")
def host(tmp_path_factory: pytest.TempPathFactory) -> Iterator[csharp_runtime.Host]:
    program = csharp_runtime.compiled(
        tmp_path_factory.mktemp("host") / "host.exe", Path(__file__).parent / "run" / "Host.cs"
    )
    with started("mono", program, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
        yield csharp_runtime.Host(process)


@pytest.fixture(scope="session")
def csharp_core(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The C# runtime as a library, for all programs that use it."""

    def make(folder: Path) -> None:
        csharp_runtime.compiled(folder / "metagraph.dll", *csharp_runtime.CORE)

    return made_once(tmp_path_factory, "csharp", make) / "metagraph.dll"


@pytest.fixture(scope="module")
def core(csharp_core: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The library in a folder of one's own, since programs lie beside it."""
    return Path(shutil.copy(csharp_core, tmp_path_factory.mktemp("unity")))


@pytest.fixture(scope="module")
def unity(core: Path) -> csharp_runtime.UnityStandIn:
    """The Unity package, compiled against stand-ins for Unity's types."""
    return csharp_runtime.compile_package(core)


@pytest.fixture(scope="session")
def rare(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with an export and vectors of what few exports need."""
    return made_once(tmp_path_factory, "rare", javascript_runtime.make_rare)


@pytest.fixture
def game(tmp_path: Path) -> Path:
    """A Godot project with the addon."""
    folder = tmp_path / "game"
    godot_runtime.install_addon(folder)
    (folder / "project.godot").write_text('config_version=4\n\n[application]\n\nconfig/name="test"\n')
    return folder
