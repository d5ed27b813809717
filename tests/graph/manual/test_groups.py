"""Aliases and groups of states, many links at once, links copied to others, and where a link leaves."""

from __future__ import annotations

from dataclasses import replace

import pytest

from metagraph.graph.edit_error import EditError
from metagraph.graph.manual import edits as m
from metagraph.graph.manual import groups as g
from metagraph.graph.manual.check import check_manual
from metagraph.graph.manual.machine import ANY, Condition, Link, expand_links, remove_from_machine
from metagraph.graph.manual.timing import find_exit_moment
from metagraph.graph.model import Project
from metagraph.playback.manual_playback import Fire, make_manual_plan, plan_link_alone
from tests.graph.manual.test_machine import linked, project

pytestmark = pytest.mark.usefixtures("numbered_ids")


def grouped(*names: str, every: bool = False) -> tuple[Project, dict[str, str], str]:
    """The four states, ids by name, and an alias of some."""
    out, ids = linked()
    out = g.add_alias(out, "arms", [ids[n] for n in names], every)
    return out, ids, next(iter(out.manual["arms"].aliases))


def pairs(p: Project, ids: dict[str, str]) -> set[str]:
    names = {i: n for n, i in ids.items()}
    return {f"{names[a]}>{names[b]}" for a, b in expand_links(p.manual["arms"])}


def test_an_alias_of_nothing_is_refused() -> None:
    with pytest.raises(EditError, match="select the states"):
        g.add_alias(Project(), "arms", [])
    with pytest.raises(EditError, match="select the states"):
        g.add_alias(Project(), "arms", [], every=True)
    with pytest.raises(EditError, match="select the states"):
        g.add_alias(project(), "arms", ["m99"])


def test_a_link_from_an_alias_stands_for_one_from_each_of_its_states_but_its_target() -> None:
    p, ids, alias = grouped("idle", "wave")
    p = m.add_link(p, "arms", alias, ids["wave"])
    assert pairs(p, ids) == {"idle>wave"}
    p = g.update_aliases(p, [alias], again=True)
    assert pairs(p, ids) == {"idle>wave", "wave>wave"}
    link = next(iter(p.manual["arms"].links.values()))
    assert link.condition == Condition("request", "wave") and link.exit_part == 1


def test_an_alias_of_every_state_stands_for_those_to_come() -> None:
    p, ids, alias = grouped(every=True)
    p = m.add_link(p, "arms", alias, ids["sit"])
    assert pairs(p, ids) == {"idle>sit", "wave>sit", "nod>sit"}
    p = m.add_states(p, ["c2"], "arms")
    assert len(expand_links(p.manual["arms"])) == 4


def test_a_link_to_a_group_leads_to_its_entry_and_one_without_takes_none() -> None:
    p, ids, alias = grouped("wave", "nod")
    with pytest.raises(EditError, match="has no entry"):
        m.add_link(p, "arms", ids["idle"], alias)
    p = g.update_aliases(p, [alias], entry=ids["nod"])
    p = m.add_link(p, "arms", ids["idle"], alias)
    assert pairs(p, ids) == {"idle>nod"}
    assert p.manual["arms"].reachable() == {ids["idle"], ids["nod"]}
    lost = g.update_aliases(p, [alias], entry=None)
    assert not expand_links(lost.manual["arms"])
    assert "no-entry" in [x.code for x in check_manual(lost)]
    with pytest.raises(KeyError):
        plan_link_alone(lost, next(iter(lost.manual["arms"].links)))


def test_a_states_own_link_stands_before_its_aliases_and_theirs_before_any_states() -> None:
    p, ids, alias = grouped("idle", "wave")
    everyone = g.add_alias(p, "arms", [], every=True)
    p = everyone
    whole = list(p.manual["arms"].aliases)[-1]
    for source in (ANY, whole, alias, ids["idle"]):
        p = m.add_link(p, "arms", source, ids["nod"])
    p = m.update_links(p, [*p.manual["arms"].links], condition={"when": "request", "trigger": "nod"})
    by = {n: [x.source for x in p.manual["arms"].leaving(ids[n])] for n in ("idle", "wave", "sit")}
    assert by == {"idle": [ids["idle"]], "wave": [alias], "sit": [whole]}


def test_links_that_are_taken_otherwise_stand_beside_each_other() -> None:
    p, ids, alias = grouped("idle", "wave")
    p = m.add_link(p, "arms", ids["idle"], ids["nod"])  # when it has finished
    p = m.add_link(p, "arms", alias, ids["nod"])  # on request
    assert [x.condition.when for x in p.manual["arms"].leaving(ids["idle"])] == ["finished", "request"]


def test_states_that_go_are_no_longer_stood_for_and_a_group_loses_its_entry() -> None:
    p, ids, alias = grouped("idle", "wave")
    p = g.update_aliases(p, [alias], entry=ids["idle"])
    left = remove_from_machine(p.manual["arms"], [ids["idle"]])
    assert left.aliases[alias].states == (ids["wave"],) and left.aliases[alias].entry is None
    p = m.add_link(p, "arms", alias, ids["nod"])
    gone = m.remove_states(p, [alias]).manual["arms"]
    assert not gone.aliases and not gone.links


def test_states_join_and_leave_an_alias() -> None:
    p, ids, alias = grouped("idle")
    p = g.set_alias_states(p, alias, [ids["sit"], ids["wave"]])
    assert p.alias(alias).states == (ids["idle"], ids["wave"], ids["sit"])
    p = g.update_aliases(p, [alias], entry=ids["sit"])
    p = g.set_alias_states(p, alias, [ids["sit"]], on=False)
    assert p.alias(alias).states == (ids["idle"], ids["wave"]) and p.alias(alias).entry is None
    with pytest.raises(EditError, match="no longer"):
        g.set_alias_states(p, "g99", [])
    assert g.update_aliases(p, [alias], again=False) is p


def test_many_links_are_drawn_at_once_none_twice_and_none_to_itself() -> None:
    p, ids = linked(("idle", "wave"))
    some = [ids["idle"], ids["wave"]]
    p = m.add_links(p, "arms", some, some)
    assert pairs(p, ids) == {"idle>wave", "wave>idle"} and len(p.manual["arms"].links) == 2
    with pytest.raises(EditError, match="already exist"):
        m.add_links(p, "arms", some, some)
    with pytest.raises(EditError, match="other way round"):
        m.add_links(p, "arms", some, [ANY])


def test_what_names_share_is_what_an_alias_is_called() -> None:
    assert g.find_shared_words(["hips__wave", "hips__nod", "sit__to__hips"]) == "hips"
    assert g.find_shared_words(["sit__nod", "sit__wave"]) == "sit"
    assert g.find_shared_words(["sitting", "sit"]) == "" and g.find_shared_words(["sit", "sit_2"]) == "sit"
    assert (
        g.find_shared_words(["a", "b"]) == ""
        and g.find_shared_words(["hands on hips 1", "hands on knee"]) == "hands on"
    )
    p, _, alias = grouped("idle", "wave")
    assert p.alias(alias).name == "alias"
    p = g.add_alias(p, "arms", [], every=True)
    assert list(p.manual["arms"].aliases.values())[-1].name == "every state"


def test_copied_links_are_drawn_for_other_states_with_their_settings() -> None:
    p, ids = linked(("idle", "wave"), ("idle", "nod"))
    links = list(p.manual["arms"].links.values())
    p = m.update_links(p, [links[0].id], blend=0.5, exit_part=0.5)
    copies = list(p.manual["arms"].links.values())
    p = g.paste_copied_links(p, "arms", copies, [ids["sit"], ids["nod"]])
    assert pairs(p, ids) == {"idle>wave", "idle>nod", "sit>wave", "sit>nod", "nod>wave"}
    assert [x.blend for x in p.manual["arms"].links.values() if x.target == ids["wave"]] == [0.5] * 3
    with pytest.raises(EditError, match="already exist"):
        g.paste_copied_links(p, "arms", copies, [ids["sit"]])


def test_copied_links_that_lead_to_one_state_lead_to_others_named_after_them() -> None:
    p, ids = linked(("idle", "wave"), ("sit", "wave"))
    p = m.update_links(p, [*p.manual["arms"].links], condition={"when": "request"})
    copies = list(p.manual["arms"].links.values())
    p = g.paste_copied_links(p, "arms", copies, [ids["nod"]])
    assert pairs(p, ids) == {"idle>wave", "sit>wave", "idle>nod", "sit>nod"}
    assert [x.condition.trigger for x in p.manual["arms"].links.values()] == ["wave", "wave", "nod", "nod"]
    loose = [Link("l1", "a", "b"), Link("l2", "c", "d")]
    with pytest.raises(EditError, match="leave one state"):
        g.paste_copied_links(p, "arms", loose, [ids["nod"]])


def test_a_copied_group_stands_for_the_copies() -> None:
    p, ids, alias = grouped("idle", "wave")
    p = g.update_aliases(p, [alias], entry=ids["idle"])
    p = m.add_link(p, "arms", alias, ids["wave"])
    p, made = m.paste_states(p, "arms", m.copy_states(p, [ids["idle"], ids["wave"], alias]), 400, 400)
    copy = p.alias(made[2])
    assert copy.states == tuple(made[:2]) and copy.entry == made[0] and copy.name == "alias 2"
    link = list(p.manual["arms"].links.values())[-1]
    assert (link.source, link.target, link.condition.trigger) == (made[2], made[1], "wave 2")


def test_arms_are_told_from_names_as_for_the_meta_graph() -> None:
    from metagraph.graph import edits
    from tests.projects import clip

    p = edits.add_clips(
        Project(), [(f"{n}.glb", 0, "", clip(n)) for n in ("wave_lf", "shrug_bt", "point_rt")]
    )
    placed = m.add_states(p, [*p.clips], "arms").manual["arms"]
    assert [s.limb for s in placed.states.values()] == ["left", "both", "right"]
    assert {s.limb for s in m.add_states(p, [*p.clips], "head").manual["head"].states.values()} == {"both"}


@pytest.mark.parametrize(
    ("link", "loop", "leaves"),
    [
        (Link("l", "a", "b", Condition("request", "x")), False, None),
        (Link("l", "a", "b", Condition("request", "x"), exit_part=1.0), False, -0.25),
        (Link("l", "a", "b", Condition("request", "x"), exit_part=1.0), True, None),
        (Link("l", "a", "b", Condition(), exit_part=1.0), True, -0.25),
        (Link("l", "a", "b", Condition()), False, -0.25),
        (Link("l", "a", "b", Condition("request", "x"), exit_time=0.1, exit_part=1.0), True, 0.1),
        (Link("l", "a", "b", Condition("request", "x"), exit_part=0.0), False, 0.0),
        (Link("l", "a", "b", Condition(), blend=99.0, exit_part=0.5), False, 0.0),
    ],
)
def test_a_source_is_left_at_its_time_at_a_share_or_at_its_end(
    link: Link, loop: bool, leaves: float | None
) -> None:
    p = project()
    state = replace(p.manual["arms"].states["m5"], loop=loop)
    end = p.clips[state.clip].duration
    at = find_exit_moment(p, state, link)
    if leaves is None:
        assert at is None
    else:
        assert at == pytest.approx(leaves if leaves >= 0 else end + leaves)


def test_a_request_waits_for_the_end_of_a_gesture_and_not_for_a_loops() -> None:
    p, ids, alias = grouped("idle", "wave")
    for target in ("idle", "wave", "nod"):
        p = m.add_link(p, "arms", alias, ids[target])
    p = m.update_states(p, [ids["idle"]], loop=True)
    end = p.clips[p.manual["arms"].states[ids["wave"]].clip].duration
    plan = make_manual_plan(p, 60.0, [Fire("arms", "wave", 1.0), Fire("arms", "nod", 1.3)])
    played = plan.layers["arms"].played
    assert [t.action.id for t in played] == [ids["idle"], ids["wave"], ids["nod"]]
    assert played[1].start == pytest.approx(1.0)
    assert played[2].start == pytest.approx(1.0 + end - 0.25) and not plan.reports


def test_an_alias_that_stands_for_nothing_or_is_entered_from_outside_is_told() -> None:
    p, ids, alias = grouped("idle", "wave")
    assert ("hint", "alias-unused") in [(x.severity, x.code) for x in check_manual(p)]
    p = g.update_aliases(p, [alias], entry=ids["nod"])
    p = m.add_link(p, "arms", ids["sit"], alias)
    assert "alias-entry" in [x.code for x in check_manual(p)]
    p = g.update_aliases(m.add_link(p, "arms", alias, ids["sit"]), [alias], states=(), entry=None)
    told = [x for x in check_manual(p) if x.code == "alias-empty"]
    assert told[0].severity == "warning" and told[0].state == alias and "'alias'" in told[0].message
