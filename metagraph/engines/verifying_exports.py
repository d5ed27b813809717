"""Verifying exports: the JSON against its schema and its GLB, the sounds it names, and the files that the
record of an export names against their digests. Nothing is changed.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

import msgspec

from metagraph.common.budgets import TEXT_FILE
from metagraph.common.files import is_file, is_inside, make_unforeseen_error, open_file, read_file
from metagraph.common.network_paths import explain_refusal
from metagraph.engines import contract as c
from metagraph.engines.reading import read_export
from metagraph.engines.targets.placing import RECORD, ExportRecord, find_forsaken_staging, read_record
from metagraph.engines.targets.registry import list_targets
from metagraph.errors import FileError, clean_text
from metagraph.formats.clips import digest
from metagraph.formats.gltf.file import open_gltf
from metagraph.formats.gltf.reader import read_gltf_clips
from metagraph.formats.project.verified import (
    VerificationFault,
    Verified,
    VerifiedPart,
    count_in_words,
    describe_whole,
    make_fault,
)
from metagraph.formats.project.verifying import BROKEN, find_unfinished_files, verify_project
from metagraph.formats.store import SUFFIX
from metagraph.graph.check import check_project
from metagraph.speech.sound import read_head

AGAIN = "Export it again."
BOTH = "Export it again, and copy both files."
MARKS = (b'"metagraph"', b'"glb"', b'"height"')  # what the JSON of an export begins with
HEAD = 1 << 16


def verify(path: Path) -> list[Verified]:
    """Look at a project, an export, or at all that lie in a folder. Raises FileError if there is none."""
    if path.is_dir():
        projects = sorted(p for p in path.iterdir() if p.name.endswith(SUFFIX) and is_file(p))
        found = [*(verify_project(p) for p in projects), *_exports_in(path)]
        if not found:
            raise FileError(path, "holds no project and no export", "", "Name one, or the folder it is in.")
        return found
    if not is_file(path):
        read_file(path, TEXT_FILE)  # says why it is none
    if _is_pair(path):
        path = path.resolve()  # a linked file belongs to what lies beside the file itself
    root = _root_of(path)
    if root is not None:
        return [_recorded(root)]
    if not _is_pair(path):
        found_project = verify_project(path)
        if not path.name.endswith(SUFFIX) and found_project.parts[0].faults:
            raise FileError(
                path,
                "is neither a project nor an export",
                "",
                "Name a project, an export's JSON or GLB, or a folder. 'metagraph info' tells of clip files.",
            )
        return [found_project]
    return [_export(str(path), "export", [_json_of(path)])]


def _exports_in(folder: Path) -> list[Verified]:
    recorded = [_recorded(folder)] if is_file(folder / RECORD) else []
    if recorded and read_record(folder) is None:
        return recorded  # nobody knows which of the files are of that export
    known = _jsons_of_record(folder)
    alone = [path for path in sorted(folder.glob("*.json")) if path not in known and _is_export(path)]
    return [*recorded, *(_export(str(path), "export", [path]) for path in alone)]


def _is_pair(path: Path) -> bool:
    """Return whether a file's name is of an export's JSON or GLB."""
    return path.suffix.lower() in (".json", ".glb")


def _root_of(path: Path) -> Path | None:
    """Return the folder of the export that a file is recorded in; None if none is."""
    whole = path.absolute()
    if whole.name == RECORD:
        return path.parent
    for folder in whole.parents:
        if is_file(folder / RECORD):
            record = read_record(folder)
            if record is None and folder == whole.parent and _is_pair(path):
                return folder
            if record is not None and whole.relative_to(folder).as_posix() in record.files:
                return folder
    return None


def _is_export(path: Path) -> bool:
    try:
        with open_file(path, TEXT_FILE) as file:
            head = file.read(HEAD)
    except FileError:
        return False
    return all(mark in head for mark in MARKS)


def _json_of(path: Path) -> Path:
    """Return the JSON of an export's JSON or GLB. Raises FileError if it is none."""
    if path.suffix.lower() == ".json":
        if _is_export(path) or is_file(path.with_suffix(".glb")):
            return path
        raise FileError(path, "is no export of Metagraph", "", "Name the JSON that lies beside its GLB.")
    for json in sorted(path.parent.glob("*.json")):
        if _is_export(json) and (document := _decoded(json)) is not None and document.glb == path.name:
            return json
    if is_file(path.with_suffix(".json")):
        return path.with_suffix(".json")
    raise FileError(
        path,
        "belongs to no export: no JSON beside it names it",
        "",
        "Put the export's JSON beside it. 'metagraph info' tells of clip files.",
    )


def _decoded(path: Path) -> c.Export | None:
    try:
        return msgspec.json.decode(read_file(path, TEXT_FILE), type=c.Export)
    except (FileError, msgspec.MsgspecError, RecursionError, UnicodeDecodeError):
        return None


# --- the record of an export, and the files it names


def _jsons_of_record(folder: Path) -> list[Path]:
    record = read_record(folder)
    names = sorted(record.files) if record is not None else []
    paths = [folder / name for name in names if name.endswith(".json") and _is_own(name, folder)]
    return [path for path in paths if _is_export(path)]


def _is_own(name: str, folder: Path) -> bool:
    """Return whether a record names a file that an export could have written."""
    return explain_refusal(name) is None and is_inside(folder / name, folder)


def _recorded(folder: Path) -> Verified:
    record = read_record(folder)
    if record is None:
        part = VerifiedPart(
            "record", "not whole", (VerificationFault(RECORD, "is damaged or not a record.", AGAIN),)
        )
        jsons = [path for path in sorted(folder.glob("*.json")) if _is_export(path)]
        return _export(str(folder), "export", jsons, [part, _leftovers(folder)])
    jsons = _jsons_of_record(folder)
    parts = [_record(record, jsons), _files(folder, record), _leftovers(folder)]
    return _export(str(folder), f"export for {clean_text(record.target)}", jsons, parts)


def _record(record: ExportRecord, jsons: Sequence[Path]) -> VerifiedPart:
    faults = []
    if record.replaced is not None:
        faults.append(
            VerificationFault(
                RECORD,
                "tells of an export that was interrupted while it exchanged files.",
                "Export it again: that replaces the old files and the new ones.",
            )
        )
    if record.target not in list_targets():
        faults.append(
            VerificationFault(
                RECORD, f"names a target that there is not: '{clean_text(record.target)}'.", AGAIN
            )
        )
    names = {document.name for path in jsons if (document := _decoded(path)) is not None}
    if names and record.project not in names:
        faults.append(
            VerificationFault(RECORD, f"is of another project: '{clean_text(record.project)}'.", AGAIN)
        )
    words = f"an export of '{clean_text(record.project)}' that was finished"
    return VerifiedPart("record", "not whole" if faults else words, tuple(faults))


def _files(folder: Path, record: ExportRecord) -> VerifiedPart:
    faults = list(_file_faults(folder, record))
    words = describe_whole(len(record.files), faults, "are as they were written")
    return VerifiedPart("files", words, tuple(faults))


def _file_faults(folder: Path, record: ExportRecord) -> Iterator[VerificationFault]:
    for name, wanted in record.files.items():
        if not _is_own(name, folder):
            yield VerificationFault(
                clean_text(name), "is no file that an export would have written; it was not opened.", AGAIN
            )
            continue
        if not is_file(folder / name):
            yield VerificationFault(clean_text(name), "is missing.", AGAIN)
            continue
        try:
            found = digest(folder / name)
        except Exception as error:  # one bad file never hides the others
            yield make_fault(make_unforeseen_error(folder / name, error), clean_text(name))
            continue
        if found == wanted:
            continue
        if found == (record.replaced or {}).get(name):
            yield VerificationFault(clean_text(name), "is still the one of the export before.", AGAIN)
        else:
            yield VerificationFault(
                clean_text(name),
                "was changed since it was exported: its SHA-256 is another.",
                "Export it again with --overwrite, or leave it if it was changed on purpose.",
            )


def _leftovers(folder: Path) -> VerifiedPart:
    remedy = "Exporting into this folder again removes it; it can be removed by hand as well."
    faults = [
        VerificationFault(path.name, "is a folder that an interrupted export left.", remedy)
        for path in sorted(find_forsaken_staging(folder))
    ]
    faults += find_unfinished_files(folder)
    return VerifiedPart("leftovers", "found" if faults else "none", tuple(faults))


# --- JSON and GLB


def _export(file: str, kind: str, jsons: Sequence[Path], more: Iterable[VerifiedPart] = ()) -> Verified:
    parts: list[VerifiedPart] = []
    for path in jsons:
        found = _pair(path)
        if len(jsons) > 1:
            found = [VerifiedPart(f"{path.name} {p.name}", p.words, p.faults) for p in found]
        parts += found
    return Verified(file, kind, (*parts, *more))


def _pair(path: Path) -> list[VerifiedPart]:
    """Look at an export's JSON, at its GLB, and at the sounds of its lines."""
    document = _decoded(path)
    try:
        project = read_export(path, motions=False)
    except FileError as error:
        parts = [VerifiedPart("JSON", "not whole", (make_fault(error),))]
        glb = path.with_suffix(".glb")
        return [*parts, _readable(glb)] if document is None and is_file(glb) else parts
    assert document is not None
    faults = [
        VerificationFault(path.name, f"{problem.message}.", AGAIN)
        for problem in check_project(project)
        if problem.code in BROKEN
    ]
    faults += _lost_names(path, document)
    words = f"format {document.metagraph}, as the schema has it"
    return [
        VerifiedPart("JSON", "not whole" if faults else words, tuple(faults)),
        *_glb(path, document),
        _sounds(path, document),
    ]


def _lost_names(path: Path, document: c.Export) -> Iterator[VerificationFault]:
    """Find ids in an index, a transition or an expanded machine that nothing has."""
    for layer, graph in document.layers.items():
        ids = {action.id for action in graph.actions}
        named = [(f"layers.{layer}.index", i) for k in graph.index.values() for x in k.values() for i in x]
        named += [(f"layers.{layer}.transitions", i) for t in graph.transitions for i in t.actions]
        machine = (document.expanded or {}).get(layer)
        named += [(f"expanded.{layer}.states", i) for i in machine.states] if machine is not None else []
        for where, ident in named:
            if ident not in ids:
                yield VerificationFault(
                    f"{path.name}, $.{where}", f"names no action: '{clean_text(ident)}'.", AGAIN
                )


def _readable(glb: Path) -> VerifiedPart:
    try:
        takes = read_gltf_clips(glb)
    except FileError as error:
        return VerifiedPart("GLB", "not whole", (make_fault(error),))
    return VerifiedPart(
        "GLB", f"can be read, {count_in_words(len(takes), 'animation')}; nothing to compare it with"
    )


def _glb(path: Path, document: c.Export) -> list[VerifiedPart]:
    glb = path.parent / document.glb
    if (why := explain_refusal(document.glb)) is not None:
        return [
            VerifiedPart(
                "GLB", "not whole", (VerificationFault(document.glb, f"was not opened: {why}.", AGAIN),)
            )
        ]
    if not is_file(glb):
        return [VerifiedPart("GLB", "not whole", (VerificationFault(document.glb, "is missing.", BOTH),))]
    try:
        faults = list(_pair_faults(path, document, glb))
        if document.glb_sha256 is None:
            words = "could not be compared: the export is older than digests"
        else:
            words = "the one that the JSON was written with"
        pair = VerifiedPart("GLB", "not whole" if faults else words, tuple(faults))
        if faults:  # of another GLB nothing needs to fit
            return [pair, VerifiedPart("animations", "not compared, since the GLB is another")]
        faults = list(_content_faults(document, glb))
    except Exception as error:  # whatever a damaged file does to its reader
        return [VerifiedPart("GLB", "not whole", (make_fault(make_unforeseen_error(glb, error)),))]
    animations = count_in_words(len(document.clips), "animation")
    words = f"{animations} and {count_in_words(len(document.joints), 'joint')} are there"
    return [pair, VerifiedPart("animations", "not whole" if faults else words, tuple(faults))]


def _pair_faults(path: Path, document: c.Export, glb: Path) -> Iterator[VerificationFault]:
    size = glb.stat().st_size
    if document.glb_bytes is not None and size != document.glb_bytes:
        yield VerificationFault(
            glb.name, f"has {size:,} bytes; {path.name} was written with {document.glb_bytes:,}.", BOTH
        )
    elif document.glb_sha256 is not None and digest(glb) != document.glb_sha256:
        yield VerificationFault(
            glb.name, f"is not the GLB that {path.name} was written with: its SHA-256 is another.", BOTH
        )


def _content_faults(document: c.Export, glb: Path) -> Iterator[VerificationFault]:
    """Compare the animations and joints of a GLB with those that its JSON names."""
    scene = open_gltf(glb).json
    names = [animation.name for animation in scene.animations]
    for clip in document.clips:
        if clip.animation >= len(names):
            yield VerificationFault(
                glb.name, f"has no animation {clip.animation} ('{clean_text(clip.name)}').", BOTH
            )
        elif names[clip.animation] != clip.name:
            found, wanted = clean_text(names[clip.animation] or ""), clean_text(clip.name)
            words = f"has '{found}' as animation {clip.animation}; the JSON has '{wanted}' there."
            yield VerificationFault(glb.name, words, BOTH)
    nodes = {node.name for node in scene.nodes}
    for joint in document.joints:
        if joint.name not in nodes:
            yield VerificationFault(glb.name, f"has no joint '{clean_text(joint.name)}'.", BOTH)
    read_gltf_clips(glb)  # all of it can be read


def _sounds(path: Path, document: c.Export) -> VerifiedPart:
    names = dict.fromkeys(line.audio for line in document.lines.values() if line.audio)
    faults = []
    for name in names:
        place = path.parent / name
        if (why := explain_refusal(name)) is not None:
            faults.append(VerificationFault(clean_text(name), f"was not opened: {why}.", AGAIN))
        elif not is_file(place):
            faults.append(
                VerificationFault(
                    clean_text(name), "is missing.", "Export it again, and copy the sounds with it."
                )
            )
        else:
            try:
                read_head(place)
            except FileError as error:
                faults.append(make_fault(error, clean_text(name)))
    return VerifiedPart("sounds", describe_whole(len(names), faults, "are there"), tuple(faults))
