"""Importing into a project: files and folders in, clips on the project's skeleton out, one bad file failing alone."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from metagraph.errors import FileError
from metagraph.formats.clips import digest, find_clip_files, import_clips
from metagraph.formats.gltf import has_skinned_mesh, morph_targets
from metagraph.formats.store import relative
from metagraph.graph.edits import add_clips, set_character
from metagraph.graph.face import with_morphs
from metagraph.graph.model import Project
from metagraph.motion.adopt import SkeletonMismatchError, adopt, difference
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton


@dataclass(frozen=True)
class Imported:
    """loaded: what `add_clips` takes. failures: why files were left out, in words. notes: what readers changed.

    character: the first of the files that also holds a mesh, written as clip paths are, for a project that draws none yet.
    morphs: its morph targets.
    """

    loaded: tuple[tuple[str, int, str, Clip], ...]
    failures: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    cancelled: bool = False
    character: str | None = None
    morphs: tuple[str, ...] = ()

    def into(self, project: Project) -> Project:
        """The edit: `project` with the clips added, and with the character that came with them if it had none."""
        project = add_clips(project, self.loaded)
        if project.character is not None or not self.character:
            return project
        return with_morphs(set_character(project, self.character), self.morphs)


def gather(paths: Iterable[str | Path]) -> list[Path]:
    """Return the clip files among files and folders, folders searched to the bottom, each file once."""
    out: dict[Path, None] = {}
    for path in map(Path, paths):
        found = find_clip_files(path) if path.is_dir() else [path]
        out.update(dict.fromkeys(p.parent.resolve() / p.name for p in found))
    return list(out)


def import_files(
    project: Project,
    folder: Path | None,
    paths: Iterable[str | Path],
    progress: Callable[[int, int, Path], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Imported:
    """Read files and folders for a project; nothing is changed yet.

    folder: what paths are made relative to, None for absolute ones. The project's skeleton decides what fits; in an
    empty project the skeleton on which most of the clips can play does. A clip of another character is left out, with its reason.
    """
    report = import_clips(gather(paths), progress, cancelled)
    failures = [str(error) for error in report.failures]
    skeleton = project.skeleton or _skeleton_of_most([clip for _, _, clip in report.clips])
    loaded: list[tuple[str, int, str, Clip]] = []
    refused: dict[tuple[Path, str], int] = {}
    digests: dict[Path, str] = {}
    for path, take, clip in report.clips:
        assert skeleton is not None
        try:
            fitted = adopt(clip, skeleton)
            if path not in digests:
                str(path).encode()  # a name in no known encoding could not be written down
                digests[path] = digest(path)
        except SkeletonMismatchError as error:
            refused[(path, str(error))] = refused.get((path, str(error)), 0) + 1
            continue
        except FileError as error:
            failures.append(str(error))
            continue
        except UnicodeEncodeError:
            failures.append(str(FileError(path, "has a name that is no text", "its name", "Rename it.")))
            continue
        name = relative(path, folder) if folder is not None else path.as_posix()
        loaded.append((name, take, digests[path], fitted))
    for (path, why), count in refused.items():
        clips = f"{count} clips are" if count > 1 else "its clip is"
        failures.append(f"{path.name}: {clips} of another character: {why}. Import it into a project of its own.")
    character = _character(loaded, folder) if project.character is None else None
    morphs = _morphs(character, folder)
    return Imported(tuple(loaded), tuple(dict.fromkeys(failures)), _together(report.clips), report.cancelled, character, morphs)


def _together(clips: Iterable[tuple[Path, int, Clip]]) -> tuple[str, ...]:
    """Return what readers noted, in one line for all files of which it is true."""
    files: dict[str, dict[str, None]] = {}
    for path, _, clip in clips:
        for note in clip.notes:
            files.setdefault(note, {})[path.name] = None
    out = []
    for note, names in files.items():
        first = next(iter(names))
        out.append(f"{first if len(names) == 1 else f'{len(names)} files ({first} ...)'}: {note}")
    return tuple(out)


def _character(loaded: Sequence[tuple[str, int, str, Clip]], folder: Path | None) -> str | None:
    """Return the first imported file that holds a skinned mesh."""
    for name in dict.fromkeys(name for name, _, _, _ in loaded):
        path = (folder or Path()) / name
        if path.suffix.lower() in (".glb", ".gltf", ".vrm"):
            try:
                if has_skinned_mesh(path):
                    return name
            except FileError:
                continue  # its clips were read; what is wrong with its meshes the preview says if it is chosen
    return None


def _morphs(character: str | None, folder: Path | None) -> tuple[str, ...]:
    return morph_targets((folder or Path()) / character) if character is not None else ()


def _skeleton_of_most(clips: Sequence[Clip]) -> Skeleton | None:
    """Return the skeleton that most clips can play on; of equal ones the one with most joints, then the first."""
    groups: dict[tuple[str, ...], list[Clip]] = {}  # files of one character seldom differ in more than bone lengths
    for clip in clips:
        groups.setdefault(clip.skeleton.names, []).append(clip)
    best: tuple[int, int] = (0, 0)
    found = None
    for group in groups.values():
        skeleton = group[0].skeleton
        fitting = sum(len(g) for g in groups.values() if g is group or difference(g[0].skeleton, skeleton) is None)
        if (fitting, len(skeleton)) > best:
            best, found = (fitting, len(skeleton)), skeleton
    return found
