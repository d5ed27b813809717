"""Tags that the folders of clips give."""

from __future__ import annotations

import pytest

from metagraph.suggest.estimate import Belief
from metagraph.suggest.folder_tags import SURE, join_tags, read_folder_tags


def tags(*paths: str) -> list[tuple[str, ...]]:
    found = read_folder_tags({str(n): path for n, path in enumerate(paths)})
    return [found[str(n)].value if str(n) in found else () for n in range(len(paths))]


def test_folders_beside_each_other_are_tags_with_what_their_names_mean() -> None:
    assert tags("set/happy/wave.bvh", "set/sad/wave.bvh") == [("happy", "positive"), ("sad", "negative")]
    assert tags("Angry_Man/nod.glb", "calm/nod.glb") == [("angry man", "negative"), ("calm",)]


def test_folders_within_folders_are_tags_too() -> None:
    found = tags("a/happy/kitchen/x.bvh", "a/happy/office/x.bvh", "a/sad/office/x.bvh")
    assert found == [("happy", "positive", "kitchen"), ("happy", "positive", "office"), ("sad", "negative")]
    takes = {"0": "happy/take1/a.bvh", "1": "happy/take2/a.bvh", "2": "sad/take1/a.bvh"}
    read = read_folder_tags(takes)
    assert read["0"].value == ("happy", "positive") and read["0"].reason == "its folder is 'happy'"


def test_before_a_project_is_saved_folders_give_tags_only_where_their_names_mean_something() -> None:
    found = tags("/home/anna/happy/wave.bvh", "/home/anna/sad/wave.bvh", "/home/anna/kitchen/nod.bvh")
    assert found == [("happy", "positive"), ("sad", "negative"), ()]


@pytest.mark.parametrize(
    "paths",
    [
        ["wave.bvh", "nod.bvh"],
        ["happy/wave.bvh", "happy/nod.bvh"],
        ["bvh/wave.bvh", "fbx/nod.fbx"],
        ["01/wave.bvh", "02/wave.bvh"],
        ["/home/anna/wave.bvh", "/data/wave.bvh"],
        [],
    ],
)
def test_one_folder_kinds_of_files_and_numbers_are_no_tags(paths: list[str]) -> None:
    assert tags(*paths) == [()] * len(paths)


def test_tags_of_a_name_and_of_a_folder_are_joined() -> None:
    name, folder = Belief(("greeting",), 0.9, "a"), Belief(("happy", "greeting"), SURE, "b")
    joined = join_tags(name, folder)
    assert joined is not None and joined.value == ("greeting", "happy") and joined.confidence == SURE
    assert (
        join_tags(None, folder) is folder and join_tags(name, None) is name and join_tags(None, None) is None
    )
