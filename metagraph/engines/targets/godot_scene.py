"""Scenes of exports for Godot 4 that play when they are opened, and how Godot imports the GLB."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from metagraph.engines.engine_machine import Machine
from metagraph.formats.atomic import write_atomically
from metagraph.graph.model import Project

MOTION = ".motion"  # how the GLB's copy ends that Godot does not import
VIEW = 35.0  # degrees, from the bottom of the picture to its top

SURROUNDINGS = """
[node name="Camera" type="Camera3D" parent="."]
transform = Transform3D(1, 0, 0, 0, 1, 0, 0, 0, 1, 0, {middle:.3f}, {away:.3f})
fov = {view:.1f}

[node name="Light" type="DirectionalLight3D" parent="."]
transform = Transform3D(0.866, -0.3214, 0.383, 0, 0.766, 0.6428, -0.5, -0.5567, 0.6634, 0, 3, 0)

[node name="World" type="WorldEnvironment" parent="."]
environment = SubResource("environment")
"""
ENVIRONMENT = """
[sub_resource type="Environment" id="environment"]
background_mode = 1
background_color = Color(0.24, 0.27, 0.3, 1)
ambient_light_source = 2
ambient_light_color = Color(0.75, 0.78, 0.82, 1)
ambient_light_energy = 0.7
"""

SCENE = """[gd_scene load_steps=5 format=3]

[ext_resource type="PackedScene" path="{stem}.glb" id="1"]
[ext_resource type="Script" path="{stem}.gd" id="2"]
[ext_resource type="Script" path="res://addons/metagraph/metagraph_character.gd" id="3"]
{environment}
[node name="Scene" type="Node3D"]
script = ExtResource("2")

[node name="Character" parent="." instance=ExtResource("1")]

[node name="Performer" type="Node" parent="."]
script = ExtResource("3")
json_path = "{stem}.json"
{surroundings}"""

SCRIPT = """extends Node3D
## The first requests to the character. All of them stand in addons/metagraph/README.md.

@onready var performer: MetagraphCharacter = $Performer


func _ready() -> void:
	performer.began.connect(_on_began)
	performer.look("user")
	performer.say("Hello! How are you?", {"after": 0.5})
	performer.gesture([], {"after": 4.0})


func _on_began(action: String, layer: String, _meta: String) -> void:
	print(layer, " begins ", action)
"""

TREE_SCENE = """[gd_scene load_steps={steps} format=3]

[ext_resource type="PackedScene" path="{stem}.glb" id="1"]
[ext_resource type="AnimationNodeBlendTree" path="{tree}.tres" id="2"]
[ext_resource type="Script" path="{tree}.gd" id="3"]
{library}{environment}
[node name="Scene" type="Node3D"]

[node name="Character" parent="." instance=ExtResource("1")]
{player}
[node name="Tree" type="AnimationTree" parent="."]
root_node = NodePath("../Character")
tree_root = ExtResource("2")
anim_player = NodePath("{from_tree}")
{amounts}
script = ExtResource("3")
{surroundings}"""

PLAYER = """
[node name="Player" type="AnimationPlayer" parent="."]
root_node = NodePath("../Character")
libraries = {
&"": ExtResource("4")
}
"""

TREE_SCRIPT = """extends AnimationTree
## Plays the states of the tree by name. The metadata `action` of a state is the name of its action.


func _ready() -> void:
	active = true
	await get_tree().create_timer(1.0).timeout
	play("{layer}", "{state}")


## Goes to a state: to a stance by the name of its loop, or to a gesture.
func play(layer: String, state: String) -> void:
	var playback: AnimationNodeStateMachinePlayback = get("parameters/" + layer + "/playback")
	playback.travel(state)
"""

IMPORT = """[remap]

importer="scene"
importer_version=1
type="PackedScene"

[params]

nodes/root_type=""
nodes/root_name=""
nodes/apply_root_scale=true
nodes/root_scale=1.0
animation/import={animations}
animation/fps=30
animation/trimming=false
animation/remove_immutable_tracks=false
import_script/path=""
_subresources={{}}
gltf/naming_version=2
gltf/embedded_image_handling=1
"""


def write_godot_scene(project: Project, folder: Path, stem: str) -> list[Path]:
    """Write a scene that plays an export whose files are called `stem`, and its script; return both."""
    scene = SCENE.format(stem=stem, environment=ENVIRONMENT, surroundings=_surround(project))
    return _write(folder, {f"{stem}.tscn": scene, f"{stem}.gd": SCRIPT})


def write_tree_scene(
    project: Project, folder: Path, stem: str, tree: str, built: Sequence[Machine], library: str = ""
) -> list[Path]:
    """Write a scene whose AnimationTree plays `tree`.tres, and its script; return both. library: the file of
    an AnimationLibrary; without, the animations are those of the GLB.
    """
    layer, state = find_first_gesture(built)
    row = f'[ext_resource type="AnimationLibrary" path="{library}" id="4"]\n' if library else ""
    scene = TREE_SCENE.format(
        stem=stem,
        tree=tree,
        steps=6 if library else 5,
        library=row,
        environment=ENVIRONMENT,
        player=PLAYER if library else "",
        from_tree="../Player" if library else "../Character/AnimationPlayer",
        amounts="\n".join(f"parameters/add_{machine.layer}/add_amount = 1.0" for machine in built),
        surroundings=_surround(project),
    )
    script = TREE_SCRIPT.replace("{layer}", layer).replace("{state}", state)
    return _write(folder, {f"{tree}.tscn": scene, f"{tree}.gd": script})


def write_import_settings(folder: Path, glb: str, animations: bool) -> Path:
    """Write how Godot imports a GLB: its names and bones as they are; its animations only if asked."""
    (path,) = _write(folder, {f"{glb}.import": IMPORT.format(animations=str(animations).lower())})
    return path


def _write(folder: Path, texts: dict[str, str]) -> list[Path]:
    for name, text in texts.items():
        write_atomically(folder / name, text.encode())
    return [folder / name for name in texts]


def _surround(project: Project) -> str:
    """Return camera, light and background for a character of this size."""
    height = project.skeleton.height if project.skeleton is not None else 1.7
    away = 0.62 * height / math.tan(math.radians(VIEW / 2))
    return SURROUNDINGS.format(middle=0.52 * height, away=away, view=VIEW)


def find_first_gesture(built: Sequence[Machine]) -> tuple[str, str]:
    """Return the layer and state that a scene shows first."""
    for machine in sorted(built, key=lambda m: m.layer != "arms"):
        for state in machine.states:
            if state.action.kind == "gesture" and state.action.stance == machine.start.action.stance:
                return machine.layer, state.name
    return built[0].layer, built[0].start.name
