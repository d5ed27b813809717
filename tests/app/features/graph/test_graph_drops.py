"""What a drop says before it happens, and that it then does what it said."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QMimeData, QUrl

from app.features.graph.graph_drops import drop_at, merge_at, perform_drop
from app.features.graph.graph_layout import GraphHit
from app.project.load import Load
from app.widgets.mime import load_of, make_mime
from metagraph.graph import edits
from metagraph.graph.model import Project


@pytest.fixture(scope="module")
def project(toy):
    return toy.project()


def at(area: str, ident: str | None = None, kind: str | None = None) -> GraphHit:
    return GraphHit(area, ident, kind)


NODE = {kind: GraphHit("node", None, kind) for kind in ("gesture", "fidget", "transition")}


@pytest.mark.parametrize(
    ("hit", "count", "words", "kind", "stance", "end"),
    [
        (at("card"), 1, "this clip|new stance", "stance", None, None),
        (at("add"), 2, "2 clips|new stance", "stance", None, None),
        (at("loop", "rest"), 1, "this clip|loop|*rest*", "stance", "rest", None),
        (at("chip", "up"), 3, "3 clips|loops|*up*", "stance", "up", None),
        (NODE["gesture"], 1, "this clip|gesture|*rest*", "gesture", "rest", None),
        (NODE["fidget"], 3, "3 clips|fidgets|*rest*", "fidget", "rest", None),
        (at("row", "x", "gesture"), 2, "2 clips|gestures|*rest*", "gesture", "rest", None),
        (at("bar", "x", "fidget"), 1, "this clip|fidget|*rest*", "fidget", "rest", None),
        (NODE["transition"], 1, "this clip|transition|*rest*|*up*", "transition", "rest", "up"),
        (at("other", None, "transition"), 2, "2 clips|*rest*|*up*", "transition", "rest", "up"),
    ],
)
def test_a_drop_of_clips_says_what_it_will_do_and_does_it(toy, project, hit, count, words, kind, stance, end):
    rest, up = toy.id(project, "rest"), toy.id(project, "up")
    ids = {"rest": rest, "up": up, None: None}
    if hit.area in ("loop", "chip"):
        hit = GraphHit(hit.area, ids[hit.ident], "stance")
    load = Load(clips=tuple(project.clips)[:count])
    drop = drop_at(project, "arms", rest, up, hit, load)
    assert drop.possible
    assert all(piece in drop.words for piece in words.split("|"))
    assert (drop.kind, drop.stance, drop.end) == (kind, ids[stance], ids[end])
    after = perform_drop(project, "arms", drop, load)
    made = [a for a in after.actions() if project.action(a.id) is None]
    assert [a.clip for a in made] == list(load.clips)
    assert {(a.kind, a.end_stance) for a in made} == {(kind, ids[end])}
    assert len(after.graphs["arms"].stances) == len(project.graphs["arms"].stances) + (stance is None)


@pytest.mark.parametrize("area", ["nothing", "start"])
def test_beside_the_nodes_nothing_can_be_dropped(toy, project, area):
    drop = drop_at(
        project, "arms", toy.id(project, "rest"), None, GraphHit(area), Load(clips=tuple(project.clips)[:1])
    )
    assert not drop.possible and "nodes" in drop.words


def test_something_else_than_clips_is_refused_with_what_can_be_dropped(project):
    assert "clips, folders" in drop_at(project, "arms", None, None, GraphHit("card"), Load()).words


@pytest.mark.parametrize("kind", ["gesture", "fidget", "transition"])
def test_without_a_stance_the_nodes_say_to_make_one(project, kind):
    drop = drop_at(project, "head", None, None, NODE[kind], Load(clips=tuple(project.clips)[:1]))
    assert not drop.possible
    assert "make a stance first" in drop.words
    assert "head" in drop.words


def test_a_transition_needs_a_second_stance(toy):
    project = edits.add_clips(Project(), [("a.glb", 0, "", toy.clip("a"))])
    clip = next(iter(project.clips))
    project = edits.add_stance(project, "arms", "only", [clip])
    drop = drop_at(project, "arms", toy.id(project, "only"), None, NODE["transition"], Load(clips=(clip,)))
    assert not drop.possible
    assert "choose the stance" in drop.words


def test_a_clip_of_another_skeleton_is_refused_by_name(toy, project):
    from metagraph.motion.clip import Clip
    from metagraph.motion.skeleton import Skeleton

    s = toy.skeleton
    other = Skeleton(("Root", *s.names[1:]), s.parents, s.rest_rotations, s.rest_translations)
    clip = toy.clip("alien")
    mixed = edits.add_clips(
        project, [("alien.glb", 0, "", Clip("alien", other, clip.fps, clip.rotations, clip.translations))]
    )
    drop = drop_at(
        mixed, "arms", toy.id(mixed, "rest"), None, NODE["gesture"], Load(clips=(toy.id(mixed, "alien"),))
    )
    assert not drop.possible
    assert "'alien' has a different skeleton" in drop.words


def test_files_can_be_dropped_before_there_is_any_clip():
    empty, files = Project(), Load(files=("/a/b.bvh", "/a/c.glb"))
    drop = drop_at(empty, "arms", None, None, GraphHit("card"), files)
    assert drop.possible and "2 files" in drop.words and "new stance" in drop.words
    drop = drop_at(empty, "arms", None, None, NODE["gesture"], files)
    assert not drop.possible
    assert "make a stance first" in drop.words


def test_actions_move_between_nodes_and_keep_what_was_set(toy, project):
    rest, up, beat = toy.id(project, "rest"), toy.id(project, "up"), toy.id(project, "rest beat lf")
    project = edits.update_actions(project, [beat], tags=("positive",), likelihood=2.0)
    load = Load(actions=(beat,))
    drop = drop_at(project, "arms", rest, up, NODE["fidget"], load)
    assert "fidget" in drop.words and "*rest*" in drop.words
    after = perform_drop(project, "arms", drop, load).action(beat)
    assert (after.kind, after.tags, after.likelihood) == ("fidget", ("positive",), 2.0)


def test_actions_dropped_on_a_chip_move_there_and_stay_what_they_are(toy, project):
    up = toy.id(project, "up")
    beat, cough = toy.id(project, "rest beat lf"), toy.id(project, "rest cough")
    load = Load(actions=(beat, cough))
    drop = drop_at(project, "arms", toy.id(project, "rest"), up, GraphHit("chip", up), load)
    assert drop.possible
    assert drop.words == "move 2 actions to *up*"
    after = perform_drop(project, "arms", drop, load)
    assert [(after.action(i).kind, after.action(i).stance) for i in load.actions] == [
        ("gesture", up),
        ("fidget", up),
    ]


def test_actions_dropped_where_they_are_say_so(toy, project):
    rest = toy.id(project, "rest")
    drop = drop_at(
        project, "arms", rest, None, GraphHit("chip", rest), Load(actions=(toy.id(project, "rest cough"),))
    )
    assert not drop.possible
    assert drop.words == "already in *rest*"


def test_a_transition_cannot_move_to_where_it_ends(toy, project):
    up = toy.id(project, "up")
    drop = drop_at(
        project,
        "arms",
        toy.id(project, "rest"),
        up,
        GraphHit("chip", up),
        Load(actions=(toy.id(project, "rest to up"),)),
    )
    assert not drop.possible
    assert "another stance" in drop.words


def test_an_action_makes_no_new_stance_but_its_clip_can(toy, project):
    drop = drop_at(
        project,
        "arms",
        toy.id(project, "rest"),
        None,
        GraphHit("card"),
        Load(actions=(toy.id(project, "rest cough"),)),
    )
    assert not drop.possible
    assert "from the library" in drop.words


def test_what_is_dragged_survives_the_clipboards_bytes():
    assert load_of(make_mime(clips=["c1", "c2"])) == Load(clips=("c1", "c2"))
    assert load_of(make_mime(actions=["a1"])) == Load(actions=("a1",))
    assert not load_of(QMimeData())


def test_only_files_that_can_be_clips_and_folders_are_taken():
    data = QMimeData()
    data.setUrls(
        [
            QUrl(u)
            for u in (
                "file:///x/a.BVH",
                "file:///x/notes.txt",
                "file:///x/folder",
                "https://example.org/b.glb",
            )
        ]
    )
    assert load_of(data).files == ("/x/a.BVH", "/x/folder")


def test_a_chip_on_another_merges_them_and_elsewhere_does_nothing(toy, project):
    rest, up = toy.id(project, "rest"), toy.id(project, "up")
    drop = merge_at(project, rest, GraphHit("chip", up))
    gone = "; this removes 2 transitions between them"
    assert (drop.possible, drop.stance, drop.words) == (True, up, f"merge *rest* into *up*{gone}")
    far = toy.id(project, "far")
    assert merge_at(project, rest, GraphHit("chip", far)).words == "merge *rest* into *far*"
    one = edits.remove_actions(project, [toy.id(project, "up to rest")])
    assert merge_at(one, rest, GraphHit("chip", up)).words.endswith("removes the transition between them")
    for hit in (GraphHit("chip", rest), GraphHit("node", None, "gesture"), GraphHit("nothing")):
        assert not merge_at(project, rest, hit).possible


@pytest.mark.nightly
@pytest.mark.window
@pytest.mark.gl
def test_a_stance_dragged_onto_another_is_merged_in_one_step_and_from_its_menu_too(toys):
    from app.features.graph.graph_menus import make_menu_for

    drive = toys
    far, up, rest = (drive.id(name) for name in ("far", "up", "rest"))
    drive.session.place.set_stance(rest)
    drive.pause(100)
    steps = drive.document.undo_stack.count()
    stances = lambda: drive.document.project.graphs["arms"].stances  # noqa: E731
    drive.drag(drive.chip(far), drive.chip(up), lambda: far not in stances())
    assert drive.document.undo_stack.count() == steps + 1 and drive.session.place.stance() == up
    assert drive.canvas.arrow is None and drive.canvas.drop is None
    drive.document.undo()
    assert list(stances()) == [rest, up, far]
    menu = make_menu_for(drive.canvas.acts, GraphHit("chip", far), [])
    merge = next(a.menu() for a in menu.actions() if a.text() == "Merge into")
    assert [a.text() for a in merge.actions()] == ["rest", "up"]
    merge.actions()[0].trigger()
    assert list(stances()) == [rest, up] and drive.session.place.stance() == rest
    menu.close()
