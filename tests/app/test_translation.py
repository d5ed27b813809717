"""Every text that is marked has its German, with the same places for values, and the window shows it."""

from __future__ import annotations

import io
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
from babel.messages.catalog import Catalog
from babel.messages.mofile import write_mo

from app import translation
from app.features.labelling import review_words
from app.languages.catalogues import Marked, collect_texts, find_marked, read_catalogue, write_catalogue
from app.look.domain_words import KIND_TITLES
from app.translation import FOLDER, format_number, tr, tr_context, tr_error, tr_phrase, tr_plural
from app.widgets.request_menu import describe_request
from app.widgets.vocabulary import get_vocabulary_word
from metagraph.common.wording import Phrase, phrase, plural_phrase
from metagraph.engines.targets import registry
from metagraph.errors import FileError
from metagraph.formats import import_words
from metagraph.formats.clip_readers import list_clip_suffixes
from metagraph.formats.conversations.files import read_conversation
from metagraph.formats.imports import import_files
from metagraph.formats.store import open_project
from metagraph.graph import edits, requests
from metagraph.graph.check import check_project
from metagraph.graph.edit_error import EditError
from metagraph.graph.model import Project
from metagraph.playback.timing.handles import BLOCKS
from metagraph.suggest.details import with_timing
from metagraph.suggest.propose import propose
from tests.app.catalogue_texts import catalogue_texts
from tests.speech import talk

SAMPLES = Path(translation.__file__).parent.parent / "sample_clips"
OTHERS = sorted(set(translation.NAMES) - {translation.ENGLISH})
COMPLETE = sorted(set(translation.COMPLETE) - {translation.ENGLISH})


@cache
def marked() -> tuple[Marked, ...]:
    return tuple(find_marked())


@cache
def catalogue(code: str) -> Catalog:
    return read_catalogue(FOLDER / code / "LC_MESSAGES" / "metagraph.po")


def places(text: str) -> set[str]:
    return {name for _, name, _, _ in string.Formatter().parse(text) if name is not None}


@pytest.fixture
def english() -> Iterator[None]:
    yield
    translation.choose("en")


@pytest.mark.nightly
def test_values_are_those_of_the_text() -> None:
    for one in marked():
        values = one.values | ({"count"} if len(one.texts) > 1 else set())
        for text in one.texts if values else ():
            assert places(text) <= values, one
        assert not values or set().union(*map(places, one.texts)) == values, one


@pytest.mark.parametrize("code", COMPLETE)
def test_a_language_has_every_text(code: str) -> None:
    missing = [m.id for m in catalogue(code) if m.id and (m.fuzzy or not all(texts_of(m.string)))]
    assert not missing, f"{len(missing)} texts without {code}, such as {missing[:5]}: edit its metagraph.po"


@pytest.mark.parametrize("code", OTHERS)
def test_the_catalogues_hold_the_texts_of_the_tree_and_are_compiled(code: str) -> None:
    remedy = "run python -m app.languages"
    texts = collect_texts(marked())
    assert {(m.id, m.context) for m in texts} == {(m.id, m.context) for m in catalogue(code)}, remedy
    compiled = io.BytesIO()
    write_mo(compiled, catalogue(code))
    file = FOLDER / code / "LC_MESSAGES" / "metagraph.mo"
    assert file.read_bytes() == compiled.getvalue(), remedy


def texts_of(string: Any) -> tuple[str, ...]:
    return string if isinstance(string, tuple) else (string,)


@pytest.mark.parametrize("code", OTHERS)
def test_a_translation_has_the_same_values_marks_and_keys(code: str) -> None:
    valued = {text for one in marked() if one.values or len(one.texts) > 1 for text in one.texts}
    for text, other in catalogue_texts(code).items():
        if not other:
            continue
        if text in valued:
            assert places(other) == places(text), text
        assert text.count("…") == other.count("…"), text
        assert (
            other.strip()
            and (text[:1] == " ") == (other[:1] == " ")
            and (text[-1:] == " ") == (other[-1:] == " ")
        ), text
        assert text.replace("&&", "").count("&") >= other.replace("&&", "").count("&"), text


def test_german_says_sie() -> None:
    familiar = re.compile(r"\b(du|dir|dich|dein|deine[mnrs]?)\b", re.IGNORECASE)
    asking = re.compile(
        r"(^|[.:;,>] ?|\bund |\boder )(wähle|lege|speichere|exportiere|prüfe|setze|füge|ziehe)\b", re.I
    )
    german = catalogue_texts("de").values()
    found = [text for text in german if familiar.search(text) or asking.search(text)]
    assert not found, "write 'Sie', 'Ihr', 'Wählen Sie'"


def test_each_text_stands_in_a_call_of_tr_where_it_is_collected() -> None:
    hidden = re.compile(r"partial\(\s*(tr|tr_plural|tr_noop|phrase)\b")
    root = FOLDER.parent.parent
    found = [path for folder in ("app", "metagraph", "preview") for path in (root / folder).rglob("*.py")]
    found = [path for path in found if hidden.search(path.read_text(encoding="utf-8"))]
    assert not found, 'write lambda: tr("..."), or no catalogue has the text'


def test_what_checks_find_is_said_in_the_language_and_stays_english_for_programs(
    english: None, toy: Any
) -> None:
    project = toy.project()
    project = edits.update_actions(project, [toy.id(project, "rest beat lf")], likelihood=-1.0)
    (found,) = [p for p in check_project(project) if p.code == "likelihood"]
    assert tr_phrase(found.message) == found.message == "'rest beat lf' has likelihood -1 and never plays"
    translation.choose("de")
    assert tr_phrase(found.message) == "„rest beat lf“ hat die Häufigkeit -1 und wird nie abgespielt"
    assert tr_phrase(found.remedy) == "Setzen Sie den Wert auf mehr als 0."
    assert found.message == "'rest beat lf' has likelihood -1 and never plays"


def test_errors_are_said_in_the_language_as_far_as_they_know_their_templates(english: None) -> None:
    translation.choose("de")
    with pytest.raises(EditError) as caught:
        edits.rename_clip(Project(), "c1", "x")
    assert tr_error(caught.value) == "dieser Clip ist nicht mehr im Projekt"
    assert str(caught.value) == "that clip is no longer in the project"
    whole = FileError("some/a.bvh", phrase("nothing to mirror"), "line 3", phrase("Choose its states."))
    assert tr_error(whole) == "a.bvh, line 3: nichts zu spiegeln. Wählen Sie seine Zustände."
    assert str(whole) == "a.bvh, line 3: nothing to mirror. Choose its states."
    plain = FileError("a.bvh", "it is odd")
    assert tr_error(plain) == str(plain) == "a.bvh: it is odd."
    assert tr_error(OSError(2, "No such file")) == "[Errno 2] No such file"
    assert tr("The character cannot be drawn: {error}", error=whole).endswith(": " + tr_error(whole))
    assert tr_error(ValueError()) == "" and tr_phrase("words of nobody") == "words of nobody"


def test_an_import_is_told_in_the_language_whatever_files_are_left_out(english: None, tmp_path: Path) -> None:
    (tmp_path / "bad.bvh").write_text("no motion")
    (tmp_path / "worse.glb").write_bytes(b"noise")
    result = import_files(Project(), tmp_path, [tmp_path])
    translation.choose("de")
    assert tr_phrase(import_words.describe_import(result)) == (
        "0 Clips importiert. Übersprungen: 2 unbrauchbare Dateien"
    )
    lines = [tr_phrase(line) for line in import_words.count_alike(result.failures)]
    assert lines[0] == (
        "bad.bvh, ihre ersten Bytes: sie ist eine Datei anderer Art, nicht eine BVH-Datei. "
        f"Clips werden aus {', '.join(list_clip_suffixes())} gelesen."
    )
    assert lines[1].startswith("worse.glb, ihre ersten Bytes: sie ist ")
    assert import_words.describe_import(result) == "Imported 0 clips. Skipped: 2 unusable files"


def test_what_targets_write_and_lose_is_said_in_the_language(english: None) -> None:
    translation.choose("de")
    words = catalogue_texts("de")
    for target in registry.list_targets().values():
        for said in (target.files, target.group, target.untried, *(loss.words for loss in target.losses)):
            assert not said or (isinstance(said, Phrase) and said.template in words), f"{target.name}: {said}"
    (counted,) = [loss for loss in registry.get_target("scxml").losses if "blend their seam" in loss.words]
    loops = replace(counted, count=lambda project: 3).told(Project())
    assert loops == "3 loops blend their seam here but jump at the seam there"
    assert tr_phrase(loops) == "3 Schleifen werden hier an ihrer Naht überblendet, springen dort aber"


def without_words(said: str, known: Collection[str]) -> Iterator[str]:
    """Yield what of a text is in no language: words that know no template, and templates without words."""
    if not isinstance(said, Phrase):
        yield said
    elif said.template not in known and not re.fullmatch(r"({\w+}; )*{\w+}", said.template):
        yield said.template
    else:
        for value in said.values.values():
            if isinstance(value, Phrase):
                yield from without_words(value, known)


@pytest.mark.nightly
@pytest.mark.parametrize("name", ["sample", "practice"])
def test_why_clips_are_taken_for_what_they_are_is_said_in_the_language(english: None, name: str) -> None:
    project = open_project(SAMPLES / f"{name}.metagraph.yaml").project
    if name == "sample":  # as foreign takes come: by their motion alone, some that are none of the four
        clips = {c: replace(e, name=f"take {n}") for n, (c, e) in enumerate(project.clips.items())}
        project = Project(clips=clips, skeleton=project.skeleton)
    found = propose(project)
    every = with_timing(project, found.proposals).values()
    said = list(found.aside.values())
    said += [place.rest.reason for place in found.places.values() if place.rest is not None]
    for p in every:
        beliefs = (p.kind, p.layer, p.stance, p.end_stance, p.limb, *p.details.values())
        said += [belief.reason for belief in beliefs if belief is not None]
        said += [*p.conflicts, *([p.timing_reason] if p.timing_reason else [])]
    assert len(said) > 100
    odd = Counter(text for one in said for text in without_words(one, catalogue_texts("de")))
    assert not odd
    translation.choose("de")
    assert all(tr_phrase(one) != one for one in said)
    for p in every:  # and so it is shown
        shown = review_words.describe_proposed_times(p, 9.0)
        beliefs = [p.details[name] for name in ("stroke", "likelihood") if name in p.details]
        assert beliefs and all(escape(tr_phrase(belief.reason)) in shown for belief in beliefs)


def test_what_came_of_recordings_is_said_in_the_language(english: None, tmp_path: Path) -> None:
    seconds = np.arange(3 * 16000) / 16000
    voice = 0.2 * np.sin(2 * np.pi * 130 * seconds) * (np.sin(2 * np.pi * 0.7 * seconds) > 0)
    talk.write_sound(tmp_path / "a.wav", np.array([voice, 0 * voice]), 16000)
    read = read_conversation([tmp_path / "a.wav"], [], tmp_path)
    translation.choose("de")
    assert read.notes[0].startswith("a.wav: the right channel is silent.")
    assert tr_phrase(read.notes[0]).startswith("a.wav: Der Kanal rechts ist stumm.")
    assert all(isinstance(note, Phrase) and tr_phrase(note) != note for note in read.notes), read.notes


def test_what_was_said_is_known_in_english_for_logs(english: None) -> None:
    assert translation.get_english(tr("Set base pose")) == "Set base pose"
    translation.choose("de")
    german = tr("Duplicate {clips}", clips=tr_plural("{count:,} clip", "{count:,} clips", 3))
    assert german != "Duplicate 3 clips" == translation.get_english(german)
    with pytest.raises(EditError) as caught:
        edits.rename_clip(Project(), "c1", "x")
    assert translation.get_english(tr_error(caught.value)) == "that clip is no longer in the project"
    assert translation.get_english("nobody said this") == "nobody said this"


def test_what_a_language_lacks_is_english(english: None) -> None:
    translation.choose("de")
    assert translation.get_language() == "de"
    assert tr("no such text {n}", n=3) == "no such text 3"
    assert tr("braces {stay} as they are") == "braces {stay} as they are"
    translation.choose("xx")
    assert translation.get_language() == "en"


def test_the_environment_wins_over_the_settings(english: None, monkeypatch: pytest.MonkeyPatch) -> None:
    class Settings:
        def value(self, name: str, usual: str) -> str:
            assert name == "language"
            return "de"

    translation.choose_language(Settings())
    assert translation.get_language() == "de"
    monkeypatch.setenv("METAGRAPH_LANGUAGE", "en")
    translation.choose_language(Settings())
    assert translation.get_language() == "en"


def connections(count: int) -> str:
    return tr_plural("{count:,} connection", "{count:,} connections", count)


def test_numbers_are_written_as_the_language_writes_them(english: None) -> None:
    assert connections(1) == "1 connection" and connections(3220) == "3,220 connections"
    assert translation.group_thousands(3220) == "3,220"
    translation.choose("de")
    assert connections(3220) == "3\u202f220 Verbindungen" and connections(1) == "1 Verbindung"
    assert translation.group_thousands(1234567) == "1\u202f234\u202f567"
    assert tr_phrase(plural_phrase("{count:,} clip", "{count:,} clips", 1200)) == "1\u202f200 Clips"
    assert tr("{shown} clips", shown=1200) == "1200 clips"  # as it is asked for
    assert tr("{seconds:.1f} s", seconds=np.float64(2.25)) == "2,2 s" and tr("{n}", n=0.5) == "0,5"
    assert tr("{flag}", flag=True) == "True"
    assert format_number(2.25, "+.2f") == "+2,25" and format_number(4.0, "g") == "4"


@pytest.mark.parametrize(
    ("count", "words"),
    [(1, "1 klip"), (2, "2 klipy"), (5, "5 klipów"), (22, "22 klipy"), (112, "112 klipów")],
)
def test_polish_has_three_plurals(english: None, count: int, words: str) -> None:
    translation.choose("pl")
    assert tr_plural("{count:,} clip", "{count:,} clips", count) == words
    assert tr_phrase(plural_phrase("{count:,} clip", "{count:,} clips", count)) == words


def test_the_same_word_can_mean_two_things(english: None, tmp_path: Path, monkeypatch: Any) -> None:
    made = Catalog(locale="de")
    made.add("Open", "Öffnen", context="button")
    made.add("Open", "Offen", context="mouth")
    write_catalogue(made, tmp_path / "de" / "LC_MESSAGES" / "metagraph.po")
    monkeypatch.setattr(translation, "FOLDER", tmp_path)
    assert tr_context("mouth", "Open") == "Open"
    translation.choose("de")
    assert (tr_context("button", "Open"), tr_context("mouth", "Open"), tr("Open")) == (
        "Öffnen",
        "Offen",
        "Open",
    )


def test_what_a_module_holds_follows_the_language(english: None) -> None:
    assert KIND_TITLES["gesture"] == "Gesture" and len(KIND_TITLES) == 4
    translation.choose("de")
    assert KIND_TITLES["gesture"] == "Geste" and dict(KIND_TITLES)["stance"] == "Haltung"


def test_looks_and_phases_are_said_in_the_language(english: None) -> None:
    looks = [requests.Look(to=to, at=0.0) for to in ("partner", "ahead", "door", (0.0, 1.0, 1.0))]
    assert [describe_request(look, Project()) for look in looks] == [
        "look at partner",
        "look ahead",
        "look at door",
        "look at a point",
    ]
    translation.choose("de")
    assert [describe_request(look, Project()) for look in looks] == [
        "Blick: Gegenüber",
        "Blick geradeaus",
        "Blick: door",
        "Blick: ein Punkt",
    ]
    assert [get_vocabulary_word(block) for block in BLOCKS] == [
        "Vorbereitung",
        "Höhepunkt",
        "Halten",
        "Rückzug",
    ]


@pytest.mark.parametrize(
    ("kept", "system", "chosen"),
    [
        ("", ["de-AT", "en"], "de"),
        ("", ["fr-FR", "de-CH"], "de"),
        ("", ["ja-JP"], "en"),
        ("", ["pl-PL", "en-GB"], "en"),  # its catalogue is not complete
        ("en", ["de-DE"], "en"),
        ("pl", ["de-DE"], "pl"),
        ("xx", [], "en"),
    ],
)
def test_the_language_follows_the_settings_then_the_system(
    english: None, kept: str, system: list[str], chosen: str
) -> None:
    class Settings:
        def value(self, name: str, usual: str) -> str:
            return kept or usual

    translation.choose_language(Settings(), system)
    assert translation.get_language() == chosen


def test_with_nothing_to_undo_no_colon_waits_for_words(english: None) -> None:
    from types import SimpleNamespace

    from app.features.files.file_commands import FileFeature

    def said(done: str, undone: str) -> tuple[str, str]:
        stack = SimpleNamespace(undoText=lambda: done, redoText=lambda: undone)
        feature = SimpleNamespace(undo_stack=stack)
        return FileFeature.undo_text(feature), FileFeature.redo_text(feature)

    assert said("", "") == ("&Undo", "&Redo")
    translation.choose("de")
    assert said("", "") == ("&Rückgängig", "&Wiederholen")
    assert said("Umbenennen", "Laden") == ("&Rückgängig: Umbenennen", "&Wiederholen: Laden")


def test_what_reading_repaired_is_said_in_the_language(english: None) -> None:
    import pickle

    from metagraph.formats.takes import repair_note, take_repair

    _, repair = take_repair("mixamo.com", "walk", "walk", ())
    assert repair is not None and repair.words == "named after its file instead of 'mixamo.com'"
    translation.choose("de")
    assert tr_phrase(repair.words) == "nach der Datei benannt statt „mixamo.com“"
    sent = pickle.loads(pickle.dumps(repair))  # files are read in processes of their own
    assert tr_phrase(repair_note(sent)) == "nach der Datei benannt statt „mixamo.com“"
