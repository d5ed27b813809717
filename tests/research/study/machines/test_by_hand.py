"""Ways to draw a machine by hand: each makes the reference, and the search misses none that is cheaper."""

from __future__ import annotations

import random
from dataclasses import replace

import pytest

from metagraph.graph import edits
from metagraph.graph.model import Project
from metagraph.graph.name_search import matches_search
from metagraph.research.study.machines.by_hand import Way, Work, list_ways, list_works, make_batches
from metagraph.research.study.machines.counted_drops import label_by_drops
from metagraph.research.study.machines.counted_hand import CountedHand, search_ways, strip_project, try_way
from metagraph.research.study.machines.covering import as_set, cover_by_rectangles, list_bits
from metagraph.research.study.machines.finding import Finder
from tests.projects import clip

NAMES = {
    "sit__idle": "stance", "sit__wave_lf": "gesture", "sit__nod": "gesture", "sit__scratch": "fidget",
    "stand__idle": "stance", "stand__point_rt": "gesture", "stand__sway": "fidget", "odd": "gesture",
}  # fmt: skip


def reference(shuffled: int = 0) -> Project:
    """Two stances with what is theirs and the ways between them, and a head that nods; in another order for
    another number.
    """
    names = [*NAMES, "sit__to__stand", "stand__to__sit", "head__rest", "head__nod"]
    random.Random(shuffled).shuffle(names) if shuffled else None
    out = edits.add_clips(Project("made"), [(f"{n}.glb", 0, "", clip(n)) for n in names])
    ids = {e.name: i for i, e in out.clips.items()}
    stances = {}
    for name, layer in (("sit", "arms"), ("stand", "arms"), ("head", "head")):
        rest = ids[f"{name}__rest" if name == "head" else f"{name}__idle"]
        out = edits.add_stance(out, layer, name, [rest])
        stances[name] = list(out.graphs[layer].stances)[-1]
    for name, kind in NAMES.items():
        if kind != "stance":
            stance = stances["stand" if name == "odd" else name.split("__")[0]]
            out = edits.place_clips(out, [ids[name]], "arms", kind, stance, None)
    out = edits.place_clips(
        out, [ids["sit__to__stand"]], "arms", "transition", stances["sit"], stances["stand"]
    )
    out = edits.place_clips(
        out, [ids["stand__to__sit"]], "arms", "transition", stances["stand"], stances["sit"]
    )
    return edits.place_clips(out, [ids["head__nod"]], "head", "gesture", stances["head"], None)


@pytest.mark.parametrize("shuffled", [0, 1, 2])
@pytest.mark.parametrize("named", [True, False])
def test_every_way_draws_just_the_reference(shuffled: int, named: bool) -> None:
    found = search_ways(reference(shuffled), named, look=True)
    assert len(found) == len(list_ways(named)) >= 16
    for tried in found:
        assert not tried.score.mistakes and tried.score.f1 == 1.0, (str(tried.way), tried.score.mistakes)
    assert [t.seconds for t in found] == sorted(t.seconds for t in found)


def test_aliases_are_found_to_be_cheaper_than_links_one_by_one_and_take_fewer() -> None:
    found = search_ways(reference())
    by = {(t.way.links, t.way.settle, t.way.pick, t.way.drop): t for t in found}
    best, worst = found[0], by["one by one", "each", "clicks", "one by one"]
    assert best.way.links in ("from aliases", "from any state")
    assert best.edges < worst.edges and 4 * best.seconds < worst.seconds


def test_looking_takes_keys_and_the_clips_own_time() -> None:
    way = Way("many at once", "from aliases", "words", "many at once")
    plain, looked = try_way(way, reference()), try_way(way, reference(), look=True)
    assert looked.operators["K"] == plain.operators["K"] + 2 * 12
    assert looked.looked == pytest.approx(sum(e.duration for e in reference().clips.values()))
    assert plain.looked == 0


def test_a_reference_of_one_clip_and_an_empty_one_are_drawn() -> None:
    one = edits.add_clips(Project("one"), [("idle.glb", 0, "", clip("idle"))])
    one = edits.add_stance(one, "arms", "rest", [*one.clips])
    assert all(not t.score.mistakes for t in search_ways(one))
    assert list_works(Project()) == [] and not try_way(list_ways()[0], Project()).operators["B"] > 2


def test_clips_that_names_do_not_tell_apart_are_drawn_by_clicks() -> None:
    ref = reference()
    clips = {c: replace(e, name="take") for c, e in ref.clips.items()}
    found = search_ways(replace(ref, clips=clips))
    assert found and all(t.score.f1 == 1.0 for t in found)
    assert "from a table" not in {t.way.links for t in found}


def test_labelling_without_proposals_is_counted_and_right() -> None:
    for shuffled in range(3):
        found = label_by_drops(reference(shuffled))
        assert not found.score.mistakes and found.seconds > 0


def test_a_single_link_is_drawn_although_others_are_selected() -> None:
    ref = reference()
    hand = CountedHand(strip_project(ref))
    (work, *_) = [w for w in list_works(ref) if w.layer == "arms"]
    hand.layer(work)
    hand.drop(work, work.clips, "")
    hand.link(work.clips[0], work.clips[1], False)
    assert len(hand.links) == 1
    assert len(hand.project.manual["arms"].links) == 1


# --- covers


def rows(*leads: str) -> list[int]:
    return [as_set(int(c) for c in row) for row in leads]


def made(cover) -> set[tuple[int, int]]:
    return {
        (a, b) for r in cover.rectangles for a in list_bits(r.sources) for b in list_bits(r.targets) if a != b
    }


@pytest.mark.parametrize(
    ("leads", "fewest"),
    [
        ((), 0),
        (("",), 0),
        (("1", "0"), 1),
        (("12", "02", "01"), 1),
        (("1", "2", "0"), 3),
        (("23", "23", "", ""), 1),
    ],
)
def test_a_cover_makes_just_what_is_wanted_with_the_fewest(leads: tuple[str, ...], fewest: int) -> None:
    wanted = rows(*leads)
    cover = cover_by_rectangles(wanted)
    assert made(cover) == {(a, b) for a, row in enumerate(wanted) for b in list_bits(row)}
    assert len(cover.rectangles) == fewest and cover.least <= fewest


def test_covers_of_any_machine_are_right_and_never_beat_the_bound() -> None:
    draw = random.Random(3)
    for _ in range(60):
        n = draw.randint(2, 9)
        wanted = [draw.getrandbits(n) & ~(1 << a) for a in range(n)]
        cover = cover_by_rectangles(wanted)
        assert made(cover) == {(a, b) for a, row in enumerate(wanted) for b in list_bits(row)}
        assert cover.least <= len(cover.rectangles)


# --- words


def test_words_that_are_found_select_just_the_set() -> None:
    names = [*NAMES, "sit__to__stand", "stand__to__sit"]
    finder = Finder(names)
    draw = random.Random(1)
    some = 0
    for _ in range(200):
        want = draw.getrandbits(len(names))
        words = finder.best(want) if want else None
        if words is not None:
            some += 1
            assert as_set(n for n, name in enumerate(names) if matches_search(words.text, name)) == want, (
                words.text
            )
    assert some > 150


def test_the_words_found_are_no_longer_than_a_persons() -> None:
    names = [*NAMES, "sit__to__stand", "stand__to__sit"]
    into_sit = as_set(
        n for n, x in enumerate(names) if x.endswith("to__sit") or (x.startswith("sit") and "to__" not in x)
    )
    words = Finder(names).best(into_sit)
    assert words is not None and len(words.text) <= len("sit__ -to__|to__sit")


def test_what_no_words_tell_apart_has_none() -> None:
    assert Finder(["wave", "wave"]).best(1) is None
    assert Finder([]).parts == {}


def test_clips_are_dropped_in_batches_that_hold_no_other() -> None:
    library = {str(n): name for n, name in enumerate([*NAMES, "wave", "wave"])}
    names = dict(library)
    out = make_batches(library, ["1", "2", "8"])
    assert sorted(c for some, _ in out for c in some) == ["1", "2", "8"]
    assert set(library) == set(names) - {"1", "2", "8"}
    assert make_batches({"a": "x"}, ["a"]) == [(["a"], "")]


@pytest.mark.parametrize(
    ("words", "name", "found"),
    [
        ("", "wave", False), (" | ", "wave", False), ("-", "wave", False), ("WAVE", "a wave", True),
        ("wave -left", "wave left", False), ("-left", "wave", True), ("nod|wave", "wave", True), ("a b", "b a", True),
        ("a|", "b", False), ("--", "a-b", False),
    ],
)  # fmt: skip
def test_searched_words(words: str, name: str, found: bool) -> None:
    assert matches_search(words, name) is found


def test_blocks_lie_so_that_bands_are_few() -> None:
    (work, *_) = [w for w in list_works(reference()) if w.layer == "arms"]
    assert sorted(n for block in work.order for n in block) == list(range(len(work.clips)))
    sets = [s for r in work.cover.rectangles for s in (r.sources, r.targets)]
    assert all(len(work.runs(s)) <= 2 for s in sets)
    assert isinstance(work, Work)
