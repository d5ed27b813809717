"""Links from a spreadsheet: what its cells may say, and what is reported about those that cannot be read."""

from __future__ import annotations

import pytest

from metagraph.errors import FileError
from metagraph.formats import manual_table as t
from metagraph.formats.project.data import from_data, to_data
from metagraph.formats.project.fields import DataError
from metagraph.formats.project.journal import find_changes
from metagraph.formats.project.replay import apply_change
from metagraph.graph.manual import edits as m
from metagraph.graph.manual import groups as g
from metagraph.graph.manual.machine import ANY, expand_links
from tests.graph.manual.test_machine import linked


def drawn(text: str):
    p, ids = linked()
    return t.fill_machine(p, "arms", t.parse_manual_table(text)), ids


@pytest.mark.parametrize(
    ("text", "words"),
    [("", "it is empty"), ("from;blend\nidle;1", "no column 'to'"), ("from,to,from\na,b,c", "'from' twice")],
)
def test_what_is_no_table_of_links_is_refused_with_what_it_should_be(tmp_path, text, words) -> None:
    path = tmp_path / "links.csv"
    path.write_text(text)
    with pytest.raises(FileError, match=words) as error:
        t.read_manual_table(path)
    assert error.value.path == path and "columns" in error.value.remedy


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_what_spreadsheets_write_is_read(tmp_path, encoding: str, separator: str) -> None:
    path = tmp_path / "links.csv"
    rows = [["From", "To", "Note", " BLEND "], ["idle", "wave", "für später", "0.5"], [], ["wave", "idle"]]
    path.write_bytes("\r\n".join(separator.join(r) for r in rows).encode(encoding))
    found = t.read_manual_table(path)
    assert [r.cells for r in found] == [
        {"from": "idle", "to": "wave", "blend": "0.5"},
        {"from": "wave", "to": "idle"},
    ]
    assert [r.number for r in found] == [2, 4]


def test_rows_draw_links_with_their_settings_and_bad_ones_are_told_and_spoil_no_other() -> None:
    out, _ids = drawn(
        "from,to,when,trigger,weight,exit,blend\n"
        "idle,wave,request,,,80 %,0.5\n"
        "idle,nod,,hello,,end,\n"
        "wave,idle,,,2,1.5,\n"
        "wave,nobody,,,,,\n"
        "wave,nod,sometimes,,,,\n"
        "wave,sit,,,,,-1\n"
        "wave,sit,,,,120 %,\n"
        ",sit,,,,,\n"
        "wave,sit,,,none,,\n"
        "any,sit,,,,,0\n"
    )
    links = list(out.project.manual["arms"].links.values())
    assert [(x.condition.when, x.condition.trigger, x.exit_time, x.exit_part, x.blend) for x in links] == [
        ("request", "wave", None, 0.8, 0.5),
        ("request", "hello", None, 1.0, 0.25),
        ("finished", "", 1.5, None, 0.25),
        ("request", "sit", None, None, 0.0),
    ]
    assert links[2].condition.weight == 2 and links[3].source == ANY
    assert [p.split(":")[0] for p in out.problems] == [f"line {n}" for n in (5, 6, 7, 8, 9, 10)]
    assert "'nobody'" in out.problems[0]
    assert (out.links, out.changed) == (4, 0)


def test_a_pattern_leaves_as_an_alias_and_arrives_at_each() -> None:
    p, ids = linked()
    for n, name in enumerate(("sit__idle", "sit__wave", "sit__nod", "stand")):
        p = m.update_states(p, [list(ids.values())[n]], name=name)
    out = t.fill_machine(
        p, "arms", t.parse_manual_table("from,to,when\nSIT_*,sit__*,request\nsit__*,stand,\n")
    )
    machine = out.project.manual["arms"]
    assert [a.name for a in machine.aliases.values()] == ["SIT"] and len(machine.links) == 4
    assert len(expand_links(machine)) == 9 and not out.problems


def test_a_row_that_fails_leaves_no_alias_behind() -> None:
    out, _ = drawn("from,to\ni*|w*|n*,nobody\n?[!x]*,*\n")
    assert len(out.problems) == 1 and len(out.project.manual["arms"].aliases) == 1


def test_a_link_that_is_there_is_set_as_the_row_says() -> None:
    p, _ids = linked(("idle", "wave"))
    out = t.fill_machine(p, "arms", t.parse_manual_table("from,to,blend\nIDLE,wave,1\n"))
    assert (out.links, out.changed) == (0, 1)
    assert [x.blend for x in out.project.manual["arms"].links.values()] == [1.0]


def test_a_table_that_was_written_gives_the_same_links() -> None:
    p, ids = linked(("idle", "wave"), (ANY, "nod"), ("sit", "sit"))
    p = g.add_alias(p, "arms", [ids["idle"], ids["sit"]])
    alias = list(p.manual["arms"].aliases)[-1]
    p = m.add_link(p, "arms", alias, ids["wave"])
    p = m.update_links(p, [*p.manual["arms"].links][:1], exit_time=0.3, blend=0.1)
    bare = m.remove_states(p, links=[*p.manual["arms"].links])
    out = t.fill_machine(bare, "arms", t.parse_manual_table(t.encode_machine_as_table(p.manual["arms"])))
    keys = [
        [
            (x.source, x.target, x.condition, x.exit_time, x.exit_part, x.blend)
            for x in q.manual["arms"].links.values()
        ]
        for q in (p, out.project)
    ]
    assert keys[0] == keys[1] and not out.problems


def test_aliases_are_saved_journalled_and_checked_when_read() -> None:
    before, ids = linked(("idle", "wave"))
    after = g.add_alias(before, "arms", [ids["idle"], ids["wave"]])
    alias = next(iter(after.manual["arms"].aliases))
    after = m.add_link(g.update_aliases(after, [alias], entry=ids["idle"]), "arms", ids["nod"], alias)
    data = to_data(after)
    assert from_data(data).manual == after.manual
    assert "aliases" not in to_data(before)["manual"]["arms"]
    assert from_data(apply_change(to_data(before), find_changes(before, after))).manual == after.manual
    assert from_data(apply_change(data, find_changes(after, before))).manual == before.manual
    for field, value, where in (
        ("states", ["m99"], "states[0]"), ("entry", "m99", "entry"),
        ("color", 1, "color"), ("states", "m5", "states"),
    ):  # fmt: skip
        broken = to_data(after)
        broken["manual"]["arms"]["aliases"][0][field] = value
        with pytest.raises(DataError) as error:
            from_data(broken)
        assert error.value.where == f"manual.arms.aliases[0].{where}"
    broken = to_data(after)
    broken["manual"]["arms"]["links"][0]["exit_part"] = 1.5
    with pytest.raises(DataError, match="between 0 and 1"):
        from_data(broken)
