"""Import into a project: files and folders become clips on the project's skeleton; a bad file fails alone."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from metagraph.common.files import make_unforeseen_error
from metagraph.common.wording import phrase, plural_phrase
from metagraph.errors import FileError, describe_error
from metagraph.formats.clips import digest, find_clip_files, import_clips, read_clips
from metagraph.formats.project.paths import make_path_for_project, make_path_relative
from metagraph.graph.editing.retargeting import Bringing
from metagraph.graph.edits import add_clips
from metagraph.graph.face.curves import describe_unused_curves
from metagraph.graph.face.takes import is_face_take, put_on_body
from metagraph.graph.model import Project
from metagraph.motion.adopt import SkeletonMismatchError, adopt, describe_difference, measure_bone_difference
from metagraph.motion.clip import Clip, ClipError
from metagraph.motion.joint_map import JointMap, RetargetError, make_fingerprint
from metagraph.motion.roles import find_roles, is_humanoid, is_mirrored
from metagraph.motion.skeleton import Skeleton

if TYPE_CHECKING:
    from metagraph.formats.characters import CharacterFile

Loaded = tuple[str, int, str, Clip]  # path as the project keeps it, take, digest, clip
Maps = Callable[
    [str, str], JointMap | None
]  # fingerprints of a source and a target skeleton -> the map kept for them
_ALONE = phrase("Import it into a separate project.")
_MIRRORED = phrase(
    "the figure's left joints are on its right side, so that its feet point backwards. Export it again "
    "without mirroring it, or swap left and right in the names of its joints."
)
_A_POSE = 0.1  # seconds up to which a clip is a pose, not a movement
_LONGER = 0.025  # share by which bones may differ from the project's without a word
PERSON = (
    2  # times as much a clip of a person counts as one of another creature, for the skeleton of a project
)


@dataclass(frozen=True)
class Strangers:
    """Clips of one other skeleton, which can be retargeted.

    `clips` are on their own skeleton. `why` says in words how it differs. `joint_map` is proposed, or was
    made by the user for the same two skeletons before (`remembered`). `told` has the failures with which they
    were left out.
    """

    clips: tuple[Loaded, ...]
    why: str
    joint_map: JointMap
    remembered: bool = False
    told: tuple[str, ...] = ()

    @property
    def skeleton(self) -> Skeleton:
        return self.clips[0][3].skeleton

    @property
    def fingerprint(self) -> str:
        return make_fingerprint(self.skeleton)

    @property
    def failures(self) -> tuple[str, ...]:
        """Return why they are left out, one text for each file."""
        files: dict[str, int] = {}
        for path, *_ in self.clips:
            files[path] = files.get(path, 0) + 1
        remedy = (
            _ALONE
            if self.joint_map.missing
            else phrase("Retarget it (import it with --retarget), or import it into a separate project.")
        )
        why = self.why
        return tuple(
            plural_phrase(
                "{file}: {count:,} clip belongs to another character: {why}. {remedy}",
                "{file}: {count:,} clips belong to another character: {why}. {remedy}",
                count,
                file=Path(path).name,
                why=why,
                remedy=remedy,
            )
            for path, count in files.items()
        )


@dataclass(frozen=True)
class Imported:
    """The result of an import.

    `loaded` is what `add_clips` takes. `failures` say in words why files were left out. `notes` say what
    readers changed. `character` is the first of the files that also holds a character, for a project that
    draws none yet; if there is none, `stand_ins` are the files whose mesh only stands in for one. `chosen`:
    it was given by itself, so that it takes the place of the project's character. `strangers` are clips of
    other skeletons that wait to be retargeted. `joint_maps` are those by which clips were retargeted, to be
    kept in the project, and `retargeted` is the number of these clips. `apart` are clips of other skeletons
    that were left out, by the user or with a reason among the failures.
    """

    loaded: tuple[Loaded, ...]
    failures: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    cancelled: bool = False
    character: CharacterFile | None = None
    stand_ins: tuple[CharacterFile, ...] = ()
    strangers: tuple[Strangers, ...] = ()
    joint_maps: Mapping[str, JointMap] = field(default_factory=dict)
    retargeted: int = 0
    apart: tuple[Strangers, ...] = ()
    chosen: bool = False

    def into(self, project: Project) -> Project:
        """Edit `project`: add the clips and, if it has no character, the one that came with them."""
        project = add_clips(project, self.loaded)
        if any(project.joint_maps.get(key) != value for key, value in self.joint_maps.items()):
            project = replace(project, joint_maps={**project.joint_maps, **self.joint_maps})
        if self.character is None or (project.character is not None and not self.chosen):
            return project
        return self.character.into(project)


def gather(paths: Iterable[str | Path]) -> list[Path]:
    """Return the clip files among files and folders, each once. Folders are searched with all subfolders."""
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
    retarget: Literal["no", "ask", "yes"] = "no",
    remembered: Maps | None = None,
    contacts: bool = True,
) -> Imported:
    """Read files and folders for a project; nothing is changed yet.

    Paths are made relative to `folder`, or absolute if it is None. The project's skeleton decides what fits;
    in an empty project, the skeleton on which most of the clips can play. A clip of another skeleton is
    retargeted if the project has a joint map for it. Otherwise `retarget` decides: it is left out with its
    reason ("no"), returned among the `strangers` ("ask"), or retargeted by the remembered or proposed map
    ("yes"). `remembered` finds the user's maps from other projects. `contacts` says whether retargeted hands
    touch their own body where they did, for skeletons that the project has no joint map for yet.
    """
    files = gather(paths)
    report = import_clips(files, progress, cancelled)
    failures: list[str] = [error.words for error in report.failures]
    bodies = [clip for _, _, clip in report.clips if not is_face_take(clip)]
    skeleton = project.skeleton or _skeleton_of_most(bodies)
    faces: list[Loaded] = []
    lost: list[tuple[Path, int, Clip]] = []  # with notes on what their skeletons have and the project's not
    loaded: list[Loaded] = []
    foreign: dict[str, list[Loaded]] = {}
    reasons: dict[str, str] = {}
    digests: dict[Path, str] = {}
    apart: dict[str, tuple[float, list[str]]] = {}  # by skeleton
    for path, take, clip in _as_known(report.clips, project, folder):
        try:
            if path not in digests:
                digests[path] = digest(path)
            name = make_path_for_project(path, folder)
        except FileError as error:
            failures.append(error.words)
            continue
        if is_face_take(clip):
            faces.append((name, take, digests[path], clip))
            continue
        assert skeleton is not None
        try:
            own = adopt(clip, skeleton)
            loaded.append((name, take, digests[path], own))
            lost.append((path, take, replace(own, notes=own.notes[len(clip.notes) :])))
            key = clip.skeleton.fingerprint
            if key not in apart:
                apart[key] = (measure_bone_difference(clip.skeleton, skeleton), [])
            apart[key][1].append(clip.name)
        except SkeletonMismatchError as error:
            key = make_fingerprint(clip.skeleton)
            foreign.setdefault(key, []).append((name, take, digests[path], clip))
            reasons.setdefault(key, describe_error(error))
    for name, take, content, clip in faces:
        try:
            loaded.append((name, take, content, put_on_body(add_clips(project, loaded), clip)))
        except RetargetError as error:
            failures.append(phrase("{file}: {why}", file=Path(name).name, why=describe_error(error)))
    still = {_name(e.path, folder): e.words for e in report.failures}
    alone = len(files) == 1 and not report.clips
    character: CharacterFile | None = None
    stand_ins: tuple[CharacterFile, ...] = ()
    if skeleton is not None and (alone or project.character is None):
        character, stand_ins = _find_character([name for name, *_ in loaded], still, folder, skeleton, alone)
    if character is not None and character.path in still:  # it is useful without a motion
        failures.remove(still[character.path])
    notes = (*_together(report.clips), *_together(lost), *_other_bones(list(apart.values())))
    if skeleton is not None and skeleton is not project.skeleton and is_mirrored(skeleton):
        notes = (*notes, _MIRRORED)
    if character is not None:
        notes = (*notes, *character.notes)
    result = Imported(
        tuple(loaded),
        tuple(failures),
        notes,
        report.cancelled,
        character,
        stand_ins,
        chosen=alone and character is not None,
    )
    if foreign:
        bringing = Bringing(add_clips(project, loaded))
        for key, clips in foreign.items():
            result = _with_strangers(
                result,
                bringing,
                Strangers(tuple(clips), reasons[key], *_map(bringing, clips, remembered, contacts)),
                retarget,
            )
    curves = describe_unused_curves(result.into(project), [clip for *_, clip in result.loaded])
    return replace(result, failures=tuple(dict.fromkeys(result.failures)), notes=(*result.notes, *curves))


def _map(
    bringing: Bringing, clips: Sequence[Loaded], remembered: Maps | None, contacts: bool
) -> tuple[JointMap, bool]:
    """Return the joint map that is offered for clips of one skeleton, and whether it was made before."""
    source = clips[0][3].skeleton
    assert bringing.project.skeleton is not None
    found = (
        remembered(make_fingerprint(source), make_fingerprint(bringing.project.skeleton))
        if remembered is not None
        else None
    )
    joint_map = bringing.propose(source) if found is None else found
    return joint_map if contacts else replace(joint_map, contacts=False), found is not None


BY_KNOWN_MAP = phrase("{whose}: retargeted with the joint map of the project")  # a note's template


def _with_strangers(result: Imported, bringing: Bringing, strangers: Strangers, retarget: str) -> Imported:
    known = bringing.project.joint_maps.get(strangers.fingerprint)
    if known is not None or (retarget == "yes" and not strangers.joint_map.missing):
        brought = bring_over(bringing, strangers, known or strangers.joint_map)
        count, first = len(strangers.clips), Path(strangers.clips[0][0]).name
        whose = phrase("{count} clips ({first} …)", count=count, first=first) if count > 1 else first
        note = (
            phrase(BY_KNOWN_MAP, whose=whose)
            if known is not None
            else phrase(
                "{whose}: retargeted from a skeleton of {joints} joints",
                whose=whose,
                joints=len(strangers.skeleton),
            )
        )
        return replace(
            result,
            loaded=(*result.loaded, *brought.loaded),
            failures=(*result.failures, *brought.failures),
            notes=(*result.notes, note) if brought.loaded else result.notes,
            joint_maps={**result.joint_maps, **brought.joint_maps},
            retargeted=result.retargeted + brought.retargeted,
        )
    if retarget == "ask":
        return replace(result, strangers=(*result.strangers, strangers))
    failures = strangers.failures
    if retarget == "yes":
        failures = tuple(
            phrase(
                "{file}It cannot be retargeted: {missing}. {remedy}",
                file=text[: text.index(_ALONE)],
                missing=strangers.joint_map.missing[0],
                remedy=_ALONE,
            )
            for text in failures
        )
    return replace(
        result,
        failures=(*result.failures, *failures),
        apart=(*result.apart, replace(strangers, told=failures)),
    )


def bring_over(
    bringing: Bringing,
    strangers: Strangers,
    joint_map: JointMap,
    progress: Callable[[int, int], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Imported:
    """Retarget clips of another skeleton by a joint map. One that cannot be retargeted fails alone."""
    loaded: list[Loaded] = []
    failures: list[str] = []
    stopped = False
    for n, (path, take, content, clip) in enumerate(strangers.clips):
        stopped = cancelled is not None and cancelled()
        if stopped:
            break
        if progress is not None:
            progress(n, len(strangers.clips))
        try:
            loaded.append((path, take, content, bringing.bring(clip, joint_map)))
        except (RetargetError, ClipError) as error:
            why = describe_error(error)
            failures.append(phrase("{file}: {why}. {remedy}", file=Path(path).name, why=why, remedy=_ALONE))
        except Exception as error:  # one bad clip never spoils the others
            failures.append(make_unforeseen_error(path, error).words)
    maps = {strangers.fingerprint: joint_map} if loaded else {}
    return Imported(
        tuple(loaded), tuple(failures), cancelled=stopped, joint_maps=maps, retargeted=len(loaded)
    )


def find_strangers(project: Project, folder: Path | None, clips: Iterable[str] = ()) -> tuple[Strangers, ...]:
    """Return the project's retargeted clips as they are in their files, by skeleton, with the joint maps they
    were retargeted by.

    `clips` limits this to the skeletons of these clips; without it, all are returned. Clips that cannot be
    read, or that have the project's skeleton by now, are left out.
    """
    chosen = {project.clips[i].brought_from for i in clips if i in project.clips}
    groups: dict[str, list[Loaded]] = {}
    for entry in project.clips.values():
        if entry.brought_from in project.joint_maps and (not chosen - {""} or entry.brought_from in chosen):
            try:
                takes = read_clips((folder or Path()) / entry.path, entry.as_is)
            except FileError:
                continue  # a missing or broken file is reported elsewhere
            if entry.take < len(takes) and make_fingerprint(takes[entry.take].skeleton) == entry.brought_from:
                found = takes[entry.take].renamed(entry.name)
                groups.setdefault(entry.brought_from, []).append(
                    (entry.path, entry.take, entry.digest, found)
                )
    return tuple(Strangers(tuple(g), "", project.joint_maps[key], True) for key, g in groups.items())


def _name(path: Path, folder: Path | None) -> str:
    return make_path_relative(path, folder) if folder is not None else path.as_posix()


def _as_known(
    clips: Sequence[tuple[Path, int, Clip]], project: Project, folder: Path | None
) -> list[tuple[Path, int, Clip]]:
    """Return the clips; those for which the project left out a repair are read again in that way."""
    kept: dict[str, dict[int, tuple[str, ...]]] = {}
    for entry in project.clips.values():
        if entry.as_is:
            kept.setdefault(entry.path, {})[entry.take] = entry.as_is
    if not kept:
        return list(clips)
    out = {(path, take): clip for path, take, clip in clips}
    for path in dict.fromkeys(path for path, _, _ in clips):
        takes: dict[tuple[str, ...], list[Clip]] = {}
        for take, as_is in kept.get(_name(path, folder), {}).items():
            try:
                if as_is not in takes:
                    takes[as_is] = read_clips(path, as_is)
            except FileError:
                break  # the file is being written again; keep what was read before
            if take < len(takes[as_is]):
                out[path, take] = takes[as_is][take]
    return [(path, take, clip) for (path, take), clip in out.items()]


def _find_character(
    clips: Sequence[str], still: Iterable[str], folder: Path | None, skeleton: Skeleton, alone: bool
) -> tuple[CharacterFile | None, tuple[CharacterFile, ...]]:
    """Return the character among the files of an import, and stand-ins if there is none. still: files without
    motion. alone: whether a single such file was given, which may then have other joints.
    """
    from metagraph.formats.characters import find_character_among, find_fitting_character

    character, stand_ins = find_character_among(clips, still, folder, skeleton)
    if character is None and alone:
        character = find_fitting_character(next(iter(still), ""), folder, skeleton)
    return character, () if character is not None else stand_ins


def _together(clips: Iterable[tuple[Path, int, Clip]]) -> tuple[str, ...]:
    """Return the notes of readers, each in one line for all files that have it."""
    files: dict[str, dict[str, None]] = {}
    for path, _, clip in clips:
        for note in clip.notes:
            files.setdefault(note, {})[path.name] = None
    out = []
    for note, names in files.items():
        first = next(iter(names))
        if len(names) == 1:
            out.append(phrase("{file}: {note}", file=first, note=note))
        else:
            out.append(phrase("{count} files ({first} …): {note}", count=len(names), first=first, note=note))
    return tuple(out)


def _other_bones(groups: Sequence[tuple[float, list[str]]]) -> tuple[str, ...]:
    """Return one note on clips whose bones are not as long as the project's."""
    odd = [(share, names) for share, names in groups if share > _LONGER]
    names = [name for _, some in odd for name in some]
    if not names:
        return ()
    most = 100 * max(share for share, _ in odd)
    if len(names) == 1:
        return (
            phrase(
                "'{name}' keeps its bones, which are up to {most:.0f} % longer or shorter than those of the "
                "project's character. Retarget it if hands or feet miss their places.",
                name=names[0],
                most=most,
            ),
        )
    return (
        phrase(
            "{count} clips ('{name}' …) keep their bones, which are up to {most:.0f} % longer or shorter "
            "than those of the project's character. Retarget them if hands or feet miss their places.",
            count=len(names),
            name=names[0],
            most=most,
        ),
    )


def _skeleton_of_most(clips: Sequence[Clip]) -> Skeleton | None:
    """Return the skeleton that most clips can play on, poses aside; of equal ones, the one with most joints,
    then the first. A person's goes before an animal's that no more than twice as many clips can play on.
    """
    best: tuple[int, int, int] = (0, 0, 0)
    found = None
    groups = _of_one_character(clips)
    for group in groups:
        skeleton = group[0].skeleton
        able = [
            clip
            for g in groups
            if g is group or describe_difference(g[0].skeleton, skeleton) is None
            for clip in g
        ]
        person = PERSON if len(groups) > 1 and is_humanoid(find_roles(skeleton)) else 1
        moving = sum(clip.duration > _A_POSE for clip in able)
        rank = person * moving, person * len(able), len(skeleton)
        if rank > best:
            best, found = rank, skeleton
    return found


def _of_one_character(clips: Sequence[Clip]) -> list[list[Clip]]:
    """Return the clips in groups: those whose joints have the same names and differ in no more than the
    lengths of bones.
    """
    groups: dict[tuple[str, ...], list[list[Clip]]] = {}
    known: dict[str, list[Clip]] = {}
    for clip in clips:
        key = clip.skeleton.fingerprint
        if key not in known:
            alike = groups.setdefault(clip.skeleton.names, [])
            known[key] = next(
                (g for g in alike if describe_difference(clip.skeleton, g[0].skeleton) is None), []
            )
            if not known[key]:
                alike.append(known[key])
        known[key].append(clip)
    return [group for alike in groups.values() for group in alike]
