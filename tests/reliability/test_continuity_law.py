"""The law of continuity over all motion there is: the sample, its conversation, generated motion, the label
zoo, and clips that others made.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.reliability import continuity_table as table

SECONDS = 30.0


@pytest.mark.nightly
@pytest.mark.parametrize("name", table.NAMES)
def test_nothing_moves_a_joint_beyond_what_the_clips_do(name: str, tmp_path: Path) -> None:
    try:
        row = dict(table.rows(tmp_path, SECONDS))[name]()
    except FileNotFoundError as error:
        pytest.skip(str(error))
    except RuntimeError as error:
        if "ufbx" not in str(error) and "nothing" not in str(error):
            raise
        pytest.skip(str(error))
    assert {stage: one for stage, one in row.items() if one.breaks} == {}
