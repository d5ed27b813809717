"""What is said in ten languages, and in some there are no lists of: responses, hesitations and clauses."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from metagraph.formats.conversations.files import Read, read_conversation
from metagraph.formats.conversations.languages import Speaking
from metagraph.graph.conversation.model import Segment, Word
from metagraph.speech.clauses import find_segments, find_segments_by_sound
from metagraph.speech.language_packs import LanguagePack, list_language_packs
from metagraph.speech.pitch import Pitch
from metagraph.speech.sound import HeardSound, analyse_sound
from tests.speech import talk
from tests.speech.dialogues import MIXED, OTHERS, TALKS, Score, Written, spoken, written

VOICES = {
    "en": "en-us",
    "de": "de",
    "fr": "fr-fr",
    "es": "es",
    "pt": "pt",
    "ja": "ja",
    "zh": "cmn",
    "hi": "hi",
}


def silence(seconds: float) -> tuple[Pitch, HeardSound]:
    heard = analyse_sound(0.001 * np.random.default_rng(0).standard_normal(round(16000 * seconds)), 16000)
    return Pitch(heard.times, np.full(len(heard.times), np.nan)), heard


def kinds(text: str, code: str) -> list[tuple[str, str]]:
    """Words of 0.25 s; a number is a pause of so many seconds."""
    out, at = [], 0.5
    for piece in text.split():
        if piece.replace(".", "", 1).isdigit():
            at += float(piece)
            continue
        out.append(Word(text=piece, start=round(at, 3), end=round(at + 0.25, 3)))
        at += 0.25
    found = find_segments(out, *silence(at + 1), language=list_language_packs()[code])
    return [(s.kind, s.text) for s in found]


def scored(text: str, language: LanguagePack, form: str = "NFC", letters: bool = False) -> Score:
    of, score = written(text, form, letters), Score()
    noise = silence(of.length + 1)
    for side in (0, 1):
        score.add(of, side, find_segments(of.words[side], *noise, language=language))
    return score


@pytest.mark.parametrize("code", TALKS)
@pytest.mark.parametrize("form", ["NFC", "NFD"])
def test_responses_and_hesitations_are_found_and_nothing_else(code: str, form: str) -> None:
    got = scored(TALKS[code], list_language_packs()[code], form)
    assert (got.found_responses, got.found_hesitations) == (got.responses, got.hesitations)
    assert (got.false_responses, got.false_hesitations) == (0, 0)


@pytest.mark.parametrize("code", ["ja", "zh"])
def test_letters_one_by_one_are_read_as_words_are(code: str) -> None:
    got = scored(TALKS[code], list_language_packs()[code], letters=True)
    assert (got.found_responses, got.found_hesitations) == (got.responses, got.hesitations)
    assert (got.false_responses, got.false_hesitations) == (0, 0)


@pytest.mark.parametrize("name", MIXED)
def test_who_borrows_english_answers_is_understood(name: str) -> None:
    code, text = MIXED[name]
    got = scored(text, list_language_packs()[code])
    assert got.found_responses >= got.responses - 1 and got.found_hesitations == got.hesitations
    assert (got.false_responses, got.false_hesitations) == (0, 0)


def test_german_er_and_um_are_words() -> None:
    assert kinds("er kommt um acht", "de") == [("clause", "er kommt um acht")]
    assert ("hesitation", "um") in kinds("he went um back home", "en")


@pytest.mark.parametrize(
    ("code", "text", "whole"),
    [
        ("fr", "hier matin j'ai rencontré par hasard tout le monde au grand marché couvert", "le monde"),
        (
            "de",
            "gestern hat mein alter Nachbar ganz plötzlich die Wohnung in der Stadt verkauft",
            "die Wohnung",
        ),
        (
            "it",
            "ieri mattina abbiamo incontrato la signora Rossi davanti alla stazione centrale",
            "la signora",
        ),
        ("nl", "gisteren hebben wij eindelijk de nieuwe buren van het huis ernaast gesproken", "het huis"),
    ],
)
def test_no_clause_ends_with_an_article(code: str, text: str, whole: str) -> None:
    found = [t for _, t in kinds(text, code)]
    assert len(found) > 1 and any(whole in t for t in found), found


@pytest.mark.parametrize(
    ("code", "text", "kind"),
    [
        ("zh", "我 问 他 1 嗯 1 他 不 说", "hesitation"),  # speaks before and after
        ("zh", "嗯 0.5 我 不 知道", "hesitation"),  # goes on
        ("zh", "嗯 4 我 不 知道", "response"),
        ("fr", "mh 4 je ne sais pas", "response"),
        ("nl", "nou ja 0.5 ik weet het niet", "hesitation"),
        ("pt", "é 4 não sei", "response"),
    ],
)
def test_what_is_both_hesitates_where_one_goes_on(code: str, text: str, kind: str) -> None:
    said = next(p for p in text.split() if p in ("嗯", "mh", "nou", "é"))
    assert next(k for k, t in kinds(text, code) if said in t.split()) == kind


def test_words_with_a_meaning_hesitate_only_where_speech_stops_or_when_drawn_out() -> None:
    assert all(k == "clause" for k, _ in kinds("あの 人 は 学生 です", "ja"))
    assert ("hesitation", "あのー") in kinds("昨日 あのー 人 が 来た", "ja")
    assert ("hesitation", "その") in kinds("昨日 その 0.5 人 が 来た", "ja")
    assert all(k == "clause" for k, _ in kinds("wir sind also gegangen", "de"))


def test_without_a_language_words_of_one_channel_are_parted_by_pauses() -> None:
    of = written(OTHERS["Swedish"])
    found = find_segments_by_sound(of.words[0], *silence(of.length + 1), None)
    assert found and all(s.kind == "clause" for s in found)
    assert " ".join(s.text for s in found) == " ".join(w.text for w in of.words[0])


# --- as they sound


def read(folder: Path, text: str, voice: str, speaking: Speaking | None = None) -> tuple[Read, Written]:
    samples, of = spoken(text, voice)
    talk.write_sound(folder / "talk.wav", samples, talk.RATE)
    rows = [
        {"word": w.text, "start": w.start, "end": w.end, "speaker": f"S{side}"}
        for side in (0, 1)
        for w in of.words[side]
    ]
    (folder / "talk.json").write_text(json.dumps({"words": sorted(rows, key=lambda r: float(r["start"]))}))
    return read_conversation([folder / "talk.wav"], [folder / "talk.json"], folder, speaking=speaking), of


@pytest.mark.nightly
@pytest.mark.parametrize("code", VOICES)
def test_a_spoken_conversation_is_read_in_its_language(code: str, tmp_path: Path) -> None:
    got, of = read(tmp_path, TALKS[code], VOICES[code])
    score = Score()
    for side in (0, 1):
        one = got.conversation.sides[side]
        assert one.language == code and one.responses is None
        score.add(of, side, one.segments)
        assert all(a.end <= b.start for a, b in zip(one.segments, one.segments[1:], strict=False))
    assert (score.found_responses, score.found_hesitations) == (score.responses, score.hesitations)
    assert (score.false_responses, score.false_hesitations) == (0, 0)
    assert got.conversation.responses == list_language_packs()[code].responses
    clauses = [s for side in got.conversation.sides for s in side.segments if s.kind == "clause"]
    assert 0.6 <= float(np.mean([s.end - s.start for s in clauses])) <= 2.5
    told = [n for n in got.notes if "Both speak" in n]
    assert len(told) == (code != "en") and len(got.notes) == len(told)


@pytest.mark.nightly
def test_a_spoken_language_that_nobody_knows_is_told_by_sound(tmp_path: Path) -> None:
    got, of = read(tmp_path, OTHERS["Swedish"], "sv")
    assert any("no lists for the language" in n for n in got.notes)
    for n, side in enumerate(got.conversation.sides):
        kept: tuple[Segment, ...] = side.segments
        assert side.language == "und" and kept and not any(s.kind == "hesitation" for s in kept)
        assert sum(len(s.text.split()) for s in kept) >= 0.8 * len(of.words[n])
        assert all(s.peak is not None for s in kept if s.kind == "clause")
    chosen, _ = read(tmp_path, OTHERS["Swedish"], "sv", Speaking("de"))
    assert [s.language for s in chosen.conversation.sides] == ["de", "de"]
