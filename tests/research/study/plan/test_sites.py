"""Sites of one study taken together."""

from __future__ import annotations

from pathlib import Path

import pytest

from metagraph.errors import FileError
from metagraph.research.study.analysis.results import analyse_study
from metagraph.research.study.plan.sites import merge_site_data
from metagraph.research.study.report import format_study_page
from metagraph.research.study.reports.tables import tabulate_people
from metagraph.research.study.simulation.files import write_study
from metagraph.research.study.simulation.people import Truth
from metagraph.research.study.study_plan import FILE


@pytest.fixture(scope="module")
def folders(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    place = tmp_path_factory.mktemp("sites")
    out = []
    for n, (name, seconds) in enumerate((("Ulm", 40.0), ("Bonn", 60.0), ("Kiel", 50.0))):
        out.append(
            write_study(place / name, Truth(participants=6, ratio=2.3, seed=n + 1, seconds=seconds)).folder
        )
    return out


@pytest.mark.nightly
def test_people_are_told_apart_and_sites_are_a_random_effect(folders: list[Path]) -> None:
    data = merge_site_data(folders, jumps=False)
    assert len(data.participants) == 18 and data.participants[6] == "Bonn-P01"
    found = analyse_study(data)
    assert found.time is not None and found.time.ratio.n == 18 and found.time.ratio.holds(2.3)
    assert found.sensitivity is not None and found.sensitivity.mixed is not None
    assert {"sites", "people", "sites' ratios"} <= found.sensitivity.mixed.deviations.keys()
    assert found.by_site.keys() == {"Ulm", "Bonn", "Kiel"} and all(e.n == 6 for e in found.by_site.values())
    assert "<h3>Sites</h3>" in format_study_page(found)
    columns, rows = tabulate_people(found)
    assert columns[1] == "site" and rows[7][:2] == ("Bonn-P02", "Bonn")


@pytest.mark.nightly
def test_what_does_not_belong_together_is_refused_or_told(folders: list[Path], tmp_path: Path) -> None:
    with pytest.raises(FileError, match="'Ulm'"):
        merge_site_data([folders[0], folders[0]])
    text = (folders[0] / FILE).read_text()
    (tmp_path / FILE).write_text(text.replace("id: small", "id: tiny"))
    with pytest.raises(FileError, match="tasks or conditions"):
        merge_site_data([folders[0], tmp_path])
    (tmp_path / FILE).write_text(
        text.replace("questionnaires: [sus, tlx]", "questionnaires: [sus]\nsite: Jena")
    )
    told = merge_site_data([folders[0], tmp_path], jumps=False).missing
    assert any(words.startswith("Jena: questions") and words.endswith("not Ulm's.") for words in told)
    assert any(words == "Jena-P01: has not begun." for words in told)
