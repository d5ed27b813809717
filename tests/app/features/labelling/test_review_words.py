"""What a review says beside its pictures."""

from __future__ import annotations

from app.features.labelling.review_words import describe_placing
from metagraph.suggest.accept import AcceptedProposals


def test_what_was_placed_too_and_what_was_not_placed_are_named(toy):
    project = toy.project()
    wave, yawn, rest = (
        next(i for i, entry in project.clips.items() if entry.name == name)
        for name in ("rest wave rt", "up yawn", "rest loop")
    )
    asked = [wave, yawn]
    assert describe_placing(AcceptedProposals(project, (wave, yawn), {}), asked) == ""
    told = describe_placing(AcceptedProposals(project, (rest, wave), {yawn: "nothing shows it"}), asked)
    assert "rest loop" in told and "up yawn" in told and "nothing shows it" in told
    assert "rest wave" not in told
