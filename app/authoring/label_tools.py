"""Tools that bring clips in and say what they are: import, proposals, labels."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from msgspec import Meta, Struct

from app.authoring.bridging import join_labelled
from app.authoring.finding import find_actions, find_clips
from app.authoring.tool import AuthorError, AuthorTool, EditReport, ToolOutcome, ToolWork, shorten_lines
from app.translation import tr_noop, tr_plural
from metagraph.formats.action_labels import LabelRow, apply_labels
from metagraph.formats.import_words import count_alike
from metagraph.graph import edits
from metagraph.graph.model import Kind, Layer, Limb, Project
from metagraph.suggest.jumps.bridges import describe_bridges, describe_unbridged
from metagraph.suggest.proposal import Proposal, Proposals
from metagraph.suggest.propose import SOURCES, accept, propose

Share = Annotated[float, Meta(ge=0, le=1)]
Source = Literal["name", "motion", "learned"]


class ImportClips(Struct, forbid_unknown_fields=True, omit_defaults=True):
    """paths: files and folders of clips, relative to the project. retarget: bring clips of other skeletons
    onto the project's.
    """

    paths: Annotated[list[str], Meta(min_length=1)]
    retarget: bool = False


def _import_clips(work: ToolWork, given: ImportClips) -> ToolOutcome:
    """Add clips of files and folders."""
    from metagraph.formats.imports import import_files

    paths = [work.find_path(path) for path in given.paths]
    lost = [given.paths[n] for n, path in enumerate(paths) if not path.exists()]
    if lost:
        raise AuthorError(f"there is no file or folder '{lost[0]}'")
    tell = work.watch("reading file")
    result = import_files(work.project, work.folder, paths, tell, retarget="yes" if given.retarget else "no")
    failures = shorten_lines(count_alike(result.failures))
    if not result.loaded:
        why = "; ".join(failures[:3]) or "there are no clips; clips are BVH, GLB, glTF, FBX or VRM animations"
        raise AuthorError(f"nothing was imported: {why}")
    after = result.into(work.project)
    notes = [f"{len(result.loaded)} clips read", *count_alike(result.notes)]
    if result.apart:
        notes.append("clips of other skeletons were left out; call again with `retarget` to bring them over")
    told = EditReport(
        left={f"file {n + 1}": why for n, why in enumerate(failures)}, notes=shorten_lines(notes)
    )
    return ToolOutcome(told, after)


class ProposeLabels(Struct, forbid_unknown_fields=True, omit_defaults=True):
    """clips: by id or name; those without a label if there are none. sources: what may be used: names of
    clips, their motion, labels that are there already.
    """

    clips: list[str] = []
    sources: tuple[Source, ...] = SOURCES


class ProposalRow(Struct, omit_defaults=True):
    """What a clip seems to be. sure: how likely the proposal is right, 0 to 1. reasons: for kind, layer,
    stance and so on. conflicts: where names and motion disagree.
    """

    clip: str
    name: str
    kind: Kind
    layer: Layer
    stance: str
    sure: float
    end_stance: str = ""
    limb: Limb = "both"
    tags: tuple[str, ...] = ()
    reasons: dict[str, str] = {}
    conflicts: tuple[str, ...] = ()


class ProposalList(Struct, omit_defaults=True):
    """The proposals, the least certain first. new_stances: those that the project does not have yet. skipped:
    name -> why a clip is none of the four kinds.
    """

    proposals: list[ProposalRow]
    new_stances: list[str] = []
    skipped: dict[str, str] = {}


def _propose_labels(work: ToolWork, given: ProposeLabels) -> ToolOutcome:
    """Return what clips seem to be; nothing is changed."""
    project, found = work.project, _propose(work, given.clips, given.sources)
    rows = [_make_row(project, found, p) for p in found.doubtful]
    new = [place.name for place in found.places.values() if not place.there]
    skipped = {project.clips[clip].name: str(why) for clip, why in found.aside.items()}
    return ToolOutcome(ProposalList(rows, list(dict.fromkeys(new)), skipped))


class AcceptProposals(Struct, forbid_unknown_fields=True, omit_defaults=True):
    """above: place only clips whose proposal is at least this certain. clips: only these, by id or name; all
    that wait if there are none. sources: as for propose_labels. bridge: blend to stances that no clip leads
    to or from.
    """

    above: Share = 0.0
    clips: list[str] = []
    sources: tuple[Source, ...] = SOURCES
    bridge: bool = True


def _accept_proposals(work: ToolWork, given: AcceptProposals) -> ToolOutcome:
    """Place clips as proposed."""
    project, found = work.project, _propose(work, given.clips, given.sources)
    if not found.proposals:
        raise AuthorError("no clip waits for a label; show_graph shows what there is")
    named = set(find_clips(project, given.clips)) if given.clips else None
    taken = accept(project, found, given.above, named)
    after, bridges = join_labelled(project, taken.project, given.bridge)
    notes = [f"{len(taken.placed)} of {len(found.proposals)} clips placed"]
    notes += [f"blended, because no clip leads there: {line}" for line in describe_bridges(after, bridges)]
    notes += [f"not joined to the other stances: {line}" for line in describe_unbridged(after)]
    for stance, rest in taken.held.items():
        if (made := after.stance(stance)) is not None:
            notes.append(f"'{made.name}' is held in a moment of a clip: {rest.reason}")
    left = {project.clips[clip].name: str(why) for clip, why in {**found.aside, **taken.left}.items()}
    if not taken.placed:
        why = next(iter(left.values()), "")
        raise AuthorError(f"no clip was placed; {why}" if why else "no clip was placed")
    return ToolOutcome(EditReport(left=left, notes=shorten_lines(notes)), after)


class SetLabels(Struct, forbid_unknown_fields=True):
    """labels: one row for each clip, by id or name: its kind, layer and stance, and whatever else is known.
    Stances are named, and made where a layer has none of that name; the first clip of a new stance is its
    loop, of kind stance. A row with `action` changes an action that is there. All rows are applied or none.
    """

    labels: Annotated[list[LabelRow], Meta(min_length=1)]


def _set_labels(work: ToolWork, given: SetLabels) -> ToolOutcome:
    """Place clips as told."""
    project = work.project
    find_clips(project, [row.clip for row in given.labels])
    known = {entry.id: entry.id for entry in project.clips.values()}
    rows = sorted(given.labels, key=lambda row: row.kind != "stance")  # loops first: others wait for them
    after, _, left = apply_labels(project, rows, known)
    if left:
        raise AuthorError(f"{len(left)} of {len(rows)} labels cannot be set: {'; '.join(left[:5])}")
    return ToolOutcome(EditReport(), after, _name_labelling(len(rows)))


class RemoveActions(Struct, forbid_unknown_fields=True):
    """actions: by id or name. Their clips stay in the project."""

    actions: Annotated[list[str], Meta(min_length=1)]


def _remove_actions(work: ToolWork, given: RemoveActions) -> ToolOutcome:
    """Take actions out of the graph."""
    gone = [action.id for action in find_actions(work.project, given.actions)]
    return ToolOutcome(EditReport(), edits.remove_actions(work.project, gone))


def _name_labelling(count: int) -> str:
    return tr_plural("Label {count:,} clip", "Label {count:,} clips", count)


def _propose(work: ToolWork, clips: list[str], sources: tuple[Source, ...]) -> Proposals:
    wanted = find_clips(work.project, clips) if clips else None
    return propose(
        work.project,
        wanted,
        sources=sources or SOURCES,
        progress=work.watch("measuring clip"),
    )


def _make_row(project: Project, found: Proposals, p: Proposal) -> ProposalRow:
    def name(belief: Any) -> str:
        return found.places[belief.value].name if belief is not None else ""

    beliefs: Mapping[str, Any] = {
        "kind": p.kind,
        "layer": p.layer,
        "stance": p.stance,
        "end_stance": p.end_stance if p.kind.value == "transition" else None,
        "limb": p.limb,
        "tags": p.tags,
    }
    return ProposalRow(
        p.clip,
        project.clips[p.clip].name,
        p.kind.value,
        p.layer.value,
        name(p.stance),
        round(p.confidence, 3),
        name(beliefs["end_stance"]),
        p.limb.value,
        p.tags.value if p.tags is not None else (),
        {key: str(belief.reason) for key, belief in beliefs.items() if belief is not None},
        tuple(str(words) for words in p.conflicts),
    )


TOOLS = (
    AuthorTool(
        "import_clips",
        "Add the clips of files and folders to the project.",
        ImportClips,
        EditReport,
        _import_clips,
        "edits",
        tr_noop("Import clips"),
        True,
    ),
    AuthorTool(
        "propose_labels",
        "Say what clips seem to be (kind, layer, stance, tags), how certain that is, and why.",
        ProposeLabels,
        ProposalList,
        _propose_labels,
        long=True,
    ),
    AuthorTool(
        "accept_proposals",
        "Place clips as propose_labels proposes, with their timing, and join stances that no clip leads to.",
        AcceptProposals,
        EditReport,
        _accept_proposals,
        "edits",
        tr_noop("Accept proposals"),
        True,
    ),
    AuthorTool(
        "set_labels",
        "Say what clips are: place each as a stance, gesture, fidget or transition of a layer and stance.",
        SetLabels,
        EditReport,
        _set_labels,
        "edits",
        tr_noop("Label clips"),
    ),
    AuthorTool(
        "remove_actions",
        "Take actions out of the graph; their clips wait for a label again.",
        RemoveActions,
        EditReport,
        _remove_actions,
        "edits",
        tr_noop("Remove actions"),
    ),
)
