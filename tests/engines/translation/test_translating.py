"""What is translated says the same in every language, and the runtimes hold what is translated."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from metagraph.engines.translation.__main__ import ATTRIBUTES, mark_generated
from metagraph.engines.translation.gesture_word_lists import make_gesture_word_modules
from metagraph.engines.translation.listing import LISTING, NATIVE, RUNTIMES, Translated
from metagraph.engines.translation.lowering import convert_module
from metagraph.engines.translation.printing import TranslationError
from metagraph.engines.translation.source import SourceModule, SubsetError
from metagraph.engines.translation.translating import print_modules, read_modules, read_typed_modules
from tests.engines import cpp_program
from tests.engines.translation import every_means
from tests.unchanged import only_when_changed

pytestmark = only_when_changed("translation")

HERE = Path(__file__).parent
ROOT = HERE.parents[2]
MEANS = [f.__name__ for f in every_means.MEANS]
SAID = [f() for f in every_means.MEANS]


EVERY = Translated("tests.engines.translation.every_means", "every_means")


@pytest.fixture(scope="module")
def sources() -> dict[Translated, SourceModule]:
    """What is translated and the module of all means, read at once: to read takes most of the time."""
    return read_typed_modules([*LISTING, EVERY], ROOT)


def test_the_runtimes_hold_what_is_translated_today(sources: dict[Translated, SourceModule]) -> None:
    """Else: `.venv/bin/python -m metagraph.engines.translation`."""
    made = print_modules({one: convert_module(sources[one]) for one in LISTING}, NATIVE)
    assert not [path for path, text in made.items() if (RUNTIMES / path).read_text(encoding="utf-8") != text]
    every = [*(RUNTIMES / path for path in made), *make_gesture_word_modules()]
    assert ATTRIBUTES.read_text() == mark_generated(every), "who reads a change need not read these"


@pytest.fixture(scope="module")
def means(sources: dict[Translated, SourceModule]) -> dict[str, str]:
    """The module of all means, in each language."""
    wanted = ("MEANS",)
    one, source = EVERY, sources[EVERY]
    names = {n for d in source.tree.defs for n in [getattr(d, "name", "")] if n} | {"STEP", "WORDS"}
    source.only = tuple(names - set(wanted))
    return {
        Path(path).suffix: text for path, text in print_modules({one: convert_module(source)}, {}).items()
    }


def test_javascript_says_the_same(means: dict[str, str], tmp_path: Path) -> None:
    if shutil.which("node") is None:
        pytest.skip("needs Node")
    (tmp_path / "every_means.mjs").write_text(means[".js"].replace("basics.js", "basics.mjs"))
    shutil.copy(RUNTIMES / "javascript" / "basics.js", tmp_path / "basics.mjs")
    calls = ", ".join(f"m.{name}()" for name in MEANS)
    code = f"import * as m from './every_means.mjs'; for (const said of [{calls}]) console.log(said);"
    (tmp_path / "all.mjs").write_text(code)
    done = subprocess.run(["node", "all.mjs"], cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert _plain(done.stdout) == SAID, done.stderr


@pytest.mark.nightly
def test_csharp_says_the_same(means: dict[str, str], tmp_path: Path) -> None:
    if shutil.which("mcs") is None or shutil.which("mono") is None:
        pytest.skip("needs Mono's compiler and runtime (mcs, mono)")
    (tmp_path / "EveryMeans.cs").write_text(means[".cs"])
    calls = "\n".join(f"System.Console.WriteLine(Metagraph.EveryMeansRules.{_pascal(n)}());" for n in MEANS)
    (tmp_path / "All.cs").write_text(f"static class All {{ static void Main() {{ {calls} }} }}")
    core = [RUNTIMES / "unity" / "Runtime" / "Core" / name for name in ("Basics.cs", "Language.cs")]
    command = ["mcs", "-langversion:7.2", "-out:all.exe", "EveryMeans.cs", "All.cs", *map(str, core)]
    made = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert made.returncode == 0, made.stdout + made.stderr
    done = subprocess.run(["mono", "all.exe"], cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert _plain(done.stdout) == SAID, done.stderr


@pytest.mark.nightly
def test_cpp_says_the_same(means: dict[str, str], tmp_path: Path) -> None:
    if shutil.which("g++") is None:
        pytest.skip("needs g++")
    (tmp_path / "every_means.hpp").write_text(means[".hpp"])
    calls = "\n".join(f"    std::cout << metagraph::every_means::{name}() << std::endl;" for name in MEANS)
    (tmp_path / "all.cpp").write_text(
        f'#include <iostream>\n#include "every_means.hpp"\nint main() {{\n{calls}\n}}\n'
    )
    places = (f"-I{tmp_path}", f"-I{cpp_program.RUNTIME}")
    program = cpp_program.compiled(tmp_path / "all.cpp", tmp_path / "all", *places)
    assert cpp_program.ran(program).stdout.splitlines() == SAID


def test_gdscript_says_the_same(means: dict[str, str], tmp_path: Path) -> None:
    engine = shutil.which("godot3-server") or shutil.which("godot3")
    if engine is None:
        pytest.skip("needs Godot 3")
    (tmp_path / "every_means.gd").write_text(means[".gd"])
    shutil.copy(RUNTIMES / "godot" / "addons" / "metagraph" / "core" / "util.gd", tmp_path)
    (tmp_path / "project.godot").write_text("config_version=4\n")
    calls = "\n".join(f"\tprint(Means.{name}())" for name in MEANS)
    script = (
        f'extends SceneTree\nconst Means = preload("every_means.gd")\n\n\nfunc _init():\n{calls}\n\tquit()\n'
    )
    (tmp_path / "all.gd").write_text(script)
    command = [engine, "--no-window", "-s", "all.gd"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=120)
    said = [line for line in _plain(done.stdout) if not line.startswith("Godot Engine")]
    assert said == SAID, done.stdout + done.stderr


def _plain(out: str) -> list[str]:
    """Return lines, truth values written as Python writes them."""
    words = {"true": "True", "false": "False"}
    return [
        re.sub(r"\b(true|false)\b", lambda m: words[m.group()], line)
        for line in out.splitlines()
        if line.strip()
    ]


def _pascal(name: str) -> str:
    return name.title().replace("_", "")


REFUSED = {
    "def f() -> list[int]:\n    yield 1": "yields",
    "def f(x):\n    return x": "no types",
    "def f(**x: int) -> int:\n    return 1": "** arguments",
    "def f(x: int | str) -> int:\n    return 1": "of several types",
    "def f(x: str | None) -> int:\n    return 1 if x else 2": "whether a optional is true",
    "def f(x: list[int]) -> list[int]:\n    return x[::2]": "a slice with a step",
    "def f(x: list[int]) -> int:\n    with open('a') as g:\n        return len(x)": "WithStmt",
    "def f(x: dict[str, int]) -> dict[str, int]:\n    return {**x}": "** in a map",
    "def f(x: float) -> str:\n    return f'{x}'": "a float in a text",
    "def f(x: float) -> str:\n    return f'{x:.9f}'": "a way to write a number",
    "def f(x: float) -> float:\n    return x % 2.0": "% of numbers with fractions",
    "def f(x: dict[str, float]) -> None:\n    x['a'] *= 2.0": "a change of a map's entry in place",
    "def f(x: list[int]) -> int:\n    return max(x, key=lambda n: n)": "max",
    "def f() -> int:\n    a = b = 1\n    return a + b": "two targets",
    "def f(x: str) -> str:\n    return x.upper()": "'.upper()' of a str",
    "def f(x: str) -> list[str]:\n    return x.split(',')": "'.split()' at something else than blanks",
    "def f(x: str) -> str:\n    return x.strip('.')": "'.strip()' at something else than blanks",
    "class A:\n    @staticmethod\n    def s() -> int:\n        return 1": "decorator",
}


# In the subset, but not in every language.
UNKNOWN = {
    "far": "import os\n\n\ndef f() -> str:\n    return os.getcwd()",
    "same": "def f(a: list[int], b: list[int]) -> bool:\n    return a == b",
    "own": (
        "from dataclasses import dataclass\n\n\n@dataclass\nclass A:\n    x: int\n\n"
        "    def m(self) -> int:\n        return f(self.x)\n\n\ndef f(x: int) -> int:\n    return x"
    ),
}


@pytest.fixture(scope="module")
def untranslatable(tmp_path_factory: pytest.TempPathFactory) -> dict[str, SourceModule]:
    """Modules that cannot be translated, by name, read at once: to read takes most of the time."""
    folder = tmp_path_factory.mktemp("untranslatable")
    modules = {**{f"m{n}": code for n, code in enumerate(REFUSED)}, **UNKNOWN}
    for name, code in modules.items():
        quiet = "def f(x):" in code or "f() -> list[int]" in code
        (folder / f"{name}.py").write_text("# mypy: ignore-errors\n" * quiet + code + "\n")
    sources = read_typed_modules([Translated(name, name) for name in modules], folder)
    return {one.module: source for one, source in sources.items()}


@pytest.mark.nightly
def test_what_is_outside_the_subset_is_refused_with_its_place_and_a_remedy(
    untranslatable: dict[str, SourceModule],
) -> None:
    for n, (code, words) in enumerate(REFUSED.items()):
        with pytest.raises(SubsetError) as told:
            convert_module(untranslatable[f"m{n}"])
        found = str(told.value)
        assert words in found, (code, found)
        assert f"m{n}.py, line " in found and "; " in found


def test_what_no_language_knows_is_told(untranslatable: dict[str, SourceModule]) -> None:
    wrong = {
        "far": "'os' is used, which is not translated",
        "own": "a method calls 'f' of its own module",
        "same": "whether two lists are equal",
    }
    assert wrong.keys() == UNKNOWN.keys()
    for name, words in wrong.items():
        with pytest.raises(TranslationError, match=words):
            print_modules({Translated(name, name): convert_module(untranslatable[name])}, {})


@pytest.mark.nightly
def test_what_mypy_finds_wrong_is_told(tmp_path: Path) -> None:
    (tmp_path / "wrong.py").write_text("def f() -> int:\n    return 'x'\n")
    with pytest.raises(SubsetError, match=r"wrong.py:2: error"):
        read_modules([Translated("wrong", "wrong")], tmp_path)
