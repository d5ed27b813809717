# SPDX-License-Identifier: GPL-3.0-or-later
"""What its user sees: properties of actions, the panel in two sidebars, and what its buttons do."""

import json
from pathlib import Path
from typing import Any

import bpy
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    PointerProperty,
    StringProperty,
)
from bpy_extras.io_utils import ImportHelper

from . import labels, scene
from .link import LinkError, Poses

_SESSION: dict[str, Any] = {}  # the live link: poses, armature's name, figure, corrections


def _choices(words: tuple[str, ...]) -> list[tuple[str, str, str]]:
    return [(word, word.capitalize(), "") for word in words]


def _stances(own: Any, context: Any, edit: str) -> list[str]:
    """Return the stances that may be meant, of the label's layer."""
    armature = armature_of(context)
    known = json.loads(armature[scene.STANCES]) if armature is not None else {}
    return [name for name in known.get(own.layer, ()) if edit.lower() in name.lower()]


def _seconds(name: str, text: str) -> Any:
    return FloatProperty(name=name, description=text, min=0, precision=3, subtype="NONE")


def _maybe(name: str, text: str) -> Any:
    return FloatProperty(
        name=name,
        description=f"{text}. Seconds of the clip; -1: none, or found",
        default=-1,
        min=-1,
        precision=3,
    )


class MetagraphLabel(bpy.types.PropertyGroup):
    """What an action is in the graph."""

    labelled: BoolProperty(name="In the graph")
    name: StringProperty(name="Name")
    kind: EnumProperty(name="Kind", items=_choices(labels.KINDS), default="gesture")
    layer: EnumProperty(name="Layer", items=_choices(labels.LAYERS), default="arms")
    stance: StringProperty(
        name="Stance", description="Whose it is; a new name makes a stance",
        search=_stances, search_options={"SUGGESTION"},
    )  # fmt: skip
    end_stance: StringProperty(
        name="Ends in", description="Stance that a transition ends in",
        search=_stances, search_options={"SUGGESTION"},
    )  # fmt: skip
    limb: EnumProperty(name="Limb", items=_choices(labels.LIMBS), default="both")
    tags: StringProperty(name="Tags", description="Words with commas between them")
    joints: StringProperty(name="Joints", description="The only ones it moves; all where empty")
    likelihood: FloatProperty(name="Likelihood", default=1, min=0)
    cooldown: _seconds("Cooldown", "Seconds in which it is not drawn again")
    start: _seconds("Start", "Where it begins in its clip")
    blend_in: _seconds("Blend in", "Seconds of blending from the stance; of a loop, its seam")
    blend_out: _seconds("Blend out", "Seconds of blending back")
    loop: BoolProperty(name="Loop")
    repeat: _seconds("Repeats", "For how many seconds it repeats its part; 0 plays it once")
    end: _maybe("End", "Where it ends")
    earliest_exit: _maybe("Earliest exit", "From where it may be left")
    stroke: _maybe("Stroke", "Its most telling moment")
    ready: _maybe("Ready", "Where the preparation ends")
    stroke_end: _maybe("Stroke end", "Where the stroke ends")
    relax: _maybe("Relax", "Where the hold ends")
    clip: StringProperty(options={"HIDDEN"})
    fps: FloatProperty(options={"HIDDEN"})
    before: StringProperty(options={"HIDDEN"})
    digest: StringProperty(options={"HIDDEN"})


def armature_of(context: Any) -> Any:
    """Return the imported armature that is meant: the active one, that of the active mesh, or the only."""
    active = context.object
    if active is not None:
        for one in (active, active.parent):
            if one is not None and scene.JOINTS in one:
                return one
    found = [o for o in bpy.data.objects if scene.JOINTS in o]
    return found[0] if len(found) == 1 else None


def action_of(context: Any) -> Any:
    """Return the action that is edited."""
    shown = getattr(context.space_data, "action", None) if context.space_data is not None else None
    armature = armature_of(context)
    data = armature.animation_data if armature is not None else None
    return shown or (data.action if data is not None else None)


class MetagraphImport(bpy.types.Operator, ImportHelper):
    """Read an export: its JSON and the GLB beside it"""

    bl_idname = "metagraph.load"
    bl_label = "Import Metagraph export"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012
    filename_ext = ".json"
    filter_glob: StringProperty(default="*.json", options={"HIDDEN"})

    def execute(self, context: Any) -> set[str]:
        try:
            armature = scene.load(context, Path(self.filepath))
        except (ValueError, RuntimeError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        context.view_layer.objects.active = armature
        count = sum(a.metagraph.labelled for a in bpy.data.actions)
        self.report({"INFO"}, f"{armature.name}: {count} actions")
        return {"FINISHED"}


class MetagraphSend(bpy.types.Operator):
    """Write new and changed actions, clips and labels, for `metagraph import`"""

    bl_idname = "metagraph.send"
    bl_label = "Send back"
    directory: StringProperty(subtype="DIR_PATH")
    everything: BoolProperty(name="Also what did not change")

    def invoke(self, context: Any, event: Any) -> set[str]:
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: Any) -> set[str]:
        try:
            files, notes = scene.send(context, armature_of(context), Path(self.directory), self.everything)
        except (ValueError, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        for note in notes:
            self.report({"WARNING"}, note)
        if not files:
            return {"CANCELLED"}
        line = scene.command(files)
        context.window_manager.clipboard = context.window_manager.metagraph_sent = line
        self.report({"INFO"}, f"Copied: {line}")
        return {"FINISHED"}


class MetagraphPlace(bpy.types.Operator):
    """Make the action that is edited one of the graph"""

    bl_idname = "metagraph.place"
    bl_label = "Label this action"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012

    @classmethod
    def poll(cls, context: Any) -> bool:
        return action_of(context) is not None

    def execute(self, context: Any) -> set[str]:
        place(action_of(context))
        return {"FINISHED"}


def place(action: Any) -> None:
    """Label an action as a new one of the graph, with the blends that a dropped clip gets."""
    own = action.metagraph
    start, end = action.frame_range
    quarter = (end - start) / scene.rate(bpy.context.scene) / 4
    own.labelled, own.before, own.digest, own.clip, own.fps = True, "", "", action.name, 0.0
    own.name = own.name or action.name
    own.blend_in, own.blend_out = min(0.2, quarter), min(0.25, quarter)
    action.use_fake_user = True


class MetagraphLive(bpy.types.Operator):
    """Follow the poses of `metagraph live`, or stop"""

    bl_idname = "metagraph.live"
    bl_label = "Live"

    def execute(self, context: Any) -> set[str]:
        if _SESSION:
            stop()
            return {"FINISHED"}
        try:
            start(context)
        except (LinkError, ValueError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


def start(context: Any) -> None:
    """Begin to follow a live session. Raises LinkError, ValueError."""
    armature = armature_of(context)
    figure = scene.figure_of(armature)
    manager = context.window_manager
    poses = Poses(manager.metagraph_address, scene.rate(context.scene), manager.metagraph_token)
    _SESSION.update(poses=poses, name=armature.name, figure=figure, own=scene.corrections(armature, figure))
    bpy.app.timers.register(follow, first_interval=0.0, persistent=True)


def follow() -> float | None:
    """Show the newest pose; called by Blender's timer until it ends."""
    poses = _SESSION.get("poses")
    armature = bpy.data.objects.get(_SESSION.get("name", ""))
    if poses is None or armature is None or poses.ended:
        stop()
        return None
    pose = poses.newest()
    if pose is not None:
        scene.show(armature, _SESSION["figure"], _SESSION["own"], poses.joints, poses.morphs, pose)
    return 1 / 60


def stop() -> None:
    """End the live link."""
    poses = _SESSION.pop("poses", None)
    _SESSION.clear()
    if poses is not None:
        poses.close()
    if bpy.app.timers.is_registered(follow):
        bpy.app.timers.unregister(follow)


class _Panel:
    bl_label = "Metagraph"
    bl_category = "Metagraph"
    bl_region_type = "UI"

    def draw(self, context: Any) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.operator("metagraph.load", icon="IMPORT", text="Import export…")
        if armature_of(context) is None:
            layout.label(text="Import an export, or choose its armature")
            return
        action = action_of(context)
        if action is None:
            layout.label(text="No action is edited")
        elif not action.metagraph.labelled:
            layout.operator("metagraph.place", icon="ADD")
        else:
            _draw_label(layout, action, context)
        layout.separator()
        layout.operator("metagraph.send", icon="EXPORT", text="Send back…")
        if context.window_manager.metagraph_sent:
            layout.prop(context.window_manager, "metagraph_sent")
        row = layout.row(align=True)
        row.prop(context.window_manager, "metagraph_address", text="")
        row.operator(
            "metagraph.live", icon="PAUSE" if _SESSION else "PLAY", text="Stop" if _SESSION else "Live"
        )
        layout.prop(context.window_manager, "metagraph_token")


def _draw_label(layout: Any, action: Any, context: Any) -> None:
    own = action.metagraph
    layout.prop(own, "name")
    fields = ["kind", "layer", "stance", *(["end_stance"] if own.kind == "transition" else [])]
    fields += [*(["limb"] if own.layer == "arms" else []), "tags", "likelihood", "cooldown"]
    for field in fields:
        layout.prop(own, field)
    times = ["start", "end", "blend_in", "blend_out", "earliest_exit", "loop"]
    times += ["repeat"] if own.kind in ("gesture", "fidget") else []
    column = layout.column(align=True)
    for field in times + (["ready", "stroke", "stroke_end", "relax"] if own.kind == "gesture" else []):
        column.prop(own, field)
    start, end = action.frame_range
    for fault in labels.faults(scene.label(action), (end - start) / scene.rate(context.scene)):
        layout.label(text=fault.capitalize(), icon="ERROR")


class VIEW3D_PT_metagraph(_Panel, bpy.types.Panel):  # noqa: N801 - Blender wants such names
    bl_space_type = "VIEW_3D"


class DOPESHEET_PT_metagraph(_Panel, bpy.types.Panel):  # noqa: N801
    bl_space_type = "DOPESHEET_EDITOR"


CLASSES = (
    MetagraphLabel,
    MetagraphImport,
    MetagraphSend,
    MetagraphPlace,
    MetagraphLive,
    VIEW3D_PT_metagraph,
    DOPESHEET_PT_metagraph,
)


def _menu(self: Any, context: Any) -> None:
    self.layout.operator("metagraph.load", text="Metagraph export (.json)")


def register() -> None:
    for one in CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Action.metagraph = PointerProperty(type=MetagraphLabel)
    bpy.types.WindowManager.metagraph_address = StringProperty(
        name="Session", description="Where `metagraph live` listens", default="ws://127.0.0.1:8765"
    )
    bpy.types.WindowManager.metagraph_token = StringProperty(name="Token", subtype="PASSWORD")
    bpy.types.WindowManager.metagraph_sent = StringProperty(
        name="Take in", description="The line that takes what was sent into a project; copied, too"
    )
    bpy.types.TOPBAR_MT_file_import.append(_menu)


def unregister() -> None:
    stop()
    bpy.types.TOPBAR_MT_file_import.remove(_menu)
    del bpy.types.WindowManager.metagraph_sent
    del bpy.types.WindowManager.metagraph_token
    del bpy.types.WindowManager.metagraph_address
    del bpy.types.Action.metagraph
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
