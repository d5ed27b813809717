"""Rules of writing for all commands: which options name outputs and which name inputs, `--overwrite`, and
projects that are changed in place.
"""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace, _SubParsersAction
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # reading a command line must not wait for what only writing needs
    from metagraph.formats.outputs import Outputs
    from metagraph.graph.model import Project

# Options that name what is written. All others of type Path are read, unless `WRITTEN` says otherwise.
OUTPUTS = ("out", "output", "into", "bids", "xes", "take", "video")
# Command, action and option of those whose name alone does not tell.
WRITTEN = (("motion-graph", "build", "keep"), ("mimic", None, "save_keypoints"))
# Commands, and actions of some, whose output is a folder, in which nothing but their own files is replaced.
FOLDERS = (
    ("export", None),
    ("demo", None),
    ("reproduce", None),
    ("generate", "evaluate"),
    ("generate", "ablate"),
    ("generate", "cut"),
    ("generate", "planted"),
    ("motion-graph", "build"),
    ("study", "report"),
    ("study", "make"),
    ("study", "simulate"),
)
# Commands that refuse whatever is there, whoever made it.
NEVER = (("generate", "train"), ("generate", "planted"), ("study", "simulate"))
# Commands whose output is a project, which they claim themselves: it may be the one they read.
PROJECTS = ("label", "contacts", "merge")
# Actions that change a study's folder in place, with rules of their own for what is there.
STUDIES = ("run", "pilot", "freeze", "withdraw", "delete", "import", "plan", "collect", "serve")
OVERWRITE = "also replace files that this command did not write, or that someone changed since"


def offer_overwrite(parser: ArgumentParser, command: str) -> None:
    """Give each command that writes a file `--overwrite`, also actions of commands."""
    nested = [a for a in parser._actions if isinstance(a, _SubParsersAction)]
    for action in nested:
        for inner in action.choices.values():
            offer_overwrite(inner, command)
    known = {a.dest for a in parser._actions}
    last = parser.prog.split()[-1]
    name = last if last != command else None
    if (command, name) in NEVER:
        return
    writes = known & {*OUTPUTS} or any((c, a) == (command, name) for c, a, _ in WRITTEN)
    if not nested and writes and "overwrite" not in known:
        parser.add_argument("--overwrite", action="store_true", help=OVERWRITE)


def claim_outputs(options: Namespace) -> Outputs:
    """Return the outputs of a command line, and claim what its options name. Raises FileError."""
    from metagraph.formats.outputs import Outputs, find_data_folder, find_paths

    command, action = options.command, getattr(options, "step", None) or getattr(options, "action", None)
    name = " ".join(filter(None, (command, action)))
    made = Outputs(bool(getattr(options, "overwrite", False)), name)
    written = [*OUTPUTS, *(dest for c, a, dest in WRITTEN if (c, a) == (command, action))]
    out: list[Path] = []
    for option, value in vars(options).items():
        paths = find_paths([value])
        if option in written:
            out += paths
        else:
            made.reads(*paths)
    data = find_data_folder()
    if data is not None:
        made.keeps_up(data)
    if command == "study" and action in STUDIES:
        given = list(find_paths(getattr(options, option, None) for option in ("study", "folder")))
        made.keeps_up(*(p if p.is_dir() else p.parent for p in given))
    if command not in PROJECTS and (command, action) not in NEVER:
        for path in out:
            if path.is_dir() or (command, action) not in FOLDERS:
                made.claim(path)
    return made


class ProjectOutput:
    """A project file that a command makes or changes. No other program may have it open at that time.

    Enter it before the project is read. Raises FileError if a window or another command has it. versions: how
    many earlier ones are kept, as the settings say when None.
    """

    def __init__(self, path: Path, versions: int | None = None) -> None:
        self.path, self.versions = path, versions

    def __enter__(self) -> ProjectOutput:
        from metagraph.formats.locking import Lock, make_owner
        from metagraph.formats.outputs import declare_updates, make_locked_error
        from metagraph.formats.store import compute_file_digest

        self._lock = Lock(self.path, make_owner())
        found = self._lock.acquire()
        if found is not None:
            raise make_locked_error(self.path, found)
        try:
            self._digest = compute_file_digest(self.path)
        except OSError:
            self._digest = None  # whoever reads it says why
        declare_updates(self.path)
        return self

    def __exit__(self, *_: object) -> None:
        self._lock.release()

    def save(self, project: Project, was_at: Path | None = None) -> Project:
        """Write the project, and keep what was there as an earlier version; return it as it was saved. Raises
        FileError. was_at: see `save_project`.
        """
        from app.project.version_count import count_kept_versions
        from metagraph.errors import FileError
        from metagraph.formats.project.paths import move_project
        from metagraph.formats.project.versions import write_project
        from metagraph.formats.store import compute_file_digest, encode_project

        if compute_file_digest(self.path) != self._digest:
            raise FileError(
                self.path,
                "was written by another program while this command worked",
                "",
                "That program's version was kept. Run the command again.",
            )
        if was_at is not None:
            project = move_project(project, was_at, self.path)
        versions = count_kept_versions() if self.versions is None else self.versions
        note = write_project(self.path, encode_project(project, self.path), versions)
        if note is not None:
            print(f"note: {note}", file=sys.stderr)
        self._digest = compute_file_digest(self.path)
        return project


def with_project_ending(path: Path) -> Path:
    """Return a project's path with an ending that projects have."""
    from metagraph.formats.store import SUFFIX

    return path if path.suffix in (".yaml", ".yml") else path.with_name(path.name + SUFFIX)
