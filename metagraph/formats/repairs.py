"""Leaving out, one by one, what readers repair: clips read again with or without a repair, and the edit that
takes them up.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from metagraph.formats.clips import digest, read_clips
from metagraph.formats.project.clip_loading import load_motions
from metagraph.formats.takes import NAME, ONE_FRAME
from metagraph.graph.clip_source import get_source_clip, with_source
from metagraph.graph.edit_error import EditError
from metagraph.graph.edits import add_clips, remove_clips
from metagraph.graph.model import ClipEntry, Project
from metagraph.motion.adopt import SkeletonMismatchError, adopt
from metagraph.motion.clip import Repair
from metagraph.motion.skeleton import Skeleton


@dataclass(frozen=True)
class Repaired:
    """A repair of a clip in the project: `clip` is the entry's id. For a skipped take, that of a clip of its
    file.
    """

    clip: str
    repair: Repair


@dataclass(frozen=True)
class Reread:
    """What came of reading clips again. entries: by id. new: takes brought in. gone: clips of takes that are
    skipped again.

    skeleton: the project's from now on. failures: what could not be done, in words.
    """

    entries: Mapping[str, ClipEntry]
    new: tuple[ClipEntry, ...] = ()
    gone: tuple[str, ...] = ()
    skeleton: Skeleton | None = None
    failures: tuple[str, ...] = ()

    @property
    def count(self) -> int:
        """How many clips change."""
        return len(self.entries) + len(self.new) + len(self.gone)

    def into(self, project: Project) -> Project:
        """The edit. Raises EditError when a clip that would go is placed."""
        for ident in self.gone:
            if ident in project.uses:
                raise EditError(
                    f"'{project.clips[ident].name}' is placed; take it off the graph before it is skipped "
                    "again"
                )
        clips = {i: self.entries.get(i, entry) for i, entry in project.clips.items()}
        project = replace(project, clips=clips, skeleton=self.skeleton or project.skeleton)
        known = {(e.path, e.take) for e in clips.values()}
        fresh = [e for e in self.new if (e.path, e.take) not in known and e.motion is not None]
        project = add_clips(
            project, [(e.path, e.take, e.digest, e.motion) for e in fresh if e.motion is not None]
        )
        kept = {(e.path, e.take): e.as_is for e in fresh}
        clips = {
            i: replace(e, as_is=kept[e.path, e.take]) if (e.path, e.take) in kept else e
            for i, e in project.clips.items()
        }
        return remove_clips(replace(project, clips=clips), self.gone)


def list_repairs(project: Project, clips: Iterable[str]) -> list[Repaired]:
    """Return the repairs of clips, made or left out, each skipped take once."""
    out: list[Repaired] = []
    skipped: set[tuple[str, int]] = set()
    brought = {(e.path, e.take): e.id for e in project.clips.values() if ONE_FRAME in e.as_is}
    for ident in clips:
        entry = project.clips.get(ident)
        for repair in entry.motion.repairs if entry is not None and entry.motion is not None else ():
            assert entry is not None
            if repair.take is None:
                out.append(Repaired(ident, repair))
            elif (entry.path, repair.take) not in skipped:
                skipped.add((entry.path, repair.take))
                out.append(Repaired(ident, replace(repair, made=(entry.path, repair.take) not in brought)))
    return out


def reread(
    project: Project,
    folder: Path | None,
    changes: Collection[tuple[Repaired, bool]],
    progress: Callable[[int, int], None] | None = None,
) -> Reread:
    """Read clips again, each repair of `changes` made (True) or left out (False). Nothing is changed yet.

    folder: what clip paths are relative to, None when they are absolute. Clips that would no longer fit the
    project's skeleton keep the repair, unless all clips of the project change alike: then theirs becomes the
    project's. Raises FileError.
    """
    wanted: dict[str, set[str]] = {}
    brought: list[tuple[str, int]] = []
    gone: list[str] = []
    places = {(e.path, e.take): i for i, e in project.clips.items()}
    for found, made in changes:
        entry, repair = project.clips[found.clip], found.repair
        if repair.take is None:
            names = wanted.setdefault(entry.id, set(entry.as_is))
            (names.discard if made else names.add)(repair.name)
        elif made and (entry.path, repair.take) in places:
            gone.append(places[entry.path, repair.take])
        elif not made:
            brought.append((entry.id, repair.take))
    changed = {
        i: replace(project.clips[i], as_is=tuple(sorted(names)), motion=None) for i, names in wanted.items()
    }
    entries, failures = _loaded(project, changed, folder, progress)
    entries = {i: _named(project.clips[i], e, folder) for i, e in entries.items()}
    fitting, skeleton = _fitting(project, entries, failures)
    return Reread(
        fitting,
        tuple(_brought(project, folder, brought, failures)),
        tuple(gone),
        skeleton,
        tuple(dict.fromkeys(failures)),
    )


def _loaded(
    project: Project,
    entries: Mapping[str, ClipEntry],
    folder: Path | None,
    progress: Callable[[int, int], None] | None = None,
) -> tuple[dict[str, ClipEntry], list[str]]:
    """Return entries with their motion, on the project's skeleton if that can be, and what there is
    to say.
    """
    if not entries:
        return {}, []
    clips = {
        i: e for i, e in project.clips.items() if e.motion is not None and i not in entries
    }  # no missing file is looked for
    opened = load_motions(replace(project, clips={**clips, **entries}), folder, progress)
    found = opened.project.clips
    return {i: found[i] for i in entries if found[i].motion is not None}, list(opened.notes)


def _named(before: ClipEntry, after: ClipEntry, folder: Path | None) -> ClipEntry:
    """Return the entry with the name its file gives it, where that was asked for and nobody has named it
    otherwise.
    """
    if (NAME in before.as_is) == (NAME in after.as_is) or after.motion is None:
        return after
    place = (folder or Path()) / after.path
    old, new = (read_clips(place, e.as_is)[e.take].name for e in (before, after))
    return replace(after, name=new, motion=after.motion.renamed(new)) if before.name == old else after


def _fitting(
    project: Project, entries: Mapping[str, ClipEntry], failures: list[str]
) -> tuple[dict[str, ClipEntry], Skeleton | None]:
    """Return the clips that fit a skeleton, and that skeleton where it is another than before."""
    odd = [e for e in entries.values() if e.motion is not None and e.motion.skeleton != project.skeleton]
    if not odd or odd[0].motion is None:
        return dict(entries), None
    others = [e for i, e in project.clips.items() if i not in entries and e.motion is not None]
    if not others:
        skeleton = odd[0].motion.skeleton
        try:
            return {
                i: with_source(e, adopt(get_source_clip(e) or e.motion, skeleton))
                for i, e in entries.items()
                if e.motion is not None
            }, skeleton
        except SkeletonMismatchError:
            pass
    for entry in odd:
        failures.append(f"'{entry.name}' would no longer fit the project's skeleton, so it stays as it is")
    return {i: e for i, e in entries.items() if e not in odd}, None


def _brought(
    project: Project, folder: Path | None, takes: Iterable[tuple[str, int]], failures: list[str]
) -> list[ClipEntry]:
    """Return entries, without ids, of takes that were skipped."""
    out = []
    for ident, take in takes:
        beside = project.clips[ident]
        place = (folder or Path()) / beside.path
        clips = read_clips(place, (ONE_FRAME,))
        if take >= len(clips):
            failures.append(f"'{beside.path}' no longer has take {take + 1}")
            continue
        clip = clips[take]
        entry = ClipEntry(
            "", clip.name, beside.path, take, digest(place), clip.frames, clip.fps, as_is=(ONE_FRAME,)
        )
        found, notes = _loaded(project, {"": entry}, folder)
        failures.extend(notes)
        motion = found[""].motion if found else None
        if motion is not None and motion.skeleton == project.skeleton:
            out.append(found[""])
        else:
            failures.append(f"'{clip.name}' has another skeleton than the project, so it stays out")
    return out
