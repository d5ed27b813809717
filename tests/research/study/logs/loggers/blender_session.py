"""Run in a Python that imports bpy: someone works in Blender with the logger on. Prints the log's path."""

import importlib.machinery
import importlib.util
import sys
import time

import bpy

loader = importlib.machinery.SourceFileLoader("metagraph_study_log", sys.argv[1])
logger = importlib.util.module_from_spec(importlib.util.spec_from_loader("metagraph_study_log", loader))
loader.exec_module(logger)
logger.register()
begin, pause, done = (getattr(bpy.ops.metagraph, f"study_{word}") for word in ("begin", "pause", "done"))


def work(change):
    change()
    bpy.context.view_layer.update()
    bpy.ops.ed.undo_push(message="Edit")
    time.sleep(logger.APART + 0.1)


def move(x):
    bpy.context.object.location.x = x


def drag():
    for n in range(5):
        move(n)
        bpy.context.view_layer.update()
        time.sleep(0.05)


assert not begin.poll() and not pause.poll() and not done.poll()
bpy.context.window_manager.metagraph_study_participant = "P01"
bpy.context.window_manager.metagraph_study_task = sys.argv[2]
work(bpy.ops.mesh.primitive_cube_add)  # before the task
assert begin.poll() and begin() == {"FINISHED"} and not begin.poll()
work(bpy.ops.object.armature_add)
work(lambda: bpy.context.object.keyframe_insert("location"))
work(drag)
bpy.context.scene.frame_set(20)  # playing back is no edit
pause()
work(lambda: move(9))
pause()
work(lambda: move(10))
bpy.ops.ed.undo()
time.sleep(logger.APART + 0.1)
bpy.ops.ed.redo()
time.sleep(logger.APART + 0.1)
done()
work(lambda: move(12))
path = logger._state["file"].name
logger.unregister()
assert not hasattr(bpy.types.WindowManager, "metagraph_study_task")
print("seen", path)
