"""Sittings killed at any moment, again and again: python tests/reliability/kills.py [--count 1000] [--seed 1]

Each round is a process of its own that opens what the rounds before have left, takes over what a crash left
to recover, then edits, saves, exports, imports and starts new projects until it is killed. It says what it
has finished; what is read back afterwards must hold it. Exit code 1 and the round's folder when it does not.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import shutil
import signal
import sys
import tempfile
import time
from collections import Counter
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from app.project.document import Document, ProjectPast, state_folder  # noqa: E402
from app.project.leftovers import list_untitled_journals, look_beside, read_untitled, remove_journal  # noqa: E402
from app.project.opening import load_recovered, open_whole  # noqa: E402
from app.project.unsaved import count_lost_steps  # noqa: E402
from metagraph.engines.export import export_project  # noqa: E402
from metagraph.engines.reading import read_export  # noqa: E402
from metagraph.formats.atomic import sweep  # noqa: E402
from metagraph.formats.bvh.file import write_bvh  # noqa: E402
from metagraph.formats.imports import import_files  # noqa: E402
from metagraph.formats.recovery import Left, find_left_journals, read_journal  # noqa: E402
from metagraph.formats.store import SUFFIX, open_project, read_project, save_project  # noqa: E402
from metagraph.graph import edits  # noqa: E402
from metagraph.graph.model import Project  # noqa: E402
from tests.conftest import Toy  # noqa: E402

CHAIN = 20  # rounds that go on with what the ones before have left
LONGEST = 0.25  # seconds after which a process is killed, at most
PATIENCE = 60.0  # seconds for a process to say its first word


def begin(folder: Path) -> None:
    """Lay down a project with a few clips, and more to be imported."""
    toy = Toy()
    for name, seconds in (("rest loop", 0.5), ("rest beat", 0.3), ("rest nod", 0.3)):
        write_bvh(toy.clip(name, seconds), folder / f"{name}.bvh")
    for number in range(2):
        write_bvh(toy.clip(f"more {number}", 0.3), folder / "more" / f"more {number}.bvh")
    project = import_files(Project("show"), folder, sorted(folder.glob("*.bvh"))).into(Project("show"))
    loop, *others = sorted(project.clips, key=lambda i: "loop" not in project.clips[i].name)
    project = edits.add_stance(project, "arms", "rest", [loop])
    stance = next(iter(project.graphs["arms"].stances))
    project = edits.place_clips(project, others, "arms", "gesture", stance)
    save_project(project, folder / f"show{SUFFIX}")


# --- the process that is killed


def say(*words: object) -> None:
    os.write(1, f"{' '.join(map(str, words))}\n".encode())


class Sitting:
    """One sitting, as a window has it. Its edits count up; the count is the project's seed."""

    def __init__(self, folder: Path, named: bool, chance: random.Random) -> None:
        self.folder, self.chance = folder, chance
        self.path = folder / f"show{SUFFIX}" if named else None
        self.document = Document()

    def open(self) -> None:
        """Take over the latest of what crashes have left; the others are declined once that is safe."""
        say("act", "open")
        if self.path is not None:
            found = look_beside(self.path, self.document.owner)
            lock = found.lock
        else:
            found, lock = read_untitled(list_untitled_journals()), None
        chosen = max(found.left, key=number_of, default=None)
        say("act", "recover" if chosen is not None else "open")
        if chosen is not None:
            opened, steps = load_recovered(chosen, self.folder)
            common = read_project(self.path) if self.path is not None else None
            digest = chosen.digest if self.path is not None else None
            past = ProjectPast(steps=steps, lost=count_lost_steps(chosen, steps), common=common)
            self.document.load(opened.project, self.path, past, digest=digest, lock=lock)
            if self.document.secured():
                for left in found.left:
                    remove_journal(left.path)
        elif self.path is not None:
            whole = open_whole(self.path)
            self.document.load(whole.project, self.path, digest=whole.digest, lock=lock)
        else:
            self.document.load(Project("new"), None)
        say("at", self.document.project.settings.seed)

    def edit(self) -> None:
        number = self.document.project.settings.seed + 1
        self.document.edit("Edit", lambda p: edits.set_settings(p, seed=number))
        say("at", number)

    def there_and_back(self) -> None:
        number = self.document.project.settings.seed
        if self.document.undo_stack.canUndo():
            say("at", number - 1)  # undone is finished, too
            self.document.undo()
            self.document.redo()
            say("at", number)

    def save(self) -> None:
        if self.path is not None:
            self.document.save()
            say("saved", self.document.project.settings.seed)

    def export(self) -> None:
        if self.path is not None:
            export_project(self.document.project, self.folder / "export", mesh=False)
            say("exported")

    def bring(self) -> None:
        found = import_files(self.document.project, self.document.folder, [self.folder / "more"])
        self.document.edit("Import", found.into)

    def act(self) -> None:
        names = ["edit"] * 12 + ["there_and_back"] * 3 + ["save"] * 5 + ["export", "bring"]
        name = self.chance.choice(names)
        say("act", name)
        getattr(self, name)()
        self.edit()


def number_of(left: Left) -> int:
    return left.project.settings.seed


# --- whoever kills and looks


@dataclass
class Told:
    """What a process had said when it was killed. at: the last edit that was finished."""

    at: int = 0
    saved: int = 0
    exported: bool = False
    act: str = "start"
    error: str = ""


def round_of(folder: Path, named: bool, seed: int, seconds: float, opened: bool) -> Told:
    """Start a process, kill it some seconds after its first word, or after it has opened the project; return
    what it said.
    """
    reader, writer = os.pipe()
    child = os.fork()
    if not child:
        code = 1
        try:
            os.close(reader)
            os.dup2(writer, 1)
            sitting = Sitting(folder, named, random.Random(seed))
            sitting.open()
            while True:
                sitting.act()
        except BaseException as error:
            import traceback

            say("error", json.dumps(f"{error!r} {traceback.format_exc()}"))
        finally:
            os._exit(code)
    os.close(writer)
    try:
        with os.fdopen(reader, "rb") as pipe:
            first = pipe.readline()
            while opened and b"\nat " not in b"\n" + first:
                line = pipe.readline()
                first += line
                if not line:
                    break  # it has ended
            time.sleep(seconds)
            os.kill(child, signal.SIGKILL)
            words = first + pipe.read()
    finally:
        with suppress(ProcessLookupError):
            os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
    told = Told()
    for line in words.decode().split("\n")[:-1]:
        word, _, rest = line.partition(" ")
        if word in ("at", "saved"):
            setattr(told, word, int(rest))
        elif word == "exported":
            told.exported = True
        elif word == "act":
            told.act = rest
        else:
            told.error = line
    return told


@dataclass
class Count:
    """What came of all rounds. acts: in what they were killed. wrong: what was lost, in words."""

    rounds: int = 0
    recovered: int = 0
    swept: int = 0
    finished: int = 0
    acts: Counter[str] = field(default_factory=Counter)
    wrong: list[str] = field(default_factory=list)


def look(folder: Path, named: bool, told: Told, before: int, count: Count) -> int:
    """Read back what a killed process has left; return the edit it is at."""
    if told.error:
        count.wrong.append(told.error)
    on_disk, left = 0, []
    if named:
        path = folder / f"show{SUFFIX}"
        on_disk = open_project(path).project.settings.seed
        left = [read_journal(journal, path) for journal in find_left_journals(path)]
    else:
        left = [read_journal(journal, None) for journal in list_untitled_journals()]
    numbers = [number_of(x) for x in left if x is not None]
    latest = max([on_disk, *numbers, 0])
    wanted = max(told.at, before if told.act not in ("start", "open") else 0)
    if latest < wanted:
        count.wrong.append(f"edit {wanted} was finished, {latest} is left, killed in {told.act}")
    if on_disk < told.saved:
        count.wrong.append(f"edit {told.saved} was saved, the file holds {on_disk}")
    if told.exported:
        read_export(next((folder / "export").glob("*.json")))
    for place in (folder, folder / "export", state_folder()):
        count.swept += len(sweep(place))
        rest = list(place.glob(".saving-*")) if place.is_dir() else []
        if rest:
            count.wrong.append(f"{len(rest)} unfinished files stay in {place.name}")
    count.recovered += bool(numbers)
    count.finished += max(0, told.at - before)
    count.acts[told.act] += 1
    count.rounds += 1
    return latest


def run(rounds: int, seed: int, told_every: int = 0) -> Count:
    """Kill so many sittings; return what came of it."""
    chance, count = random.Random(seed), Count()
    with tempfile.TemporaryDirectory() as name:
        top = Path(name)
        begin_in = top / "first"
        (begin_in / "more").mkdir(parents=True)
        begin(begin_in)
        open_whole(begin_in / f"show{SUFFIX}")  # what that imports is there for all
        folder, before, named = top, 0, True
        for number in range(rounds):
            if number % CHAIN == 0:
                folder, named = top / f"chain {number}", number // CHAIN % 3 < 2
                shutil.copytree(begin_in, folder)
                os.environ["XDG_DATA_HOME"] = str(folder / "state")
                before = 0
            opened = chance.random() < 0.8
            told = round_of(folder, named, chance.randrange(2**31), chance.uniform(0, LONGEST), opened)
            wrong = len(count.wrong)
            before = look(folder, named, told, before, count)
            if len(count.wrong) > wrong:
                kept = Path(tempfile.mkdtemp(prefix="killed-"))
                shutil.copytree(folder, kept, dirs_exist_ok=True)
                count.wrong[-1] += f" (round {number}, {kept})"
            if told_every and (number + 1) % told_every == 0:
                print(f"{number + 1} killed, {len(count.wrong)} wrong", flush=True)
    return count


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--count", type=int, default=1000)
    options.add_argument("--seed", type=int, default=1)
    given = options.parse_args()
    begun = time.monotonic()
    count = run(given.count, given.seed, 100)
    minutes = (time.monotonic() - begun) / 60
    acts = ", ".join(f"{name} {n}" for name, n in count.acts.most_common())
    print(
        f"{count.rounds} sittings killed in {minutes:.1f} minutes, {count.finished} edits finished; "
        f"{count.recovered} left edits to recover, {count.swept} unfinished files swept; killed in: {acts}"
    )
    for words in count.wrong:
        print(f"WRONG: {words}")
    return 1 if count.wrong else 0


if __name__ == "__main__":
    sys.exit(main())
