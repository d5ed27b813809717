"""What tests of the C# runtime share: Mono that compiles and runs programs, alone or many in one process."""

from __future__ import annotations

import base64
import os
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.processes import Answering

ROOT = Path(__file__).resolve().parents[2]
RUNTIME = ROOT / "metagraph" / "engines" / "runtimes" / "unity"
VECTORS = sorted(p.parent for p in (ROOT / "metagraph" / "engines" / "conformance").glob("*/vectors.json"))
STICK = ROOT / "metagraph" / "engines" / "conformance" / "stick"
CORE = sorted((RUNTIME / "Runtime" / "Core").rglob("*.cs"))

STAND_IN = Path(__file__).with_name("unity_stand_in")

needs_mono = pytest.mark.skipif(
    shutil.which("mcs") is None or shutil.which("mono") is None,
    reason="needs Mono's compiler and runtime (mcs, mono)",
)


def compiled(out: Path, *sources: Path, references: tuple[Path, ...] = ()) -> Path:
    """Compile sources, warnings as errors, at a language level that every Unity since 2019 has."""
    kind = "library" if out.suffix == ".dll" else "exe"
    command = [
        "mcs",
        "-langversion:7.2",
        "-warn:4",
        "-warnaserror",
        "-optimize",
        f"-target:{kind}",
        f"-out:{out}",
    ]
    done = subprocess.run(
        [*command, *(f"-r:{r}" for r in references), *map(str, sources)],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return out


@dataclass(frozen=True)
class UnityStandIn:
    """The package, compiled against stand-ins for Unity's types. folder: where programs lie beside it."""

    folder: Path

    @property
    def all(self) -> tuple[Path, ...]:
        return tuple(self.folder / f"{name}.dll" for name in ("metagraph", "UnityEngine", "component"))

    @property
    def editor(self) -> Path:
        return self.folder / "editor.dll"


def compile_package(core: Path) -> UnityStandIn:
    """Compile component and editor scripts beside the core."""
    made = UnityStandIn(core.parent)
    types = compiled(core.with_name("UnityEngine.dll"), STAND_IN / "UnityEngine.cs")
    scripts = [sorted((RUNTIME / part).rglob("*.cs")) for part in ("Runtime/Component", "Editor")]
    component = compiled(core.with_name("component.dll"), *scripts[0], references=(core, types))
    known = (core, types, component)
    compiled(made.editor, STAND_IN / "UnityEditor.cs", *scripts[1], references=known)
    return made


def mono(program: Path, *arguments: object, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run a program in a process of its own."""
    return subprocess.run(
        ["mono", str(program), *map(str, arguments)],
        capture_output=True, text=True, timeout=300, check=False, env={**os.environ, **environment},
    )  # fmt: skip


class Host:
    """One process that compiles and runs programs, each many times as fast as on its own."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self._host = Answering(process, 300)

    def _ask(self, *words: object) -> tuple[int, str]:
        code, said = self._host.ask("\t".join(map(str, words))).split("\t")
        return int(code), base64.b64decode(said).decode()

    def compile(self, out: Path, *sources: Path) -> None:
        """Compile a program. Raises AssertionError with what the compiler says where it cannot."""
        code, said = self._ask(
            "compile", "-langversion:7.2", "-warn:0", "-target:exe", f"-out:{out}", *sources
        )
        assert code == 0, said

    def run(self, program: Path, *arguments: object) -> tuple[int, str]:
        """Return a program's exit code, -1 for an exception, and what it printed. Programs need names of
        their own.
        """
        return self._ask("run", program, *arguments)
