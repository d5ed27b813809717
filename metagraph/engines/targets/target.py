"""What every target says of itself and does."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from metagraph.common.wording import Phrase, phrase
from metagraph.engines.export import Chosen, choose_nothing
from metagraph.graph.model import Project
from metagraph.motion.character_mesh import CharacterMesh

Tell = Callable[[int, int, str], None]


@dataclass(frozen=True)
class Loss:
    """Something of a performance that a format cannot say. words: for people; "{n}" stands for what `count`
    finds in a project, and the loss is told only where that is not 0.
    """

    words: str
    count: Callable[[Project], int] | None = None

    def told(self, project: Project) -> str | None:
        """Return the words for a project, None where it loses nothing."""
        number = 1 if self.count is None else self.count(project)
        if not number:
            return None
        template = self.words.template if isinstance(self.words, Phrase) else self.words
        return phrase(template, n=number) if "{n}" in template else self.words


@dataclass(frozen=True)
class Contents:
    """What goes into an export, and how. character: the mesh or its file, None to leave it out. expanded: the
    state machine in the JSON, where there is one. base: the folder the project's own paths are relative to,
    None to leave the lines' sounds where they are. chosen: which sounds outside `base` the user has chosen,
    not only the project; no others are copied. compress: pack the GLB (EXT_meshopt_compression), for targets
    that read it then.
    """

    character: Path | CharacterMesh | None = None
    expanded: bool = False
    base: Path | None = None
    chosen: Chosen = choose_nothing
    compress: bool = False


BARE = Contents()


@dataclass(frozen=True)
class ExportOrder:
    """What is to be written: a sound project into a folder that is there. stem: what its files are called."""

    project: Project
    folder: Path
    stem: str
    contents: Contents = BARE
    tell: Tell = lambda done, total, words: None


@dataclass(frozen=True)
class ExportedFiles:
    """The files of an export, and what else there is to say."""

    files: tuple[Path, ...]
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class ExportTarget:
    """name: on the command line. title: in the window. files: what will be written, in words. write: does it.
    losses: what it loses. untried: why it is experimental; empty where it was run. unpacks: whether
    it reads GLBs that are packed.
    """

    name: str
    title: str
    files: str
    write: Callable[[ExportOrder], ExportedFiles]
    losses: tuple[Loss, ...] = ()
    untried: str = ""
    group: str = phrase("Formats")
    unpacks: bool = False


@dataclass(frozen=True)
class TargetReport:
    """What was written for a target. losses: in words, for this project."""

    target: str
    files: tuple[Path, ...]
    clips: int
    losses: tuple[str, ...] = ()
    warnings: tuple[str, ...] = field(default_factory=tuple)
