"""Sizes and names of weights."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

from metagraph.generation.initial import make_initial_weights
from metagraph.generation.networks import (
    Control,
    FlowSizes,
    MatchingSizes,
    count_parameters,
    list_weight_shapes,
    make_sizes,
)


@pytest.mark.parametrize(
    ("kind", "millions"), [("flow-vae", 31.53), ("moglow", 180.30), ("cvae", 3.04), ("matching", 0.672)]
)
def test_the_papers_sizes_have_as_many_numbers_as_counted(kind, millions):
    assert count_parameters(make_sizes(kind, "paper", 54)) / 1e6 == pytest.approx(millions, abs=0.005)


def test_the_papers_control_has_1231_numbers():
    assert Control(kind="window").context(54) == 1231


@pytest.mark.parametrize("kind", ["flow-vae", "moglow", "cvae", "matching"])
def test_weights_begin_with_the_names_and_shapes_that_are_said(kind):
    sizes = make_sizes(kind, "small", 78)
    weights = make_initial_weights(sizes)
    assert {n: w.shape for n, w in weights.items()} == list_weight_shapes(sizes)
    assert list(weights) == list(list_weight_shapes(sizes))
    assert all(w.dtype == np.float32 and np.isfinite(w).all() for w in weights.values())
    again = make_initial_weights(sizes)
    assert all((again[n] == w).all() for n, w in weights.items())
    assert any((make_initial_weights(sizes, 2)[n] != w).any() for n, w in weights.items())


@pytest.mark.parametrize("joints", [1, 3, 10])
def test_few_joints_have_sizes_too(joints):
    for kind in ("flow-vae", "moglow", "cvae", "matching"):
        assert count_parameters(make_sizes(kind, "small", 6 * joints)) > 0


def test_sizes_that_cannot_be_are_told():
    with pytest.raises(ValueError, match=r"7 frames.*31"):
        Control(dilations=(1, 2))
    with pytest.raises(ValueError, match="on 78 numbers, not on 35"):
        FlowSizes(code="none", dims=35)
    with pytest.raises(ValueError, match="5 heads"):
        MatchingSizes(heads=5)
    with pytest.raises(ValueError, match="24 numbers have no 32 components"):
        MatchingSizes(pose=6)


@pytest.mark.nightly
def test_using_models_brings_in_no_torch():
    """Nor Qt: what is imported is counted in a process of its own."""
    code = (
        "import importlib, pkgutil, sys, metagraph.generation as g\n"
        "for m in pkgutil.iter_modules(g.__path__):\n"
        "    if m.name != 'training': importlib.import_module('metagraph.generation.' + m.name)\n"
        "print([m for m in ('torch', 'PySide6', 'moderngl', 'onnxruntime') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_a_flow_vae_is_on_pieces_of_motion_unless_it_is_the_published_one():
    ours, published, whole = (
        make_sizes("flow-vae"),
        make_sizes("flow-vae", as_published=True),
        make_sizes("flow-vae", "paper"),
    )
    assert (ours.span, ours.guess, ours.before) == (16, True, 32)
    assert (published.span, published.guess, published.before) == (1, False, 5)
    assert (whole.span, whole.guess) == (1, False)
    assert ours.code == published.code == whole.code == "variational"


def test_a_guess_needs_something_to_go_on_from():
    with pytest.raises(ValueError, match="nothing to guess from"):
        FlowSizes(control=Control(past=0), guess=True)
