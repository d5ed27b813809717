"""What several engines are tested with."""

from __future__ import annotations

from pathlib import Path

import pytest

from metagraph.graph.model import Project

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def sample_export(sample: Project, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder called sample: the sample project's export with its character, and vectors. Written once;
    tests change copies.
    """
    from metagraph.engines.export import export
    from metagraph.engines.vectors import write_vectors

    folder = tmp_path_factory.mktemp("exports") / "sample"
    write_vectors(export(sample, folder, character=ROOT / "sample_clips" / "mannequin.glb").json)
    return folder


@pytest.fixture(scope="session")
def single(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where folders with the vectors of single cases are made."""
    return tmp_path_factory.mktemp("single")
