"""The export itself, alone or with a runtime beside it that plays it as the preview does."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

from metagraph import engines
from metagraph.common.wording import phrase
from metagraph.engines.export import AIFF, OGG_AND_MP3, WAV, Imported, LineSounds, write_project_files
from metagraph.engines.targets.target import ExportedFiles, ExportOrder, ExportTarget, Loss
from metagraph.errors import FileError

RUNTIMES = Path(engines.__file__).with_name("runtimes")
REQUESTS = (
    "../../../../docs/agents/requests.md"  # where a README finds them here; an export carries them along
)
SPEECH = "../../../../docs/agents/speech.md"
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
    return ExportedFiles((made.json, made.glb, *made.sounds), made.warnings)


def copy_runtime(source: Path, target: Path, leave: tuple[str, ...] = ()) -> list[Path]:
    """Copy a runtime's files; return them. leave: names that are not copied. Raises FileError."""
    out = []
    for path in sorted(source.rglob("*")):
        inside = path.relative_to(source)
        if path.is_dir() or any(p in leave or p == "__pycache__" or p.startswith(".") for p in inside.parts):
            continue
        place = target / inside
        try:
            place.parent.mkdir(parents=True, exist_ok=True)
            if path.name == "README.md":
                text = path.read_text(encoding="utf-8")
                if REQUESTS in text or SPEECH in text:
                    page = place.with_name("requests.md")
                    shutil.copyfile(RUNTIMES / page.name, page)
                    out.append(page)
                text = text.replace(SPEECH, "requests.md#speech-synthesisers")
                place.write_text(text.replace(REQUESTS, "requests.md"), encoding="utf-8")
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


def _with(
    runtime: str, under: str, imported: Imported | None = None
) -> Callable[[ExportOrder], ExportedFiles]:
    def write(order: ExportOrder) -> ExportedFiles:
        made = write_with_sounds(order, imported)
        return ExportedFiles(
            (*made.files, *copy_runtime(RUNTIMES / runtime, order.folder / under)), made.notes
        )

    return write


PLUGIN = "Plugins/Metagraph"  # where Unreal looks for a project's plugins


def _plugin(order: ExportOrder) -> ExportedFiles:
    """Write the export and Unreal's plugin, the C++ runtime inside it."""
    made = write_with_sounds(order)
    files = copy_runtime(RUNTIMES / "unreal", order.folder / PLUGIN)
    core = order.folder / PLUGIN / "Source" / "Metagraph" / "Private" / "Core"
    files += copy_runtime(
        RUNTIMES / "cpp", core, ("README.md", "LICENSE", "conformance.hpp", "conformance.cpp")
    )
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
    ),
    ExportTarget(
        "godot",
        phrase("Godot 4 add-on"),
        phrase("JSON, GLB and the GDScript runtime in addons/metagraph/"),
        _with("godot", ".", WAV | OGG_AND_MP3),
        (BML,),
        group=phrase("Same playback as the preview"),
    ),
    ExportTarget(
        "unity",
        phrase("Unity package"),
        phrase("JSON, GLB and the C# runtime in Metagraph/"),
        _with("unity", "Metagraph", WAV | OGG_AND_MP3 | AIFF),
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
