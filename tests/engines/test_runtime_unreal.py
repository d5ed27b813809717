"""The Unreal plugin, compiled and played against stand-ins for Unreal's types: it never ran in Unreal."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path

import msgspec
import pytest

from metagraph.engines.export_parameters import export_parameters
from metagraph.engines.reading import read_export
from metagraph.engines.targets import registry
from metagraph.graph.editing.parameters import add_parameter, list_offered_parameters
from metagraph.graph.model import Project
from tests.engines.cpp_program import (
    ENGINE,
    STAND_IN,
    UNREAL,
    compiled,
    made_of_unreal,
    needs_compiler,
    ran,
    unreal_sources,
)
from tests.thorough import THOROUGH

ROOT = Path(__file__).resolve().parents[2]
STICK = ROOT / "metagraph" / "engines" / "conformance" / "stick"


@needs_compiler
@pytest.mark.skipif(not THOROUGH, reason="only where asked to be thorough: what plays is compiled as C++17")
def test_the_plugin_and_the_shipped_headers_compile_as_an_export_writes_them(tmp_path: Path) -> None:
    """As C++20, which Unreal takes it for. What runs below is C++17, as the core is, and has a switch for each
    mutant of the core: that is how the two differ.
    """
    compiled(
        STAND_IN / "play.cpp", tmp_path / "none", "-fsyntax-only", *made_of_unreal(tmp_path), standard="c++20"
    )


def played(program: Path, *words: object) -> subprocess.CompletedProcess[str]:
    return ran(program, "unreal", *words)


@pytest.mark.nightly
@needs_compiler
def test_the_node_shows_the_poses_of_the_vectors(cpp_probe: Path) -> None:
    vectors = json.loads((STICK / "vectors.json").read_bytes())
    done = played(cpp_probe, "vectors", STICK / "stick.json", STICK)
    assert done.returncode == 0, done.stdout[:2000] + done.stderr[:2000]
    assert f"{sum(len(case['poses']) for case in vectors['cases'])} poses" in done.stdout


@pytest.mark.nightly
@needs_compiler
def test_space_is_changed_and_changed_back(cpp_probe: Path) -> None:
    done = played(cpp_probe, "space")
    assert done.stdout == "fits up 100 ahead 100\n"


@pytest.mark.nightly
@needs_compiler
def test_the_component_plays_what_it_is_asked(cpp_probe: Path) -> None:
    done = played(cpp_probe, "play", STICK / "stick.json")
    assert done.returncode == 0, done.stdout + done.stderr
    before, answers, told, texts, asked = done.stdout.splitlines()
    assert before == "before refused"
    gesture, nonsense, unknown, said, look = answers.split()
    assert {gesture, said, look} <= {"planned", "late", "done"}
    assert (nonsense, unknown) == ("refused", "refused")
    assert told == "told 1 1 1"
    whole, early, *pieces, plain = texts.split()
    assert (whole, early, pieces) == ("said#1", "0", ["said#2", "said#3"])
    assert plain.startswith("#"), "without gestures it is a request as any other"
    gesture, unknown, nowhere, *others, interrupt = asked.split()[1:]
    assert {gesture, *others} <= {"planned", "late", "done"} and len(others) == 4
    assert (unknown, nowhere, interrupt) == ("refused", "refused", "done")


@pytest.mark.nightly
@needs_compiler
def test_a_mesh_without_a_blueprint_shows_the_pose_and_morph_targets_are_curves(cpp_probe: Path) -> None:
    export = STICK.with_name("varied") / "varied.json"
    done = played(cpp_probe, "drive", export)
    assert done.returncode == 0, done.stdout + done.stderr
    given, shown, face = done.stdout.splitlines()
    assert given == "class 1 1"
    assert shown == "shown 100 same curves"
    assert face.startswith("face alone ") and int(face.split()[-1]) > 0


@pytest.mark.nightly
@needs_compiler
def test_parameters_of_the_project_are_set_by_typed_calls(cpp_probe: Path, tmp_path: Path) -> None:
    out = read_export(STICK / "stick.json", resolved=True)
    for offered in list_offered_parameters(out):
        if offered.group in ("state", "gesture"):
            out, _ = add_parameter(out, offered.name, offered.parameter)
    document = json.loads((STICK / "stick.json").read_bytes())
    document["parameters"] = msgspec.to_builtins(export_parameters(out))
    (tmp_path / "stick.json").write_text(json.dumps(document))
    shutil.copy(STICK / "stick.glb", tmp_path)
    done = played(cpp_probe, "parameters", tmp_path / "stick.json")
    assert done.returncode == 0, done.stdout + done.stderr
    before, told, values = done.stdout.splitlines()
    assert before == "before 11"
    states = told.split()[1:]
    assert {*states[:-3]} <= {"planned", "late", "done"} and len(states) == 9, told
    assert states[-3:] == ["refused"] * 3
    assert values == 'values "happy" 0.5'


@pytest.mark.nightly
@needs_compiler
def test_the_factory_leaves_other_json_alone_and_says_what_is_wrong(cpp_probe: Path, tmp_path: Path) -> None:
    other = tmp_path / "other.json"
    other.write_text("{}")
    assert played(cpp_probe, "import", other).stdout.startswith("cannot")
    shutil.copy(STICK / "stick.json", tmp_path)
    done = played(cpp_probe, "import", tmp_path / "stick.json")
    assert done.returncode == 3
    assert "stick.glb" in done.stdout
    (tmp_path / "stick.glb").write_bytes(b"no GLB")
    assert "not a binary glTF" in played(cpp_probe, "import", tmp_path / "stick.json").stdout


def test_every_include_is_the_plugins_own_or_known_of_unreal() -> None:
    own = {p.name for p in unreal_sources()} | {"Core/metagraph.hpp"}
    for path in unreal_sources():
        included = re.findall(r'#include "([^"]+)"', path.read_text())
        generated = [name for name in included if name.endswith(".generated.h")]
        assert set(included) <= own | ENGINE | set(generated), path.name
        # Unreal's header tool wants its own include last, named after the header.
        if "GENERATED_BODY" in path.read_text():
            assert generated == [f"{path.stem}.generated.h"] == [included[-1]], path.name
        else:
            assert not generated, path.name


def test_the_descriptor_names_the_modules_there_are() -> None:
    described = json.loads((UNREAL / "Metagraph.uplugin").read_bytes())
    assert {m["Name"] for m in described["Modules"]} == {p.name for p in (UNREAL / "Source").iterdir()}
    for name in {m["Name"] for m in described["Modules"]}:
        rules = (UNREAL / "Source" / name / f"{name}.Build.cs").read_text()
        assert f"class {name} : ModuleRules" in rules
        module = (UNREAL / "Source" / name / "Private" / f"{name}Module.cpp").read_text()
        assert re.search(rf"IMPLEMENT_MODULE\(\w+, {name}\)", module)


def test_the_importer_names_what_is_missing(tmp_path: Path) -> None:
    source = (UNREAL / "Content" / "Python" / "import_metagraph.py").read_text()
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
    with pytest.raises(FileNotFoundError, match=r"sample\.json"):
        run(str(tmp_path / "sample.json"), "/Game/X")
    for file in ("sample.json", "sample.glb"):
        (tmp_path / file).write_text("")
    paths = run(str(tmp_path / "sample.json"), "/Game/X")
    assert paths == ["/Game/X/sample.json", "/Game/X/sample.glb"]
    assert made[-1]["automated"] is True


@pytest.mark.nightly
def test_an_export_brings_the_plugin_with_the_core(sample: Project, tmp_path: Path) -> None:
    report = registry.write_for_target(sample, "unreal", tmp_path / "game")
    written = {p.relative_to(tmp_path / "game").as_posix() for p in report.files}
    plugin = "Plugins/Metagraph"
    assert f"{plugin}/Metagraph.uplugin" in written
    assert f"{plugin}/Source/Metagraph/Private/Core/metagraph.hpp" in written
    assert not any("conformance" in name for name in written)
