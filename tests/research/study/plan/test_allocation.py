"""Concealed allocation: balanced, not to be foreseen, and open to anybody afterwards."""

from __future__ import annotations

import json
from collections import Counter
from itertools import islice
from pathlib import Path

import pytest

from metagraph.errors import FileError
from metagraph.research.study.plan import allocation
from metagraph.research.study.plan.allocation import (
    allocate,
    compute_commitment,
    draw_order_numbers,
    find_allocation_problems,
    prepare_allocation,
)
from metagraph.research.study.plan.drawn_orders import LOG, read_drawn_orders
from metagraph.research.study.sitting import Sitting
from metagraph.research.study.study_plan import read_study


@pytest.fixture
def concealed(tiny: Path):
    tiny.write_text(tiny.read_text() + "order: concealed\n")
    return read_study(tiny)


def test_without_a_secret_nobody_begins_and_the_remedy_is_told(concealed) -> None:
    with pytest.raises(FileError, match="study plan"):
        allocate(concealed, "P01")
    with pytest.raises(ValueError, match="concealed"):
        concealed.blocks("P01")
    with pytest.raises(ValueError, match="does not take part"):
        allocate(concealed, "stranger")


def test_blocks_are_balanced_and_of_sizes_that_nobody_knows() -> None:
    sizes = set()
    for seed in range(40):
        found = list(islice(draw_order_numbers(f"secret {seed}", 2), 40))
        assert sorted(found[:36]) != found[:36]
        ahead = 0
        for n in found:
            ahead += 1 if n % 2 else -1
            assert abs(ahead) <= 2, "never far from balance"
        sizes.add(tuple(n % 2 for n in found[:4]))
    assert len(sizes) >= 5, "many ways to begin"
    assert list(islice(draw_order_numbers("a", 2), 20)) == list(islice(draw_order_numbers("a", 2), 20))


def test_an_order_is_drawn_once_and_noted_and_followed(concealed) -> None:
    told = prepare_allocation(concealed)
    assert prepare_allocation(concealed) == told, "the secret stays"
    for who in ("P03", "P01", "P04", "P02"):
        Sitting(concealed, who).close()
    again = allocate(concealed, "P01")
    notes = [json.loads(line) for line in (concealed.folder / LOG).read_text().splitlines()]
    assert [n["participant"] for n in notes] == ["P03", "P01", "P04", "P02"]
    assert read_drawn_orders(concealed.folder)["P01"] == again == notes[1]["number"]
    assert Counter(n["order"][0] for n in notes)["meta"] in (1, 2, 3)
    for n in notes:
        assert [c for c, _ in concealed.blocks(n["participant"])] == n["order"]
    assert find_allocation_problems(concealed) == []
    assert compute_commitment((concealed.folder / allocation.SECRET).read_text().strip()) == told


def test_whoever_chose_is_found_out(concealed) -> None:
    prepare_allocation(concealed)
    for who in ("P01", "P02"):
        allocate(concealed, who)
    path = concealed.folder / LOG
    notes = [json.loads(line) for line in path.read_text().splitlines()]
    notes[1]["number"] += 1
    path.write_text("".join(json.dumps(n) + "\n" for n in notes) + "damaged\n")
    assert find_allocation_problems(concealed) and find_allocation_problems(concealed)[0].startswith(
        "P02 has order"
    )
    (concealed.folder / allocation.SECRET).unlink()
    assert "not there" in find_allocation_problems(concealed)[0]
