"""Drives the add-on in Blender as its user would, and writes down what is there; see `test_blender.py`.

python blender_drive.py ADD-ON'S-FOLDER EXPORT.json OUT-FOLDER HOW-MANY-TO-SAMPLE [ADDRESS]
"""

import json
import sys
import time
from pathlib import Path

import bpy
import numpy as np

addons, export, out = (Path(p) for p in sys.argv[1:4])
sys.path.insert(0, str(addons))
import metagraph_blender  # noqa: E402
from metagraph_blender import panel, scene  # noqa: E402


class Drawn:
    """A layout that notes what is drawn."""

    def __init__(self, noted):
        self.noted = noted

    def __getattr__(self, name):
        return lambda *a, **k: self.noted.append((name, *map(str, a[1:]), k.get("text"))) or Drawn(self.noted)


def drawn():
    noted = []
    own = type("P", (), {"layout": Drawn(noted), "draw": panel._Panel.draw})()
    own.draw(bpy.context)
    return noted


def heads(armature, action, frame):
    """Return where bones begin in Blender's world."""
    scene.play(armature, action)
    bpy.context.scene.frame_set(int(frame // 1), subframe=frame % 1)
    names = [joint["name"] for joint in json.loads(armature[scene.JOINTS])]
    return [list(armature.matrix_world @ armature.pose.bones[n].head) for n in names]


bpy.ops.wm.read_factory_settings(use_empty=True)
metagraph_blender.register()
noted = {"before": drawn()}
began = time.perf_counter()
assert bpy.ops.metagraph.load(filepath=str(export)) == {"FINISHED"}
noted["load_seconds"] = time.perf_counter() - began
armature = panel.armature_of(bpy.context)
labelled = [a for a in bpy.data.actions if a.metagraph.labelled]
noted["labels"] = [
    scene.label(a) | {"clip": a.metagraph.clip, "action": scene.before(a)["action"]} for a in labelled
]
noted["tracks"] = {t.name: len(t.strips) for t in armature.animation_data.nla_tracks}
noted["shown"] = armature.animation_data.action.metagraph.name
noted["panel"] = drawn()
noted["shapes"] = sum(len(k.key_blocks) - 1 for k in scene._keys_of(armature))
poses, seen = {}, {}
for action in labelled[: int(sys.argv[4])]:
    take = scene.take_of(bpy.context, armature, action, action.name)
    key = action.metagraph.before and scene.before(action)["action"]
    poses[f"{key} rotations"], poses[f"{key} translations"] = take.rotations, take.translations
    if take.weights is not None:
        poses[f"{key} {' '.join(take.morphs)}"] = take.weights
    middle = float(action.frame_range[0] + (action.frame_range[1] - action.frame_range[0]) // 2)
    seen[key] = [middle, heads(armature, action, middle)]
noted["heads"] = seen
np.savez(out / "poses.npz", **poses)
noted["sets"] = len({frozenset((c.data_path, c.array_index) for c in scene.curves(a)) for a in labelled})
noted["nothing"] = sorted(bpy.ops.metagraph.send(directory=str(out / "nothing")))

# An animator's day: words changed, an arm bent further, and a gesture of their own.
first, second = [a for a in labelled if a.metagraph.kind == "gesture"][:2]
first.metagraph.tags, first.metagraph.stroke, first.metagraph.end = "beat, mine", 0.4, -1.0
bone = (
    armature.pose.bones["RightUpperArm"]
    if "RightUpperArm" in armature.pose.bones
    else armature.pose.bones[-1]
)
path = f'pose.bones["{bone.name}"].rotation_quaternion'
[curve] = [c for c in scene.curves(second) if (c.data_path, c.array_index) == (path, 1)]
for key in curve.keyframe_points:
    key.co.y += 0.2
curve.update()
own = second.copy()
own.name = "Mein Gruß"
panel.place(own)
own.metagraph.name, own.metagraph.stance, own.metagraph.kind = "Mein Gruß", "a stance of my own", "gesture"
own.metagraph.layer, own.metagraph.tags = "arms", "greeting"
for keys in scene._keys_of(armature):  # and it smiles
    data, block = keys.animation_data or keys.animation_data_create(), keys.key_blocks[5]
    data.action = own
    data.action_slot = own.slots.new("KEY", "face")
    for frame, value in zip(own.frame_range, (0.0, 0.7), strict=True):
        block.value = value
        block.keyframe_insert("value", frame=frame)
    noted["shape"] = block.name
broken = own.copy()
broken.name, broken.metagraph.kind = "broken", "transition"
panel.place(broken)
assert bpy.ops.metagraph.send(directory=str(out / "back")) == {"FINISHED"}
noted["edited"] = [scene.before(first)["action"], scene.before(second)["action"]]
noted["command"] = bpy.context.window_manager.metagraph_sent
take = scene.take_of(bpy.context, armature, second, "edited")
np.savez(out / "edited.npz", rotations=take.rotations, translations=take.translations)
assert bpy.ops.metagraph.send(directory=str(out / "back")) == {"FINISHED"}  # beside, not over it
noted["files"] = sorted(p.name for p in (out / "back").iterdir())
bpy.ops.wm.save_as_mainfile(filepath=str(out / "kept.blend"))
bpy.ops.wm.open_mainfile(filepath=str(out / "kept.blend"))
noted["kept"] = sum(a.metagraph.labelled for a in bpy.data.actions)

if len(sys.argv) > 5:
    armature = panel.armature_of(bpy.context)
    bpy.context.window_manager.metagraph_address = sys.argv[5]
    assert bpy.ops.metagraph.live() == {"FINISHED"}
    link, worst, shown = panel._SESSION["poses"], 0.0, 0
    figure, corrections = panel._SESSION["figure"], panel._SESSION["own"]
    stop = time.monotonic() + 20
    while shown < 20 and time.monotonic() < stop:
        pose = link.newest()
        if pose is None:
            time.sleep(0.005)
            continue
        link._newest = pose
        assert panel.follow() is not None
        bpy.context.view_layer.update()
        turns, places = [], []
        for name in figure.names:
            matrix = armature.pose.bones[name].matrix
            q = matrix.to_quaternion()
            turns.append((q.x, q.y, q.z, q.w))
            places.append(tuple(matrix.translation))
        read, _ = figure.from_bones(corrections, np.array(turns), np.array(places))
        sent = dict(zip(link.joints, pose["rotations"], strict=True))
        other = np.array([sent[name] for name in figure.names])
        other /= np.linalg.norm(other, axis=1)[:, None]  # they are sent with few digits
        chord = np.minimum(np.linalg.norm(read - other, axis=1), np.linalg.norm(read + other, axis=1))
        worst = max(worst, float(np.degrees(4 * np.arcsin(chord.max() / 2))))
        shown += 1
    noted["live"] = {"poses": shown, "degrees": worst, "came": link.count}
    assert bpy.ops.metagraph.live() == {"FINISHED"} and not panel._SESSION
    bpy.context.window_manager.metagraph_address = "ws://127.0.0.1:9"
    try:
        noted["nobody"] = sorted(bpy.ops.metagraph.live())
    except RuntimeError as error:  # reports of errors are raised if there is no window
        noted["nobody"] = str(error)
metagraph_blender.unregister()
(out / "noted.json").write_text(json.dumps(noted, default=str))
