"""A module that stands in for Unreal's, by the names that the study log needs; then someone works with the log on."""

import importlib.machinery
import importlib.util
import sys
import time
import types


class Package:
    def __init__(self, name):
        self.get_name = lambda: name


dirty, ticks = [], []
unreal = types.ModuleType("unreal")
unreal.Paths = types.SimpleNamespace(project_saved_dir=lambda: sys.argv[2])
unreal.SystemLibrary = types.SimpleNamespace(get_engine_version=lambda: "5.4.0 stand-in")
unreal.EditorLoadingAndSavingUtils = types.SimpleNamespace(
    get_dirty_content_packages=lambda: map(Package, dirty)
)
unreal.log = print
unreal.register_slate_post_tick_callback = lambda look: ticks.append(look) or len(ticks)
sys.modules["unreal"] = unreal

loader = importlib.machinery.SourceFileLoader("metagraph_study_log", sys.argv[1])
study = importlib.util.module_from_spec(importlib.util.spec_from_loader("metagraph_study_log", loader))
loader.exec_module(study)


def work(*names):
    """Leave these assets changed and unsaved; the editor shows a few frames."""
    dirty[:] = names
    for _ in range(6):
        time.sleep(0.1)
        ticks[0](0.1)


study.begin("P01", sys.argv[3])
work("AnimBlueprint")
work("AnimBlueprint", "Montage")
work()
study.pause()
work("AnimBlueprint")
study.go_on()
work("AnimBlueprint", "Montage")
study.done()
work()
