"""The Unreal plugin, compiled and played against stand-ins for Unreal's types: it never ran in Unreal."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from metagraph.engines.targets import registry
from metagraph.engines.targets.runtimes import copied
from metagraph.graph.model import Project
from tests.engines.test_runtime_cpp import SELDOM

ROOT = Path(__file__).resolve().parents[2]
RUNTIMES = ROOT / "metagraph" / "engines" / "runtimes"
PLUGIN = RUNTIMES / "unreal"
STAND_IN = Path(__file__).parent / "unreal_stand_in"
STICK = ROOT / "metagraph" / "engines" / "conformance" / "stick"

# What of Unreal the plugin includes, as public plugins name it.
ENGINE = {
    "CoreMinimal.h", "Engine/DataAsset.h", "Components/ActorComponent.h", "Components/SkeletalMeshComponent.h",
    "GameFramework/Actor.h", "Animation/AnimNodeBase.h", "Animation/AnimInstance.h", "Animation/AnimInstanceProxy.h",
    "BoneContainer.h", "Modules/ModuleManager.h", "AnimGraphNode_Base.h", "Factories/Factory.h", "Misc/FeedbackContext.h",
    "Misc/FileHelper.h", "Misc/Paths.h",
}  # fmt: skip

needs_compiler = pytest.mark.skipif(shutil.which("g++") is None, reason="needs a C++ compiler (g++)")


def sources() -> list[Path]:
    return sorted(p for p in PLUGIN.rglob("*") if p.suffix in (".h", ".cpp"))


@pytest.fixture(scope="module")
def played(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The plugin with the core in it, as an export writes it, compiled against the stand-ins."""
    folder = tmp_path_factory.mktemp("unreal")
    plugin = folder / "Metagraph"
    copied(PLUGIN, plugin)
    copied(RUNTIMES / "cpp", plugin / "Source" / "Metagraph" / "Private" / "Core")
    names = folder / "engine"
    generated = {found for p in sources() for found in re.findall(r'"(\w+\.generated\.h)"', p.read_text())}
    for name in ENGINE | generated:
        (names / name).parent.mkdir(parents=True, exist_ok=True)
        (names / name).write_text("" if name in generated else '#pragma once\n#include "Unreal.h"\n')
    inside = [
        plugin / "Source" / module / side
        for module in ("Metagraph", "MetagraphEditor")
        for side in ("Public", "Private")
    ]
    program = folder / "play"
    done = subprocess.run(
        [
            "g++", *SELDOM, "-std=c++20", "-O0", "-Wall", "-Wextra", "-Werror", "-fno-exceptions", "-fno-rtti",
            *(f"-I{f}" for f in (names, STAND_IN, *inside)), str(STAND_IN / "play.cpp"), "-o", str(program),
        ],
        capture_output=True, text=True, timeout=300, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[:4000]
    return program


def ran(program: Path, *words: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [str(program), *map(str, words)], capture_output=True, text=True, timeout=120, check=False
    )


@needs_compiler
def test_the_node_shows_the_poses_of_the_vectors(played: Path) -> None:
    vectors = json.loads((STICK / "vectors.json").read_bytes())
    done = ran(played, "vectors", STICK / "stick.json", STICK)
    assert done.returncode == 0, done.stdout[:2000] + done.stderr[:2000]
    assert f"{sum(len(case['poses']) for case in vectors['cases'])} poses" in done.stdout


@needs_compiler
def test_space_is_changed_and_changed_back(played: Path) -> None:
    done = ran(played, "space")
    assert done.stdout == "fits up 100 ahead 100\n"


@needs_compiler
def test_the_component_plays_what_it_is_asked(played: Path) -> None:
    done = ran(played, "play", STICK / "stick.json")
    assert done.returncode == 0, done.stdout + done.stderr
    before, answers, told, texts = done.stdout.splitlines()
    assert before == "before refused"
    gesture, nonsense, unknown, said, look = answers.split()
    assert {gesture, said, look} <= {"planned", "late", "done"}
    assert (nonsense, unknown) == ("refused", "refused")
    assert told == "told 1 1 1"
    whole, early, *pieces, plain = texts.split()
    assert (whole, early, pieces) == ("said#1", "0", ["said#2", "said#3"])
    assert plain.startswith("#"), "without gestures it is a request as any other"


@needs_compiler
def test_the_factory_leaves_other_json_alone_and_says_what_is_wrong(played: Path, tmp_path: Path) -> None:
    other = tmp_path / "other.json"
    other.write_text("{}")
    assert ran(played, "import", other).stdout.startswith("cannot")
    shutil.copy(STICK / "stick.json", tmp_path)
    done = ran(played, "import", tmp_path / "stick.json")
    assert done.returncode == 3
    assert "stick.glb" in done.stdout
    (tmp_path / "stick.glb").write_bytes(b"no GLB")
    assert "not a binary glTF" in ran(played, "import", tmp_path / "stick.json").stdout


def test_every_include_is_the_plugins_own_or_known_of_unreal() -> None:
    own = {p.name for p in sources()} | {"Core/metagraph.hpp"}
    for path in sources():
        included = re.findall(r'#include "([^"]+)"', path.read_text())
        generated = [name for name in included if name.endswith(".generated.h")]
        assert set(included) <= own | ENGINE | set(generated), path.name
        # Unreal's header tool wants its own include last, named after the header.
        if "GENERATED_BODY" in path.read_text():
            assert generated == [f"{path.stem}.generated.h"] == [included[-1]], path.name
        else:
            assert not generated, path.name


def test_the_descriptor_names_the_modules_there_are() -> None:
    described = json.loads((PLUGIN / "Metagraph.uplugin").read_bytes())
    assert {m["Name"] for m in described["Modules"]} == {p.name for p in (PLUGIN / "Source").iterdir()}
    for name in {m["Name"] for m in described["Modules"]}:
        rules = (PLUGIN / "Source" / name / f"{name}.Build.cs").read_text()
        assert f"class {name} : ModuleRules" in rules
        module = (PLUGIN / "Source" / name / "Private" / f"{name}Module.cpp").read_text()
        assert re.search(rf"IMPLEMENT_MODULE\(\w+, {name}\)", module)


def test_the_importer_names_what_is_missing(tmp_path: Path) -> None:
    source = (PLUGIN / "Content" / "Python" / "import_metagraph.py").read_text()
    made: list[dict[str, object]] = []

    class Task:
        def __init__(self) -> None:
            self.said: dict[str, object] = {}
            made.append(self.said)

        def set_editor_property(self, name: str, value: object) -> None:
            self.said[name] = value

        def get_editor_property(self, name: str) -> list[str]:
            return [f"{self.said['destination_path']}/{Path(str(self.said['filename'])).name}"]

    class Unreal:
        AssetImportTask = Task
        MetagraphFactory = object

        class AssetToolsHelpers:
            @staticmethod
            def get_asset_tools() -> object:
                class Tools:
                    def import_asset_tasks(self, tasks: list[object]) -> None:
                        assert len(tasks) == 1

                return Tools()

    names: dict[str, object] = {"__name__": "import_metagraph"}
    exec(compile(source.replace("import unreal ", "unreal = UNREAL "), "import_metagraph.py", "exec"), names)
    names["UNREAL"] = Unreal
    run = names["run"]
    assert callable(run)
    with pytest.raises(FileNotFoundError, match=r"sample\.json is not there"):
        run(str(tmp_path / "sample.json"), "/Game/X")
    for file in ("sample.json", "sample.glb"):
        (tmp_path / file).write_text("")
    paths = run(str(tmp_path / "sample.json"), "/Game/X")
    assert paths == ["/Game/X/sample.json", "/Game/X/sample.glb"]
    assert made[-1]["automated"] is True


def test_an_export_brings_the_plugin_with_the_core(sample: Project, tmp_path: Path) -> None:
    report = registry.write(sample, "unreal", tmp_path / "game")
    written = {p.relative_to(tmp_path / "game").as_posix() for p in report.files}
    plugin = "Plugins/Metagraph"
    assert f"{plugin}/Metagraph.uplugin" in written
    assert f"{plugin}/Source/Metagraph/Private/Core/metagraph.hpp" in written
    assert not any("conformance" in name for name in written)
