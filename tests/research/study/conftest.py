"""A tiny study on clips of ours."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

CLIPS = Path(__file__).resolve().parents[3] / "sample_clips" / "clips"
TINY = """\
study: 1
title: A tiny study
participants: 4
seed: 3
conditions: [meta, manual]
consent: You take part of your own free will.
training:
- {condition: meta, instructions: Drop a clip., clips: [CLIPS/head_straight__stance.glb]}
- {condition: manual, instructions: Draw a state., clips: [CLIPS/head_straight__stance.glb]}
tasks:
- id: nods
  title: Two nods
  instructions: Wire all clips.
  clips: [CLIPS/head_straight__stance.glb, CLIPS/head_straight__nod_single_01.glb, CLIPS/head_straight__nod_double_01.glb]
  minutes: 5
breaks: 1
questionnaires: [sus, {id: more, when: after_study, items: [{id: words, text: "What else?", words: true}]}]
thanks: That was all.
"""


def tiny_text(folder: Path) -> str:
    """The study file's text, for a study in that folder."""
    return TINY.replace("CLIPS", Path(os.path.relpath(CLIPS, folder.resolve())).as_posix())


@pytest.fixture
def tiny(tmp_path: Path) -> Path:
    """The study file of a tiny study."""
    path = tmp_path / "study.yaml"
    path.write_text(tiny_text(tmp_path), encoding="utf-8")
    return path
