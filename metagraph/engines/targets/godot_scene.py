"""The scene of a Godot export: character, camera, light, the node that performs, and first requests."""

from __future__ import annotations

import math
from pathlib import Path

from metagraph.formats.atomic import write_atomically
from metagraph.graph.model import Project

MOTION = ".motion"  # how the GLB's copy ends that Godot does not import
VIEW = 35.0  # degrees, from the bottom of the picture to its top

SCENE = """[gd_scene load_steps=5 format=3]

[ext_resource type="PackedScene" path="{stem}.glb" id="1"]
[ext_resource type="Script" path="{stem}.gd" id="2"]
[ext_resource type="Script" path="res://addons/metagraph/metagraph_character.gd" id="3"]

[sub_resource type="Environment" id="4"]
background_mode = 1
background_color = Color(0.24, 0.27, 0.3, 1)
ambient_light_source = 2
ambient_light_color = Color(0.75, 0.78, 0.82, 1)
ambient_light_energy = 0.7

[node name="Scene" type="Node3D"]
script = ExtResource("2")

[node name="Character" parent="." instance=ExtResource("1")]

[node name="Performer" type="Node" parent="."]
script = ExtResource("3")
json_path = "{stem}.json"

[node name="Camera" type="Camera3D" parent="."]
transform = Transform3D(1, 0, 0, 0, 1, 0, 0, 0, 1, 0, {middle:.3f}, {away:.3f})
fov = {view:.1f}

[node name="Light" type="DirectionalLight3D" parent="."]
transform = Transform3D(0.866, -0.3214, 0.383, 0, 0.766, 0.6428, -0.5, -0.5567, 0.6634, 0, 3, 0)

[node name="World" type="WorldEnvironment" parent="."]
environment = SubResource("4")
"""

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


def write_godot_scene(project: Project, folder: Path, stem: str) -> list[Path]:
    """Write a scene that plays an export whose files are called `stem`, and its script; return both."""
    height = project.skeleton.height if project.skeleton is not None else 1.7
    away = 0.62 * height / math.tan(math.radians(VIEW / 2))
    scene = SCENE.format(stem=stem, middle=0.52 * height, away=away, view=VIEW)
    out = [folder / f"{stem}.tscn", folder / f"{stem}.gd"]
    for path, text in zip(out, (scene, SCRIPT), strict=True):
        write_atomically(path, text.encode())
    return out
