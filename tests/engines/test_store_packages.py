"""The packages for stores: what each store's published list asks for, one test a store."""

from __future__ import annotations

import configparser
import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

from metagraph import __version__
from metagraph.engines.store_packages import UNREAL_VERSIONS, write_store_packages
from tests.browsing import Browser
from tests.engines.godot4_web import needs_godot4, play, seen
from tests.engines.test_godot_package import list_untyped, list_warnings

REPOSITORY = "https://example.org/metagraph"


@pytest.fixture(scope="module")
def stores(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("stores")
    made = write_store_packages(folder, REPOSITORY)
    assert len(made) == 3 + len(UNREAL_VERSIONS) and all(path.is_dir() for path in made)
    return folder


def read(path: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(path.read_bytes())
    return found


def test_one_version_number_is_everywhere(stores: Path) -> None:
    plugin = configparser.ConfigParser()
    plugin.read(stores / "godot" / "addons" / "metagraph" / "plugin.cfg")
    blender = Path(__file__).parents[2] / "metagraph/engines/runtimes/blender/metagraph_blender"
    unity = stores / "unity" / "com.metagraph.runtime"
    versions = {
        read(unity / "package.json")["version"],
        read(stores / "npm" / "metagraph-runtime" / "package.json")["version"],
        plugin["plugin"]["version"].strip('"'),
        *(read(path)["VersionName"] for path in stores.glob("unreal/*/Metagraph/Metagraph.uplugin")),
        *re.findall(r'^version = "(.*)"', (blender / "blender_manifest.toml").read_text(), re.MULTILINE),
        *re.findall(r"^## \[(.*)\]", (unity / "CHANGELOG.md").read_text(), re.MULTILINE),
    }
    assert versions == {__version__}


def test_unitys_package_has_the_layout_of_its_manual(stores: Path) -> None:
    """https://docs.unity3d.com/Manual/cus-layout.html and cus-naming.html."""
    package = stores / "unity" / "com.metagraph.runtime"
    for name in (
        "README.md",
        "CHANGELOG.md",
        "LICENSE.md",
        "Third Party Notices.md",
        "Documentation~/index.md",
    ):
        assert (package / name).stat().st_size, name
    described = read(package / "package.json")
    assert described["name"] == package.name and re.fullmatch(r"\d+\.\d+\.\d+", described["version"])
    assert re.fullmatch(r"\d{4}\.\d", described["unity"]) and described["displayName"]
    assert described["documentationUrl"].startswith("https://") and described["license"] == "MIT"
    assert all((package / sample["path"]).is_dir() for sample in described["samples"])
    for folder in ("Runtime", "Editor", "Tests"):
        assert list((package / folder).rglob("*.asmdef")), folder
    (tests,) = (package / "Tests").rglob("*.asmdef")
    assert read(tests)["defineConstraints"] == ["UNITY_INCLUDE_TESTS"]
    for path in package.rglob("*"):
        hidden = any(part.endswith("~") for part in path.relative_to(package).parts)
        if path.suffix != ".meta" and not hidden:
            assert path.with_name(f"{path.name}.meta").is_file(), path


def test_godots_package_is_what_the_asset_library_asks_for(stores: Path) -> None:
    """https://docs.godotengine.org/en/stable/community/asset_library/submitting_to_assetlib.html"""
    package = stores / "godot"
    addon = package / "addons" / "metagraph"
    assert [path.name for path in (package / "addons").iterdir()] == ["metagraph"]
    licence = (package / "LICENSE").read_text()
    assert licence == (addon / "LICENSE").read_text() and re.search(r"Copyright \(c\) \d{4} \S", licence)
    assert (package / ".gitignore").read_text() == ".godot/\n" and (addon / "README.md").stat().st_size
    assert (package / "godot3" / ".gdignore").is_file() and (package / "example" / ".gdignore").is_file()
    assert not list(addon.rglob("*3.gd")) and not list(package.rglob("*.import"))
    for script in (*addon.rglob("*.gd"), package / "example" / "example.gd"):
        assert list_warnings(script.read_text(encoding="utf-8")) == [], script
    assert list_untyped((package / "example" / "example.gd").read_text()) == []


@pytest.mark.skipif(shutil.which("git") is None, reason="needs git")
def test_the_asset_library_installs_the_add_on_alone(stores: Path, tmp_path: Path) -> None:
    """What git puts into an archive, as GitHub does, from which the library installs."""
    repository = shutil.copytree(stores / "godot", tmp_path / "godot")
    me = ("-c", "user.name=a", "-c", "user.email=a@b.example")
    for words in (("init", "-q"), ("add", "-A"), ("commit", "-qm", "a"), ("archive", "-o", "a.tar", "HEAD")):
        subprocess.run(["git", *me, *words], cwd=repository, check=True)
    listed = subprocess.run(
        ["tar", "tf", "a.tar"], cwd=repository, capture_output=True, text=True, check=True
    )
    names = listed.stdout.split()
    assert "addons/metagraph/plugin.cfg" in names and all(name.startswith("addons/") for name in names)


@needs_godot4
@pytest.mark.nightly
def test_the_example_of_godots_package_runs(stores: Path, tmp_path: Path, browse: Browser) -> None:
    example = stores / "godot" / "example"
    files = {
        path.relative_to(example).as_posix(): path.read_bytes()
        for path in example.rglob("*")
        if path.is_file() and path.suffix != ".godot"
    }
    main = """extends Node

func _ready():
	var scene = load("res://example.tscn").instantiate()
	add_child(scene)
	var before = scene.skeleton.get_bone_global_pose(scene.skeleton.get_bone_count() - 1)
	for n in 300:
		scene.performer._process(1.0 / 60)
	scene._process(0.0)
	var after = scene.skeleton.get_bone_global_pose(scene.skeleton.get_bone_count() - 1)
	print("seen ", JSON.stringify({"moved": before != after, "drawn": scene._lines.get_surface_count()}))
	get_tree().quit(0)
"""
    code, told = play(tmp_path, browse, files | {"main.gd": main.encode()})
    assert code == 0
    assert seen(told) == {"moved": True, "drawn": 1}


@pytest.mark.parametrize("version", UNREAL_VERSIONS)
def test_unreals_plugin_is_what_fab_asks_for(stores: Path, version: str) -> None:
    """Fab's technical requirements for code plugins, one package for each version of the engine."""
    package = stores / "unreal" / version / "Metagraph"
    described = read(package / "Metagraph.uplugin")
    assert described["EngineVersion"] == f"{version}.0"
    assert all(described[key] for key in ("FriendlyName", "Description", "CreatedBy", "Category"))
    assert all(described[f"{key}URL"] == REPOSITORY for key in ("CreatedBy", "Docs", "Support"))
    for module in described["Modules"]:
        assert module["PlatformAllowList"] and (package / "Source" / module["Name"]).is_dir()
    assert not {"Binaries", "Build", "Intermediate", "Saved"} & {path.name for path in package.iterdir()}
    for path in package.rglob("*"):
        assert len(path.relative_to(package.parent).as_posix()) <= 170 and path.name.isascii()
        if path.suffix in (".h", ".hpp", ".cpp", ".cs"):
            assert path.read_text(encoding="utf-8").startswith("// Copyright "), path
    added = (package / "Config" / "FilterPlugin.ini").read_text().split()[1:]
    assert all((package / name.lstrip("/")).is_file() for name in added)
    assert (package / "Source/Metagraph/Private/Core/metagraph.hpp").is_file()


def test_npms_package_names_its_repository_and_all_its_files(stores: Path) -> None:
    package = stores / "npm" / "metagraph-runtime"
    described = read(package / "package.json")
    assert described["repository"] == {"type": "git", "url": f"git+{REPOSITORY}.git"}
    assert described["license"] == "MIT" and (package / "LICENSE").is_file()
    assert (package / described["customElements"]).is_file() and (package / described["types"]).is_file()
    assert "../" not in (package / "README.md").read_text(encoding="utf-8")


@pytest.mark.skipif(shutil.which("npm") is None, reason="needs npm")
def test_npm_packs_what_the_package_lists(stores: Path) -> None:
    package = stores / "npm" / "metagraph-runtime"
    done = subprocess.run(
        ["npm", "pack", "--dry-run", "--json", "--ignore-scripts"],
        cwd=package, capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-2000:]
    (packed,) = json.loads(done.stdout)
    names = {file["path"] for file in packed["files"]}
    assert {"LICENSE", "README.md", "package.json", "index.js", "index.d.ts", "custom-elements.json"} <= names
    assert names == {path.relative_to(package).as_posix() for path in package.rglob("*") if path.is_file()}
