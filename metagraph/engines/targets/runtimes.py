"""The export itself, alone or with a runtime beside it that plays it as the preview does."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from pathlib import Path

from metagraph import engines
from metagraph.common.wording import phrase
from metagraph.engines.engine_machine import list_machines
from metagraph.engines.export import (
    AIFF,
    OGG_AND_MP3,
    WAV,
    Imported,
    LineSounds,
    write_indented_export,
    write_project_files,
)
from metagraph.engines.targets.godot_library import write_animation_library
from metagraph.engines.targets.godot_scene import (
    MOTION,
    write_godot_scene,
    write_import_settings,
    write_tree_scene,
)
from metagraph.engines.targets.godot_tree import spell_for_godot, write_animation_tree
from metagraph.engines.targets.target import ExportedFiles, ExportOrder, ExportTarget, Loss
from metagraph.engines.targets.typed_wrappers import write_wrapper
from metagraph.engines.targets.unity_humanoid import write_humanoid
from metagraph.engines.targets.unity_package import write_package_metas
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically

RUNTIMES = Path(engines.__file__).with_name("runtimes")
# Where READMEs find requests here; an export carries them along.
REQUESTS = re.compile(r"(?:\.\./)+" + re.escape("docs/agents/requests.md"))
SPEECH = re.compile(r"(?:\.\./)+" + re.escape("docs/agents/speech.md"))
BML = Loss(phrase("only the desktop app reads requests in Behaviour Markup Language"))


def write_with_sounds(order: ExportOrder, imported: Imported | None = None) -> ExportedFiles:
    """Write JSON, GLB and the lines' sounds, as files that the engine has `imported`; None for any."""
    given = order.contents
    voices = LineSounds(given.base, given.chosen, imported) if given.base is not None else None
    made = write_project_files(
        order.project,
        order.folder,
        given.expanded,
        given.character,
        order.tell,
        voices,
        given.compress,
        given.base,
    )
    if given.pretty:
        write_indented_export(made.json)
    return ExportedFiles((made.json, made.glb, *made.sounds), made.warnings)


def copy_runtime(source: Path, target: Path, leave: tuple[str, ...] = ()) -> list[Path]:
    """Copy a runtime's files; return them. leave: names that are not copied. Raises FileError."""
    out = []
    for path in sorted(source.rglob("*")):
        inside = path.relative_to(source)
        if path.is_dir() or any(p in leave or p == "__pycache__" or _is_hidden(p) for p in inside.parts):
            continue
        place = target / inside
        try:
            place.parent.mkdir(parents=True, exist_ok=True)
            if path.name == "README.md":
                text = path.read_text(encoding="utf-8")
                if REQUESTS.search(text) or SPEECH.search(text):
                    page = place.with_name("requests.md")
                    shutil.copyfile(RUNTIMES / page.name, page)
                    out.append(page)
                text = SPEECH.sub("requests.md#speech-synthesisers", text)
                place.write_text(REQUESTS.sub("requests.md", text), encoding="utf-8")
            else:
                shutil.copyfile(path, place)
        except OSError as error:
            raise FileError(
                place,
                phrase("cannot be written ({strerror})", strerror=error.strerror),
                phrase("copying the runtime"),
                phrase("Choose a folder that you can write to, with enough free space."),
            ) from None
        out.append(place)
    return out


def _is_hidden(name: str) -> bool:
    return name.startswith(".") and name != ".gdignore"  # which keeps Godot out of a folder


def _with(runtime: str, under: str) -> Callable[[ExportOrder], ExportedFiles]:
    def write(order: ExportOrder) -> ExportedFiles:
        made = write_with_sounds(order)
        files = [*write_wrapper(order, runtime), *copy_runtime(RUNTIMES / runtime, order.folder / under)]
        return ExportedFiles((*made.files, *files), made.notes)

    return write


def _copy_glb(order: ExportOrder, ending: str) -> Path:
    """Copy the GLB under a name that an engine does not import, so that its bytes stay readable."""
    target = order.folder / f"{order.stem}{ending}"
    shutil.copyfile(order.folder / f"{order.stem}.glb", target)
    return target


def _godot(order: ExportOrder) -> ExportedFiles:
    """Write the export, the add-on, a scene that plays, and the same clips as Godot's own resources."""
    made = write_with_sounds(order, WAV | OGG_AND_MP3)
    project, folder, stem = order.project, order.folder, order.stem
    files = [_copy_glb(order, MOTION), *write_godot_scene(project, folder, stem)]
    files.append(write_import_settings(folder, f"{stem}.glb", False))
    built = list_machines(project, spell_for_godot)
    if built:
        library, tree = folder / f"{stem}.library.tres", folder / f"{stem}.tree.tres"
        write_atomically(library, write_animation_library(project, built).encode())
        write_atomically(tree, write_animation_tree(project, built, 4).encode())
        scene = write_tree_scene(project, folder, stem, f"{stem}.tree", built, library.name)
        files += [library, tree, *scene]
    for part in ("addons", "godot3"):
        files += copy_runtime(RUNTIMES / "godot" / part, folder / part)
    files += write_wrapper(order, "gdscript")
    return ExportedFiles((*made.files, *files), made.notes)


def _unity(order: ExportOrder) -> ExportedFiles:
    """Write the export and a package whose files have their `.meta`."""
    made = write_with_sounds(order, WAV | OGG_AND_MP3 | AIFF)
    package = order.folder / "Metagraph"
    files = copy_runtime(RUNTIMES / "unity", package)
    metas = write_package_metas(package, files)
    own = [_copy_glb(order, ".metagraph"), *write_wrapper(order, "csharp")]
    bones = write_humanoid(order.project)
    if bones is not None:
        own.append(order.folder / f"{order.stem}.humanoid.json")
        write_atomically(own[-1], bones)
    return ExportedFiles((*made.files, *own, *files, *metas), made.notes)


PLUGIN = "Plugins/Metagraph"  # where Unreal looks for a project's plugins
CORE_IN_PLUGIN = "Source/Metagraph/Private/Core"


def copy_core(folder: Path) -> list[Path]:
    """Copy the C++ headers that Unreal's plugin includes; return them. Raises FileError."""
    return copy_runtime(
        RUNTIMES / "cpp", folder, ("README.md", "LICENSE", "conformance.hpp", "conformance.cpp")
    )


def _plugin(order: ExportOrder) -> ExportedFiles:
    """Write the export and Unreal's plugin, the C++ runtime inside it."""
    made = write_with_sounds(order)
    files = copy_runtime(RUNTIMES / "unreal", order.folder / PLUGIN)
    files += copy_core(order.folder / PLUGIN / CORE_IN_PLUGIN)
    return ExportedFiles((*made.files, *files), made.notes)


TARGETS = (
    ExportTarget(
        "metagraph",
        "Metagraph (JSON + GLB)",
        phrase("a JSON file with the graph and a GLB file with its clips"),
        write_with_sounds,
        group=phrase("Same playback as the preview"),
        unpacks=True,
    ),
    ExportTarget(
        "javascript",
        "JavaScript, three.js",
        phrase("JSON, GLB and the runtime in metagraph/: ES modules for browsers, Node and three.js"),
        _with("javascript", "metagraph"),
        (BML,),
        group=phrase("Same playback as the preview"),
        unpacks=True,
        packs=True,
    ),
    ExportTarget(
        "godot",
        phrase("Godot 4 add-on"),
        phrase("scenes that play, an AnimationLibrary, JSON, GLB and the add-on in addons/metagraph/"),
        _godot,
        (BML,),
        group=phrase("Same playback as the preview"),
    ),
    ExportTarget(
        "unity",
        phrase("Unity package"),
        phrase("a file that imports as a character with clips, JSON, GLB and the C# package in Metagraph/"),
        _unity,
        (BML,),
        untried=phrase("compiled and tested outside Unity; not tested in Unity"),
        group=phrase("Same playback as the preview"),
        unpacks=True,
    ),
    ExportTarget(
        "cpp",
        "C++17",
        phrase("JSON, GLB and the runtime in metagraph/: headers that need only the standard library"),
        _with("cpp", "metagraph"),
        (BML,),
        group=phrase("Same playback as the preview"),
        unpacks=True,
    ),
    ExportTarget(
        "unreal",
        phrase("Unreal 5 plugin"),
        phrase("JSON, GLB and a plugin with the C++ runtime in Plugins/Metagraph/"),
        _plugin,
        (BML,),
        untried=phrase("compiled and tested with stand-ins for Unreal's types; not tested in Unreal"),
        group=phrase("Same playback as the preview"),
    ),
)
