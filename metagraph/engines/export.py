"""Write exports: one JSON and one GLB with everything that a runtime needs."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import msgspec

from metagraph import __version__
from metagraph.common.budgets import SOUND_FILE
from metagraph.common.file_names import make_file_stem, make_file_stems
from metagraph.common.files import is_inside, make_unforeseen_error, read_file
from metagraph.common.wording import phrase
from metagraph.engines import contract as c
from metagraph.engines.export_document import list_used_clips, to_document
from metagraph.engines.export_error import ExportError
from metagraph.engines.targets.placing import Staging
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.formats.clips import digest
from metagraph.formats.store import make_writable
from metagraph.graph.check import check_project
from metagraph.graph.face.curves import fit_curves_to_face
from metagraph.graph.face.expression_presets import make_presets
from metagraph.graph.model import (
    Project,
)
from metagraph.motion.character_mesh import CharacterMesh, bind_character, is_bound_to
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import make_names_unique
from metagraph.speech.sound import guess_sound_ending

# Endings that engines import: of each, the containers that libsndfile names, and codings.
Imported = dict[str, tuple[tuple[str, ...], tuple[str, ...]]]
WAV: Imported = {".wav": (("WAV", "WAVEX"), ("PCM", "FLOAT"))}
OGG_AND_MP3: Imported = {".ogg": (("OGG",), ("VORBIS",)), ".mp3": (("MP3", "MPEG"), ("MPEG",))}
AIFF: Imported = {".aiff": (("AIFF",), ("PCM",)), ".aif": (("AIFF",), ("PCM",))}
Chosen = Callable[[Path], bool]


def choose_nothing(path: Path) -> bool:
    """Return False for every file: the user did not choose it."""
    return False


@dataclass(frozen=True)
class LineSounds:
    """The sounds of lines that go into an export, relative to the folder `base`.

    A project may come from anybody and name any file. So only sounds that are in the project's folder, or
    that this user has `chosen` by hand, go into an export. What the engine has not `imported` becomes a WAV
    file; None for an engine that takes all.
    """

    base: Path
    chosen: Chosen = choose_nothing
    imported: Imported | None = None


@dataclass(frozen=True)
class Exported:
    """What was written.

    `warnings` are problems that do not stop an export, in words. `sounds` are those of lines.
    """

    json: Path
    glb: Path
    clips: int
    warnings: tuple[str, ...] = ()
    sounds: tuple[Path, ...] = ()


def export_project(
    project: Project,
    folder: str | Path,
    expanded: bool = False,
    mesh: bool = True,
    character: Path | CharacterMesh | None = None,
    progress: Callable[[int, int, str], None] | None = None,
    compress: bool = False,
) -> Exported:
    """Write `<name>.json` and `<name>.glb` into a folder.

    `expanded` also lists the expanded state machine. `mesh` puts the character's mesh into the GLB;
    `character` is the mesh, or its file. `compress` packs the GLB, see `write_glb`. Raises ExportError while
    the project has errors, FileError if a file cannot be written.
    """
    warnings = require_exportable(project)
    place = Path(folder)
    with Staging(place) as staged:
        made = write_project_files(
            project, staged.path, expanded, character if mesh else None, progress, compress=compress
        )
        names = [path.relative_to(staged.path).as_posix() for path in (made.glb, *made.sounds, made.json)]
        staged.move(names)
    return replace(
        made,
        json=place / made.json.name,
        glb=place / made.glb.name,
        sounds=tuple(place / path.relative_to(staged.path) for path in made.sounds),
        warnings=(*made.warnings, *warnings),
    )


def require_exportable(project: Project) -> tuple[str, ...]:
    """Return the warnings about a project that can be exported, in words. Raises ExportError with what must
    be corrected first.
    """
    problems = check_project(project)
    errors = [p for p in problems if p.severity == "error"]
    if errors:
        first, rest = errors[0], len(errors) - 1
        words = "{message}. {remedy} (and {rest} more)" if rest else "{message}. {remedy}"
        raise ExportError(phrase(words, message=first.message, remedy=first.remedy, rest=rest))
    if project.skeleton is None or not any(True for _ in project.actions()):
        raise ExportError(phrase("there is nothing to export: place an action first"))
    return tuple(
        phrase("{message}. {remedy}", message=p.message, remedy=p.remedy)
        for p in problems
        if p.severity == "warning"
    )


def make_export_stem(project: Project) -> str:
    """Return the stem of a project's exported files."""
    return make_file_stem(re.sub(r"[^\w.-]+", "_", project.name).strip("._"), "metagraph")


def write_project_files(
    project: Project,
    folder: str | Path,
    expanded: bool = False,
    character: Path | CharacterMesh | None = None,
    progress: Callable[[int, int, str], None] | None = None,
    voices: LineSounds | None = None,
    compress: bool = False,
    base: Path | None = None,
) -> Exported:
    """Write a project that has clips without checking it for errors. The arguments are those of
    `export_project`. `voices` are copied into `lines/`, if they are given. `base` is the folder that the
    props' paths are relative to, None to leave them out.
    """
    project = make_writable(project)
    tell = progress or (lambda done, total, words: None)
    assert project.skeleton is not None
    used = list_used_clips(project)
    stem, target = make_export_stem(project), Path(folder)
    glb, json = target / f"{stem}.glb", target / f"{stem}.json"
    names = make_names_unique([entry.name for entry in used])
    tell(0, 3, "clips")
    clips = [clip.dense for clip in list_exported_clips(project)]
    notes = _write_glb(glb, clips, project, character, compress, base)
    tell(1, 3, "graph")
    document = to_document(project, glb.name, names, expanded)
    document.glb_bytes, document.glb_sha256 = glb.stat().st_size, digest(glb)
    document.exporter = f"Metagraph {__version__}"
    sounds, missing = _sounds(document, target, voices) if voices is not None else ((), ())
    tell(2, 3, "writing")
    write_atomically(json, msgspec.json.encode(document) + b"\n")
    tell(3, 3, "done")
    return Exported(json, glb, len(used), (*notes, *missing), sounds)


def write_indented_export(path: Path) -> None:
    """Break and indent the JSON of an export that was written, for people; it is more than twice as large."""
    write_atomically(path, msgspec.json.format(path.read_bytes(), indent=1))


def _sounds(document: c.Export, folder: Path, voices: LineSounds) -> tuple[tuple[Path, ...], tuple[str, ...]]:
    """Copy the sounds of a document's lines beside it, and set their names there; return the files, and what
    is missing, in words.
    """
    lines = [(ident, line) for ident, line in document.lines.items() if line.audio]
    names = make_file_stems(Path(str(line.audio)).stem for _, line in lines)
    files, missing = [], []
    for (ident, line), name in zip(lines, names, strict=True):
        source = voices.base / str(line.audio)
        try:
            ending = guess_sound_ending(source)
            if not is_inside(source, voices.base) and not voices.chosen(source):
                remedy = "Move it there, or choose the line's sound by hand."
                raise FileError(
                    source, phrase("is outside the project's folder"), phrase("its sound"), remedy
                )
            as_it_is = line.channel is None and _is_imported(source, ending, voices.imported)
            inside = f"lines/{name}{ending if as_it_is else '.wav'}"
            content = read_file(source, SOUND_FILE) if as_it_is else _as_wav(source, line.channel)
        except Exception as error:  # one bad sound never spoils an export
            missing.append(f"the sound of line '{ident}' is left out: {make_unforeseen_error(source, error)}")
            document.lines[ident] = msgspec.structs.replace(line, audio=None, channel=None)
            continue
        write_atomically(folder / inside, content)
        document.lines[ident] = msgspec.structs.replace(line, audio=inside, channel=None)
        files.append(folder / inside)
    return tuple(files), tuple(missing)


def _is_imported(source: Path, ending: str, imported: Imported | None) -> bool:
    """Return whether an engine imports a sound as it is."""
    import soundfile

    if imported is None:
        return True
    containers, codings = imported.get(ending, ((), ()))
    info = soundfile.info(str(source))
    return info.format in containers and info.subtype.startswith(codings)


def _as_wav(source: Path, channel: int | None) -> bytes:
    """Return a sound as a WAV file; one channel of it, because engines cannot choose channels, or all if
    None. Raises FileError.
    """
    import io

    import soundfile

    from metagraph.speech.sound import read_recording, read_sound

    if channel is None:
        recording = read_recording(source)
        samples, rate = recording.samples.T, recording.rate
    else:
        samples, rate = read_sound(source, channel)
    out = io.BytesIO()
    soundfile.write(out, samples, rate, format="WAV", subtype="PCM_16")
    return out.getvalue()


def _write_glb(
    path: Path,
    clips: list[Clip],
    project: Project,
    character: Path | CharacterMesh | None,
    compress: bool,
    base: Path | None,
) -> list[str]:
    """Write the GLB without hidden meshes; return what is not in it, in words."""
    from metagraph.engines.placed_props import place_props
    from metagraph.formats.gltf.writer import ForEngine, write_glb

    skeleton = project.skeleton
    assert skeleton is not None

    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(
            path.parent,
            phrase("cannot be created ({strerror})", strerror=error.strerror),
            phrase("creating the folder"),
            phrase("Choose a folder that you can write to."),
        ) from None
    shown, notes = place_mesh_on(project, character)
    presets = make_presets(shown.morphs, project.face.channels) if shown is not None else {}
    props, unread = place_props(project, base)
    engine = ForEngine(expressions=presets, props=props)
    write_glb(path, clips, shown, engine=engine, compress=compress)
    return [*notes, *unread]


def place_mesh_on(
    project: Project, given: Path | CharacterMesh | None
) -> tuple[CharacterMesh | None, list[str]]:
    """Return the mesh that is written for a project's clips, without hidden meshes, and notes about it. A
    mesh of another skeleton is bound by the names of its joints or fitted, as the preview draws it, and left
    out if the preview does not draw it. Raises FileError.
    """
    from metagraph.formats.gltf.reader import read_character
    from metagraph.motion.fitting.fit_character import is_named_alike, put_on_skeleton
    from metagraph.motion.fitting.footing import choose_footing

    skeleton = project.skeleton
    assert skeleton is not None

    body = read_character(given) if isinstance(given, Path) else given
    if body is None or given is None:
        return None, []
    notes = []
    if body.skeleton != skeleton:
        alike = is_named_alike(body, skeleton)
        there, count = sum(name in skeleton for name in body.skeleton.names), len(body.skeleton)
        footing = choose_footing((entry.motion for entry in project.clips.values()), skeleton)
        placed, why = put_on_skeleton(body, skeleton, footing)
        if why is not None:
            return None, [
                f"the mesh of '{given.name}' is left out: it has another skeleton than the clips, and {why}"
            ]
        other = f"the mesh of '{given.name}' has another skeleton than the clips: it is "
        if alike or placed is body:
            more = "; the others move with the joint above them" if there < count else ""
            notes.append(f"{other}bound by the names of its joints, {there} of {count}{more}")
        else:
            notes.append(f"{other}fitted to theirs, joint by joint")
        body = placed if is_bound_to(placed, skeleton) else bind_character(placed, skeleton)
    shown = body.without(project.hidden)
    return shown if len(shown.triangles) else None, notes


def list_exported_clips(project: Project) -> list[Clip]:
    """Return the motion of the exported clips, with the names they get, and with their curves on the
    project's face.
    """
    used = [e for e in list_used_clips(project) if e.motion is not None]
    names = make_names_unique([entry.name for entry in list_used_clips(project)])
    assert project.skeleton is not None
    return [
        replace(fit_curves_to_face(project, e.motion).renamed(name), skeleton=project.skeleton)
        for e, name in zip(used, names, strict=True)
        if e.motion is not None
    ]


def export_schema_text() -> bytes:
    """Return the text of the published schema."""
    return msgspec.json.format(msgspec.json.encode(c.export_schema()), indent=1) + b"\n"
