"""Every byte of ten journals damaged in turn: python tests/reliability/flips.py [--bits 255]

What is read back afterwards is the whole, or says which edits are lost. Exit code 1 where an edit is lost
without a word.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterable
from itertools import pairwise
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from metagraph.errors import FileError
from metagraph.formats.locking import make_owner
from metagraph.formats.project.data import to_data
from metagraph.formats.project.journal import Journal
from metagraph.formats.recovery import Left, read_journal
from metagraph.formats.store import SUFFIX, compute_content_digest, encode_project, save_project
from metagraph.graph import edits
from metagraph.graph.conversation import edits as conversation_edits
from metagraph.graph.conversation.model import Conversation, Segment, Side, Word
from metagraph.graph.model import Project
from sample_clips.make.numbered_ids import numbered_ids
from tests.projects import clip

Edit = Callable[[Project], Project]


def first() -> Project:
    clips = [(f"{n}.glb", 0, "ab" * 32, clip(f"{n}")) for n in range(3)]
    project = edits.add_stance(edits.add_clips(Project("show"), clips), "arms", "rest", ["c1"])
    return edits.place_clips(
        project, ["c2", "c3"], "arms", "gesture", next(iter(project.graphs["arms"].stances))
    )


def renames(count: int) -> list[Edit]:
    return [lambda p, n=n: edits.rename_clip(p, "c1", f"name {n}") for n in range(count)]  # type: ignore[misc]


def mixed() -> list[Edit]:
    return [
        lambda p: edits.add_clips(p, [("more.glb", 0, "cd" * 32, clip("more"))]),
        lambda p: edits.add_stance(p, "head", "level", ["c1"]),
        lambda p: edits.place_clips(p, ["c2"], "arms", "fidget", next(iter(p.graphs["arms"].stances))),
        lambda p: edits.remove_actions(p, [next(iter(p.graphs["arms"].actions))]),
        lambda p: edits.set_weight(p, "arms", "head", 0.5),
        lambda p: edits.set_settings(p, seed=9),
    ]


def talk() -> list[Edit]:
    words = tuple(Word(text=f"wörd{n}", start=n / 3, end=n / 3 + 0.3) for n in range(6))
    clauses = tuple(Segment("clause", float(n), n + 0.9, n + 0.3, "a b c") for n in range(2))
    said = Conversation(
        name="x", length=4, sides=(Side(name="Ada", words=words, segments=clauses), Side(name="Ben"))
    )

    def move(project: Project) -> Project:
        return conversation_edits.move_segment(project, next(iter(project.conversations)), 0, 0, 0.05)

    return [lambda p: conversation_edits.add_conversation(p, said)[0], move, move]


def journals(folder: Path) -> Iterable[tuple[str, Path, Path | None, int]]:
    """Write journals of ten kinds; yield of each what it is, where, of what project file, and its edits."""
    kinds: list[tuple[str, list[Edit], str]] = [
        ("renames", renames(6), "saved"),
        ("renames of a project never saved", renames(4), "untitled"),
        ("edits of many kinds", mixed(), "saved"),
        ("edits of many kinds, never saved", mixed(), "untitled"),
        ("a conversation", talk(), "saved"),
        ("steps undone", renames(4), "undone"),
        ("saved in between, killed before", renames(5), "marked"),
        ("saved in between, killed after", renames(5), "written"),
        ("recovered once", renames(5), "recovered"),
        ("the project file gone", renames(4), "gone"),
    ]
    for number, (name, made, kind) in enumerate(kinds):
        place = folder / str(number)
        place.mkdir()
        saved = None if kind == "untitled" else place / f"show{SUFFIX}"
        with numbered_ids():
            states = [first()]
            for edit in made:
                states.append(edit(states[-1]))
        if saved is not None:
            save_project(states[0], saved)
        journal = Journal(place / ".show.journal", saved, make_owner())
        begun = 0
        if kind == "untitled":
            journal.begin(states[0])
        if kind == "recovered":
            begun = 2
            journal.begin(states[0], 1, [(a, b, "step") for a, b in pairwise(states[:3])])
        for n in range(begun, len(made)):
            journal.edit(states[n], states[n + 1], f"Edit {n}")
            if kind == "undone":
                journal.edit(states[n + 1], states[n], f"Edit {n}", "undone")
                journal.edit(states[n], states[n + 1], f"Edit {n}", "redone")
            if kind in ("marked", "written") and n == 2 and saved is not None:
                mark = journal.mark()
                assert mark is not None
                journal.settle(mark, compute_content_digest(encode_project(states[n + 1], saved)))
                if kind == "written":
                    save_project(states[n + 1], saved)
        journal.close()
        if kind == "gone" and saved is not None:
            saved.unlink()
        yield name, journal.path, saved, len(made)


def judge(found: Left | str | None, whole: Left) -> str:
    """Return what came of a damaged journal."""
    if isinstance(found, str):
        return "nothing readable, told"
    if found is None:
        return "SILENT"
    same = to_data(found.project) == to_data(whole.project)
    complete = same and len(found.records) >= len(whole.records)
    if found.is_damaged or found.worked_in:
        return "all, a doubt told" if complete else "some lost, told"
    return "all" if complete else "SILENT"


def flip(
    path: Path, saved: Path | None, places: Iterable[int], bits: int, count: Counter[str], wrong: list[str]
) -> None:
    """Damage a journal in each of some places in turn, and count what comes of it."""
    content = path.read_bytes()
    whole = read_journal(path, saved)
    assert whole is not None and not whole.is_damaged
    for place in places:
        damaged = bytearray(content)
        damaged[place] ^= bits
        path.write_bytes(damaged)
        found: Left | str | None
        try:
            found = read_journal(path, saved)
        except FileError as error:
            found = str(error)
        what = judge(found, whole)
        count[what] += 1
        if isinstance(found, Left):
            count["edits recovered"] += len(found.records)
            count["edits lost, told"] += len(found.lost)
        if what == "SILENT":
            wrong.append(f"{path.parent.name}, byte {place}: {content[max(0, place - 20) : place + 20]!r}")
    path.write_bytes(content)


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument(
        "--bits", type=int, default=255, help="of each byte that are turned round, as a number"
    )
    bits = options.parse_args().bits
    total: Counter[str] = Counter()
    wrong: list[str] = []
    with tempfile.TemporaryDirectory() as folder:
        for name, path, saved, edits_made in journals(Path(folder)):
            count: Counter[str] = Counter()
            size = path.stat().st_size
            flip(path, saved, range(size), bits, count, wrong)
            print(f"{name}: {edits_made} edits, {size:,} bytes: {dict(count)}", flush=True)
            total += count
    print(f"all: {dict(total)}")
    for words in wrong[:20]:
        print("WRONG:", words)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
