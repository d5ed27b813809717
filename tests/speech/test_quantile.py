"""Percentiles without masked arrays are NumPy's."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from metagraph.speech.quantile import compute_percentile

ROOT = Path(__file__).resolve().parents[2]


@given(
    arrays(np.float64, st.integers(1, 200), elements=st.floats(-1e6, 1e6)),
    st.one_of(st.floats(0, 100), st.sampled_from([0, 3, 8, 10, 20, 50, 90, 97, 99.5, 100])),
)
def test_a_percentile_is_numpys_to_the_bit(values, share):
    # A sum with 0 has no sign of zero: -0 and 0 are the same level.
    assert (compute_percentile(values, share) + 0.0).hex() == (
        float(np.percentile(values, share)) + 0.0
    ).hex()


def test_many_values_as_they_are_heard_are_numpys_to_the_bit():
    random = np.random.default_rng(4)
    for count in (1, 2, 3, 50, 997, 5000):
        values = 10 * np.log10(random.random(count) + 1e-12)
        for share in (8, 10, 20, 90, 97):
            assert compute_percentile(values, share) == float(np.percentile(values, share))


def test_what_is_no_number_makes_none_and_other_kinds_are_left_to_numpy():
    assert np.isnan(compute_percentile(np.array([1.0, np.nan, 2.0]), 50))
    some = np.arange(5, dtype=np.float32)
    assert compute_percentile(some, 30) == float(np.percentile(some, 30))
    with pytest.raises(IndexError):
        compute_percentile(np.zeros(0), 50)
    with pytest.raises(ValueError, match="range"):
        compute_percentile(np.zeros(3), 101)


def test_hearing_a_line_imports_no_masked_arrays():
    code = (
        "import sys\n"
        "from metagraph.speech.lines import read_line_voice\n"
        "read_line_voice('sample_clips/lines/hello.flac')\n"
        "print('numpy.ma' in sys.modules)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=120, check=True
    )
    assert done.stdout.split() == ["False"]
