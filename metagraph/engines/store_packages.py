"""The runtimes as their stores want them: Unity's registries, Godot's Asset Library, Fab for Unreal, and npm.

    python -m metagraph.engines.store_packages FOLDER --repository https://...

writes the folders `unity`, `godot`, `npm` and `unreal`, the last with a plugin for each version of the
engine. tests/engines/test_store_packages.py has the lists that stores publish.
"""

from __future__ import annotations

import argparse
import json
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from metagraph import __version__
from metagraph.engines.targets.runtimes import CORE_IN_PLUGIN, RUNTIMES, copy_core, copy_runtime
from metagraph.engines.targets.unity_package import PACKAGE, write_package_metas

UNREAL_VERSIONS = ("5.4", "5.5", "5.6")  # Fab takes plugins for the latest three
NOTICE = "// Copyright The Metagraph authors. MIT License.\n"  # Fab wants one in each source
GODOT_ATTRIBUTES = """# The Asset Library installs the add-on alone.
/** export-ignore
/addons !export-ignore
/addons/** !export-ignore
"""
UNREAL_FILTER = "[FilterPlugin]\n/README.md\n/requests.md\n/LICENSE\n"  # what the engine's own packaging adds


def write_unity_package(folder: Path, repository: str) -> Path:
    """Write the package for Unity's registries; return its folder."""
    package = folder / "unity" / PACKAGE
    files = copy_runtime(RUNTIMES / "unity", package)
    more = {"documentationUrl": repository, "repository": {"type": "git", "url": repository}}
    _update(package / "package.json", more)
    write_package_metas(package, files)
    return package


def write_godot_package(folder: Path) -> Path:
    """Write the repository for Godot's Asset Library, which installs its `addons`; return its folder."""
    package = folder / "godot"
    for part in ("addons", "godot3"):
        copy_runtime(RUNTIMES / "godot" / part, package / part)
    addon = package / "addons" / "metagraph"
    for name in ("LICENSE", "README.md"):
        shutil.copyfile(addon / name, package / name)
    shutil.copytree(addon.parent, package / "example" / "addons")
    for name in ("stick.json", "stick.glb"):
        shutil.copyfile(RUNTIMES.with_name("conformance") / "stick" / name, package / "example" / name)
    (package / "example" / "stick.motion").write_bytes((package / "example" / "stick.glb").read_bytes())
    (package / "example" / "project.godot").write_text(EXAMPLE_PROJECT, encoding="utf-8")
    (package / "example" / "example.tscn").write_text(EXAMPLE_SCENE, encoding="utf-8")
    (package / "example" / "example.gd").write_text(EXAMPLE_SCRIPT, encoding="utf-8")
    (package / "example" / ".gdignore").write_text("# A project of its own: open its project.godot.\n")
    (package / ".gitattributes").write_text(GODOT_ATTRIBUTES)
    (package / ".gitignore").write_text(".godot/\n")
    return package


def write_unreal_package(folder: Path, version: str, repository: str) -> Path:
    """Write the plugin for a version of Unreal; return its folder."""
    package = folder / "unreal" / version / "Metagraph"
    copy_runtime(RUNTIMES / "unreal", package)
    copy_core(package / CORE_IN_PLUGIN)
    for source in (p for p in package.rglob("*") if p.suffix in (".h", ".hpp", ".cpp", ".cs")):
        text = source.read_text(encoding="utf-8")
        source.write_text(text if text.startswith("// Copyright") else NOTICE + text, encoding="utf-8")
    links = {f"{name}URL": repository for name in ("CreatedBy", "Docs", "Support")}
    _update(package / "Metagraph.uplugin", {"EngineVersion": f"{version}.0", **links})
    (package / "Config").mkdir()
    (package / "Config" / "FilterPlugin.ini").write_text(UNREAL_FILTER)
    return package


def write_npm_package(folder: Path, repository: str) -> Path:
    """Write the package for npm; return its folder."""
    package = folder / "npm" / "metagraph-runtime"
    copy_runtime(RUNTIMES / "javascript", package)
    _update(package / "package.json", {"repository": {"type": "git", "url": f"git+{repository}.git"}})
    return package


def write_store_packages(folder: Path, repository: str) -> list[Path]:
    """Write all packages into a folder that has none; return theirs. repository: where the sources are."""
    return [
        write_unity_package(folder, repository),
        write_godot_package(folder),
        *(write_unreal_package(folder, version, repository) for version in UNREAL_VERSIONS),
        write_npm_package(folder, repository),
    ]


def _update(path: Path, more: Mapping[str, Any]) -> None:
    known = json.loads(path.read_bytes())
    path.write_text(json.dumps({**known, **more}, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")


EXAMPLE_PROJECT = """config_version=5

[application]

config/name="Metagraph example"
run/main_scene="res://example.tscn"
config/features=PackedStringArray("4.3")
"""
EXAMPLE_SCENE = """[gd_scene load_steps=3 format=3]

[ext_resource type="Script" path="res://example.gd" id="1"]
[ext_resource type="Script" path="res://addons/metagraph/metagraph_character.gd" id="2"]

[node name="Example" type="Node3D"]
script = ExtResource("1")

[node name="Skeleton" type="Skeleton3D" parent="."]

[node name="Performer" type="Node" parent="."]
script = ExtResource("2")
json_path = "stick.json"

[node name="Camera" type="Camera3D" parent="."]
transform = Transform3D(1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0.9, 3.2)
"""
EXAMPLE_SCRIPT = """extends Node3D
## Draws the bones of a character that gestures, so that the example needs no mesh.

var _lines: ImmediateMesh = ImmediateMesh.new()

@onready var skeleton: Skeleton3D = $Skeleton
@onready var performer: MetagraphCharacter = $Performer


func _enter_tree() -> void:
	var bones: Skeleton3D = $Skeleton
	var found: Dictionary = JSON.parse_string(FileAccess.get_file_as_string("res://stick.json"))
	for joint: Dictionary in found.joints:
		var bone: int = bones.add_bone(joint.name)
		if joint.parent != null:
			bones.set_bone_parent(bone, bones.find_bone(joint.parent))


func _ready() -> void:
	var shown: MeshInstance3D = MeshInstance3D.new()
	var paint: StandardMaterial3D = StandardMaterial3D.new()
	paint.shading_mode = BaseMaterial3D.SHADING_MODE_UNSHADED
	shown.mesh = _lines
	shown.material_override = paint
	add_child(shown)
	performer.look("user")
	performer.say("Hello! How are you?", {"after": 0.5})
	performer.gesture([], {"after": 3.0})


func _process(_delta: float) -> void:
	_lines.clear_surfaces()
	_lines.surface_begin(Mesh.PRIMITIVE_LINES)
	for bone: int in skeleton.get_bone_count():
		var parent: int = skeleton.get_bone_parent(bone)
		if parent >= 0:
			_lines.surface_add_vertex(skeleton.get_bone_global_pose(parent).origin)
			_lines.surface_add_vertex(skeleton.get_bone_global_pose(bone).origin)
	_lines.surface_end()
"""


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Write the runtimes as their stores want them.")
    parser.add_argument("folder", type=Path, help="an empty folder")
    parser.add_argument("--repository", required=True, help="the address of the sources")
    given = parser.parse_args()
    for made in write_store_packages(given.folder, given.repository):
        print(f"{made}, version {__version__}")
