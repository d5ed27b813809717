"""Every text that is marked has its German, with the same places for values, and the window shows it."""

from __future__ import annotations

import ast
import re
import string
from collections import Counter
from collections.abc import Collection, Iterator
from dataclasses import replace
from functools import cache
from html import escape
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import metagraph
from app import translation
from app.features.labelling import review_words
from app.look.plural import many
from app.translation import tr, tr_error, tr_told
from metagraph.common.wording import Told, told
from metagraph.engines.targets import registry
from metagraph.errors import FileError
from metagraph.formats import import_words
from metagraph.formats.clip_readers import clip_suffixes
from metagraph.formats.conversations.files import read_conversation
from metagraph.formats.imports import import_files
from metagraph.formats.store import open_project
from metagraph.graph import edits
from metagraph.graph.check import check
from metagraph.graph.edit_error import EditError
from metagraph.graph.model import Project
from metagraph.suggest.details import timed
from metagraph.suggest.propose import propose
from tests.speech import talk

APP = Path(translation.__file__).parent
DOMAIN = Path(metagraph.__file__).parent
SAMPLES = APP.parent / "sample_clips"
OTHERS = sorted(set(translation.NAMES) - {translation.ENGLISH})


def templates() -> Iterator[tuple[str, str, set[str]]]:
    """Yield where, what, and the names of values, for each template of `metagraph.common.wording`."""
    for path in sorted(
        p for folder in (DOMAIN, DOMAIN.parent / "preview", APP) for p in folder.rglob("*.py")
    ):
        source = path.read_text(encoding="utf-8")
        if not re.search(r"^from metagraph\.common\.wording import .*\btold\b", source, re.MULTILINE):
            continue
        for node in ast.walk(ast.parse(source)):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "told":
                first = node.args[0]
                for text in (first.body, first.orelse) if isinstance(first, ast.IfExp) else (first,):
                    if isinstance(text, ast.Constant):
                        where = f"{path.relative_to(DOMAIN.parent)}:{node.lineno}"
                        yield where, str(text.value), {str(k.arg) for k in node.keywords}


def marked() -> Iterator[tuple[str, str, set[str]]]:
    """Yield where, what, and the names of values, for each text in `tr`, `tr_noop` and `many`, and each of the
    domain's.
    """
    yield from templates()
    for path in sorted(APP.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if (
                not isinstance(node, ast.Call)
                or not isinstance(node.func, ast.Name)
                or path.name == "translation.py"
            ):
                continue
            where = f"{path.relative_to(APP)}:{node.lineno}"
            if node.func.id in ("tr", "tr_noop"):
                text = node.args[0]
                if isinstance(text, ast.Constant):
                    yield where, str(text.value), {str(k.arg) for k in node.keywords}
            elif node.func.id == "many" and isinstance(noun := node.args[1], ast.Constant):
                yield where, f"{{count:,}} {noun.value}", {"count"}
                yield where, f"{{count:,}} {noun.value}s", {"count"}


@cache
def texts() -> frozenset[str]:
    return frozenset(text for _, text, _ in marked())


def places(text: str) -> set[str]:
    return {name for _, name, _, _ in string.Formatter().parse(text) if name is not None}


@pytest.fixture
def english() -> Iterator[None]:
    yield
    translation.choose("en")


def test_values_are_those_of_the_text() -> None:
    for where, text, values in marked():
        if values:
            assert places(text) == values, where


@pytest.mark.parametrize("code", OTHERS)
def test_a_language_has_every_text_and_none_that_is_gone(code: str) -> None:
    words = translation.words_of(code)
    missing = sorted(texts() - words.keys())
    assert not missing, f"{len(missing)} texts without {code}: {missing[:5]}"
    assert not sorted(words.keys() - texts())


@pytest.mark.parametrize("code", OTHERS)
def test_a_translation_has_the_same_values_marks_and_keys(code: str) -> None:
    valued = {text for _, text, values in marked() if values}
    for text, other in translation.words_of(code).items():
        if text in valued:
            assert places(other) == places(text), text
        assert text.count("…") == other.count("…"), text
        assert (
            other.strip()
            and (text[:1] == " ") == (other[:1] == " ")
            and (text[-1:] == " ") == (other[-1:] == " ")
        ), text
        assert text.replace("&&", "").count("&") >= other.replace("&&", "").count("&"), text


def test_what_checks_find_is_said_in_the_language_and_stays_english_for_programs(
    english: None, toy: Any
) -> None:
    project = toy.project()
    project = edits.update_actions(project, [toy.id(project, "rest beat lf")], likelihood=-1.0)
    (found,) = [p for p in check(project) if p.code == "likelihood"]
    assert (
        tr_told(found.message)
        == found.message
        == "'rest beat lf' has the likelihood -1 and can never be chosen"
    )
    translation.choose("de")
    assert tr_told(found.message) == "'rest beat lf' hat die Häufigkeit -1 und kann nie gewählt werden"
    assert tr_told(found.remedy) == "Setze sie über 0."
    assert found.message == "'rest beat lf' has the likelihood -1 and can never be chosen"


def test_errors_are_said_in_the_language_as_far_as_they_know_their_templates(english: None) -> None:
    translation.choose("de")
    with pytest.raises(EditError) as caught:
        edits.rename_clip(Project(), "c1", "x")
    assert tr_error(caught.value) == "dieser Clip ist nicht mehr im Projekt"
    assert str(caught.value) == "that clip is no longer in the project"
    whole = FileError("some/a.bvh", told("nothing to mirror"), "line 3", told("Choose its states."))
    assert tr_error(whole) == "a.bvh, line 3: nichts zu spiegeln. Wähle seine Zustände."
    assert str(whole) == "a.bvh, line 3: nothing to mirror. Choose its states."
    plain = FileError("a.bvh", "it is odd")
    assert tr_error(plain) == str(plain) == "a.bvh: it is odd."
    assert tr_error(OSError(2, "No such file")) == "[Errno 2] No such file"
    assert tr("The character cannot be drawn: {error}", error=whole).endswith(": " + tr_error(whole))
    assert tr_error(ValueError()) == "" and tr_told("words of nobody") == "words of nobody"


def test_an_import_is_told_in_the_language_whatever_files_are_left_out(english: None, tmp_path: Path) -> None:
    (tmp_path / "bad.bvh").write_text("no motion")
    (tmp_path / "worse.glb").write_bytes(b"noise")
    result = import_files(Project(), tmp_path, [tmp_path])
    translation.choose("de")
    assert tr_told(import_words.said(result)) == (
        "0 Clips importiert. Weggelassen: 2 Dateien, die nicht zu brauchen sind"
    )
    lines = [tr_told(line) for line in import_words.counted(result.failures)]
    assert lines[0] == (
        "bad.bvh, ihre ersten Bytes: sie ist etwas anderes, nicht eine BVH-Datei. "
        f"Clips werden gelesen aus {', '.join(clip_suffixes())}."
    )
    assert lines[1].startswith("worse.glb, ihre ersten Bytes: sie ist ")
    assert import_words.said(result) == "Imported 0 clips. Left out: 2 files that cannot be used"


def test_what_targets_write_and_lose_is_said_in_the_language(english: None) -> None:
    translation.choose("de")
    words = translation.words_of("de")
    for target in registry.targets().values():
        for said in (target.files, target.group, target.untried, *(loss.words for loss in target.losses)):
            assert not said or (isinstance(said, Told) and said.template in words), f"{target.name}: {said}"
    (counted,) = [loss for loss in registry.target("scxml").losses if "with a seam" in loss.words]
    loops = replace(counted, count=lambda project: 3).told(Project())
    assert loops == "3 loops that play with a seam jump where they repeat"
    assert tr_told(loops) == "3 Schleifen, die mit einer Naht spielen, springen an der Wiederholung"


def without_words(said: str, known: Collection[str]) -> Iterator[str]:
    """Yield what of a text is in no language: words that know no template, and templates without words."""
    if not isinstance(said, Told):
        yield said
    elif said.template not in known and not re.fullmatch(r"({\w+}; )*{\w+}", said.template):
        yield said.template
    else:
        for value in said.values.values():
            if isinstance(value, Told):
                yield from without_words(value, known)


@pytest.mark.nightly
@pytest.mark.parametrize("name", ["sample", "practice"])
def test_why_clips_are_taken_for_what_they_are_is_said_in_the_language(english: None, name: str) -> None:
    project = open_project(SAMPLES / f"{name}.metagraph.yaml").project
    if name == "sample":  # as foreign takes come: by their motion alone, some that are none of the four
        clips = {c: replace(e, name=f"take {n}") for n, (c, e) in enumerate(project.clips.items())}
        project = Project(clips=clips, skeleton=project.skeleton)
    found = propose(project)
    every = timed(project, found.proposals).values()
    said = list(found.aside.values())
    said += [place.rest.reason for place in found.places.values() if place.rest is not None]
    for p in every:
        beliefs = (p.kind, p.layer, p.stance, p.end_stance, p.limb, *p.details.values())
        said += [belief.reason for belief in beliefs if belief is not None]
        said += [*p.conflicts, *([p.timing_reason] if p.timing_reason else [])]
    assert len(said) > 100
    odd = Counter(text for one in said for text in without_words(one, translation.words_of("de")))
    assert not odd
    translation.choose("de")
    assert all(tr_told(one) != one for one in said)
    for p in every:  # and so it is shown
        shown = review_words.timing(p, 9.0)
        beliefs = [p.details[name] for name in ("stroke", "likelihood") if name in p.details]
        assert beliefs and all(escape(tr_told(belief.reason)) in shown for belief in beliefs)


def test_what_came_of_recordings_is_said_in_the_language(english: None, tmp_path: Path) -> None:
    seconds = np.arange(3 * 16000) / 16000
    voice = 0.2 * np.sin(2 * np.pi * 130 * seconds) * (np.sin(2 * np.pi * 0.7 * seconds) > 0)
    talk.write_sound(tmp_path / "a.wav", np.array([voice, 0 * voice]), 16000)
    read = read_conversation([tmp_path / "a.wav"], [], tmp_path)
    translation.choose("de")
    assert read.notes[0].startswith("a.wav: the right channel is silent.")
    assert tr_told(read.notes[0]).startswith("a.wav: der Kanal rechts ist stumm.")
    assert all(isinstance(note, Told) and tr_told(note) != note for note in read.notes), read.notes


def test_what_was_said_is_known_in_english_for_logs(english: None) -> None:
    assert translation.in_english(tr("Set base pose")) == "Set base pose"
    translation.choose("de")
    german = tr("Duplicate {clips}", clips=many(3, "clip"))
    assert german != "Duplicate 3 clips" == translation.in_english(german)
    with pytest.raises(EditError) as caught:
        edits.rename_clip(Project(), "c1", "x")
    assert translation.in_english(tr_error(caught.value)) == "that clip is no longer in the project"
    assert translation.in_english("nobody said this") == "nobody said this"
    for n in range(translation.REMEMBERED + 10):
        tr("no such text {n}", n=n)
    assert len(translation._english) == translation.REMEMBERED, "it does not grow for ever"
    assert translation.in_english(german) == german


def test_what_a_language_lacks_is_english(english: None) -> None:
    translation.choose("de")
    assert translation.language() == "de"
    assert tr("no such text {n}", n=3) == "no such text 3"
    assert tr("braces {stay} as they are") == "braces {stay} as they are"
    translation.choose("xx")
    assert translation.language() == "en"


def test_the_environment_wins_over_the_settings(english: None, monkeypatch: pytest.MonkeyPatch) -> None:
    class Settings:
        def value(self, name: str, usual: str) -> str:
            assert name == "language"
            return "de"

    translation.choose_as_told(Settings())
    assert translation.language() == "de"
    monkeypatch.setenv("METAGRAPH_LANGUAGE", "en")
    translation.choose_as_told(Settings())
    assert translation.language() == "en"


def test_thousands_are_parted_by_a_space_where_a_comma_would_begin_the_parts_of_one(english: None) -> None:
    translation.choose("de")
    assert (
        many(3220, "connection") == "3\u202f220 Verbindungen"
        and many(220, "connection") == "220 Verbindungen"
    )
    assert translation.grouped(1234567) == "1\u202f234\u202f567"
    assert tr_told(told("{count:,} clips", count=1200)) == "1\u202f200 Clips"
    assert tr("{shown} clips", shown=1200) == "1200 clips"  # as it is asked for


def test_thousands_are_parted_by_a_comma_in_english() -> None:
    assert many(3220, "connection") == "3,220 connections" and translation.grouped(3220) == "3,220"
