"""Damaged journals: what is whole is read, what is lost is reported, and nothing is thrown away."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path

import pytest

from metagraph.errors import FileError
from metagraph.formats.project.journal import Journal
from metagraph.formats.project.journal_records import LostEdit, encode_record, parse_record, read_records
from metagraph.formats.recovery import DAMAGED, read_journal, retire
from metagraph.formats.store import SUFFIX, save_project
from metagraph.graph import edits
from metagraph.graph.model import Project
from tests.reliability.flips import flip, journals

FEW = 53  # every so many bytes are damaged; `tests/reliability/flips.py` damages all


@pytest.mark.nightly
def test_no_damaged_byte_loses_an_edit_without_a_word(tmp_path: Path) -> None:
    count: Counter[str] = Counter()
    wrong: list[str] = []
    for number, (_, path, saved, _) in enumerate(journals(tmp_path)):
        size = path.stat().st_size
        flip(path, saved, range(number % FEW, size, FEW), 0xFF if number % 2 else 0x01, count, wrong)
    assert not wrong
    assert count["some lost, told"] > 50 and count["all"] > 50


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    path = tmp_path / f"show{SUFFIX}"
    save_project(Project("show"), path)
    return path


def write(saved: Path, names: list[str]) -> Path:
    journal, project = Journal(saved.with_name(".show.journal"), saved), Project("show")
    for n, name in enumerate(names):
        after = edits.set_settings(edits.rename_project(project, name), seed=n + 1)
        journal.edit(project, after, f"Rename to {name}")
        project = after
    journal.close()
    return journal.path


def test_one_damaged_edit_of_fifty_costs_that_one(saved: Path) -> None:
    path = write(saved, [f"name {n}" for n in range(50)])
    path.write_bytes(path.read_bytes().replace(b'"name":"name 4"', b'"name":"nam\x00 4"'))
    found = read_journal(path, saved)
    assert found is not None and found.project.name == "name 49" and len(found.records) == 49
    (lost,) = found.lost
    assert lost.step == "Rename to name 4" and lost.at is not None and lost.why == "damaged"


def test_a_journal_full_of_zeros_at_its_end_says_so(saved: Path) -> None:
    path = write(saved, ["a", "b"])
    path.write_bytes(path.read_bytes() + b"\x00" * 4096)
    found = read_journal(path, saved)
    assert found is not None and found.project.name == "b" and found.is_damaged


def test_an_edit_that_does_not_fit_without_a_lost_one_is_told(saved: Path) -> None:
    path = write(saved, ["a"])
    content = (
        path.read_bytes() + encode_record({"clips": 3, "step": "odd"}, 3) + encode_record({"name": "b"}, 4)
    )
    path.write_bytes(content)
    found = read_journal(path, saved)
    assert found is not None and found.project.name == "b"
    assert found.lost == (LostEdit("odd", None, "unfit"),)


def test_missing_records_are_counted_though_nothing_of_them_is_left(saved: Path) -> None:
    path = write(saved, ["a", "b", "c", "d"])
    lines = path.read_bytes().split(b"\n\n")
    del lines[3:5]
    path.write_bytes(b"\n\n".join(lines))
    found = read_journal(path, saved)
    assert found is not None and found.project.name == "d" and found.lost == (LostEdit(), LostEdit())


def test_the_text_it_builds_on_tells_which_file_it_was_when_its_head_is_damaged(saved: Path) -> None:
    path = write(saved, ["a"])
    path.write_bytes(b"\x00" + path.read_bytes()[1:])
    found = read_journal(path, saved)
    assert found is not None and not found.behind and found.project.name == "a" and not found.lost


def test_a_journal_of_before_there_were_checksums_is_read_on_behind_damage(saved: Path) -> None:
    records = read_records(write(saved, ["a", "b", "c"]).read_bytes()).whole
    head = {**records[0].data, **records[1].data}
    lines = [json.dumps(record, separators=(",", ":")) for record in (head, *(r.data for r in records[2:]))]
    lines[2] = lines[2][:20] + "\x00" + lines[2][20:]
    path = saved.with_name(".old.journal")
    path.write_text("\n".join(lines) + "\n")
    found = read_journal(path, saved)
    assert found is not None and found.project.name == "c"
    assert [lost.step for lost in found.lost] == ["Rename to b"]


def test_a_damaged_journal_is_kept_under_another_name_and_a_whole_one_goes(saved: Path) -> None:
    path = write(saved, ["a", "b"])
    content = path.read_bytes().replace(b'"name":"a"', b'"name":"\x00"')
    path.write_bytes(content)
    retire(path)
    kept = path.with_name(path.name + DAMAGED)
    assert not path.exists() and kept.read_bytes() == content
    retire(kept)
    assert kept.exists()
    retire(write(saved, ["a"]))
    assert not path.exists()


def test_a_journal_of_which_nothing_can_be_read_is_an_error(saved: Path) -> None:
    path = write(saved, ["a", "b"])
    path.write_bytes(b"\n".join(line[:-9] + b"x" * 8 for line in path.read_bytes().split(b"\n") if line))
    with pytest.raises(FileError, match="is damaged"):
        read_journal(path, saved)


def test_a_record_is_read_as_it_was_written_and_not_with_another_number() -> None:
    line = encode_record({"name": "tab\there\nand \u2028 there"}, 7).strip(b"\n")
    record = parse_record(line)
    assert record is not None and (record.number, record.data["name"]) == (7, "tab\there\nand \u2028 there")
    assert parse_record(line.replace(b"\t7\t", b"\t8\t")) is None
