"""Define what every export target says about itself and does."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from metagraph.common.wording import Phrase, phrase, plural_phrase
from metagraph.engines.export import Chosen, choose_nothing
from metagraph.graph.model import Project
from metagraph.motion.character_mesh import CharacterMesh

Tell = Callable[[int, int, str], None]


@dataclass(frozen=True)
class Loss:
    """Something in a performance that a format cannot express.

    `words` are for people. Where `count` is given, they are a plural phrase of the number that it finds in a
    project; the loss is reported only if that is not 0.
    """

    words: str
    count: Callable[[Project], int] | None = None

    def told(self, project: Project) -> str | None:
        """Return the words for a project, None if it loses nothing."""
        number = 1 if self.count is None else self.count(project)
        if not number:
            return None
        if isinstance(self.words, Phrase) and self.words.plural:
            return plural_phrase(self.words.template, self.words.plural, number)
        return self.words


@dataclass(frozen=True)
class Contents:
    """What goes into an export, and how.

    `character` is the mesh or its file, None to leave it out. `expanded` puts the state machine into the
    JSON, if there is one. `base` is the folder that the project's own paths are relative to, None to leave
    the lines' sounds where they are. `chosen` returns which sounds outside `base` the user, not only the
    project, has chosen; no others are copied. `compress` packs the GLB (EXT_meshopt_compression), for targets
    that can read it. `pretty` breaks and indents the JSON, for people; it is more than twice as large.
    """

    character: Path | CharacterMesh | None = None
    expanded: bool = False
    base: Path | None = None
    chosen: Chosen = choose_nothing
    compress: bool = False
    pretty: bool = False


BARE = Contents()


@dataclass(frozen=True)
class ExportOrder:
    """What is to be written: a project without errors, into an existing folder. `stem` is that of its files'
    names.
    """

    project: Project
    folder: Path
    stem: str
    contents: Contents = BARE
    tell: Tell = lambda done, total, words: None


@dataclass(frozen=True)
class ExportedFiles:
    """The files of an export, and notes about them."""

    files: tuple[Path, ...]
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class ExportTarget:
    """A target of exports.

    `name` is used on the command line, `title` in the window. `files` says in words what will be written,
    `write` writes it. `losses` are what it cannot express. `untried` says why it is experimental; it is empty
    if it was run. `unpacks` says whether it reads packed GLBs, `packs` whether they are packed unless the
    user chooses otherwise.
    """

    name: str
    title: str
    files: str
    write: Callable[[ExportOrder], ExportedFiles]
    losses: tuple[Loss, ...] = ()
    untried: str = ""
    group: str = phrase("Formats")
    unpacks: bool = False
    packs: bool = False


@dataclass(frozen=True)
class TargetReport:
    """What was written for a target. `losses` are in words, for this project; `steps` are what to do next."""

    target: str
    files: tuple[Path, ...]
    clips: int
    losses: tuple[str, ...] = ()
    warnings: tuple[str, ...] = field(default_factory=tuple)
    steps: tuple[str, ...] = ()
