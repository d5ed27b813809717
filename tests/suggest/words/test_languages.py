"""Names in other languages than English: read as English ones are, in a batch that speaks them."""

from __future__ import annotations

import subprocess
import sys
import unicodedata
from dataclasses import fields
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.suggest.words.cut import Token, cut_tokens
from metagraph.suggest.words.defaults import DEFAULTS
from metagraph.suggest.words.files import LanguageFile, load_language_files
from metagraph.suggest.words.folded import fold_letters, list_romaji, list_spellings
from metagraph.suggest.words.languages import MARKS, list_word_languages
from metagraph.suggest.words.names import Patterns, learn_correction, read_names

Row = tuple[str, str | None, str | None, str | None]
SETS: dict[str, list[Row]] = {
    "german": [
        ("Stehen_Grundhaltung", "stance", "stehen", None),
        ("Sitzen_Ruhe_01", "stance", "sitzen", None),
        ("Sitzen_KopfSchuetteln_02", "gesture", "sitzen", None),
        ("sitzen_schüttelt_den_Kopf", "gesture", "sitzen", None),
        ("Stehen_Schulterzucken", "gesture", "stehen", None),
        ("Stehen_Gewichtsverlagerung", "fidget", "stehen", None),
        ("Sitzen_auf_die_Uhr_schauen", "fidget", "sitzen", None),
        ("SitzenZuStehen", "transition", "sitzen", "stehen"),
        ("vonStehenNachSitzen", "transition", "stehen", "sitzen"),
        ("Aufstehen", "transition", "sitzen", "stehen"),
        ("Gehen_Schleife", None, None, None),
    ],
    "french": [
        ("Debout_repos", "stance", "debout", None),
        ("Assis_attente", "stance", "assis", None),
        ("Assis_hausser_les_epaules", "gesture", "assis", None),
        ("Debout_hocher_la_tête", "gesture", "debout", None),
        ("Debout_regarder_l'heure", "fidget", "debout", None),
        ("DeboutVersAssis", "transition", "debout", "assis"),
        ("passage_assis_debout", "transition", "assis", "debout"),
        ("se_lever", "transition", "assis", "debout"),
        ("marche", None, None, None),
    ],
    "spanish": [
        ("De_pie_reposo", "stance", "de pie", None),
        ("Sentado_reposo", "stance", "sentado", None),
        ("De_pie_señalar_con_la_mano_izquierda", "gesture", "de pie", None),
        ("Sentado_negar_con_la_cabeza", "gesture", "sentado", None),
        ("Sentado_rascarse_la_cabeza", "fidget", "sentado", None),
        ("de_pie_a_sentado", "transition", "de pie", "sentado"),
        ("de_sentado_a_de_pie", "transition", "sentado", "de pie"),
        ("Caminar", None, None, None),
    ],
    "italian": [
        ("In_piedi_riposo", "stance", "in piedi", None),
        ("Seduto_riposo", "stance", "seduto", None),
        ("Seduto_annuire", "gesture", "seduto", None),
        ("In_piedi_alzata_di_spalle", "gesture", "in piedi", None),
        ("In_piedi_guarda_l'orologio", "fidget", "in piedi", None),
        ("da_seduto_a_in_piedi", "transition", "seduto", "in piedi"),
        ("Camminata", None, None, None),
    ],
    "portuguese": [
        ("Em_pé_repouso", "stance", "em pé", None),
        ("Sentado_repouso", "stance", "sentado", None),
        ("Sentado_encolher_os_ombros", "gesture", "sentado", None),
        ("Em_pe_apontar_direita", "gesture", "em pé", None),
        ("Sentado_coçar_a_cabeça", "fidget", "sentado", None),
        ("sentado_para_em_pé", "transition", "sentado", "em pé"),
        ("Caminhada", None, None, None),
    ],
    "japanese": [
        ("立ち_待機", "stance", "立ち", None),
        ("座り待機", "stance", "座り", None),
        ("座り_うなずく01", "gesture", "座り", None),
        ("立ち手を振る右", "gesture", "立ち", None),
        ("座り_ウナズキ", "gesture", "座り", None),
        ("座り_頭を掻く", "fidget", "座り", None),
        ("立ちから座りへ", "transition", "立ち", "座り"),
        ("座り→立ち", "transition", "座り", "立ち"),
        ("歩く", None, None, None),
    ],
    "romaji": [
        ("tachi_taiki", "stance", "tachi", None),
        ("suwari_taiki", "stance", "suwari", None),
        ("suwari_unazuku", "gesture", "suwari", None),
        ("TachiTeWoFuru", "gesture", "tachi", None),
        ("suwari_atama_wo_kaku", "fidget", "suwari", None),
        ("tachi_kara_suwari_e", "transition", "tachi", "suwari"),
        ("aruku", None, None, None),
    ],
    "chinese": [
        ("站立待机", "stance", "站立", None),
        ("坐姿_待机", "stance", "坐姿", None),
        ("坐姿点头０１", "gesture", "坐姿", None),
        ("站立_右手挥手", "gesture", "站立", None),
        ("站立_揮手", "gesture", "站立", None),
        ("坐姿_抖腿", "fidget", "坐姿", None),
        ("站立到坐姿", "transition", "站立", "坐姿"),
        ("从坐姿到站立", "transition", "坐姿", "站立"),
        ("走路", None, None, None),
    ],
    "pinyin": [
        ("zhanli_daiji", "stance", "zhanli", None),
        ("zuozi_daiji", "stance", "zuozi", None),
        ("zuozi_dian_tou", "gesture", "zuozi", None),
        ("ZhanliHuiShou", "gesture", "zhanli", None),
        ("zuozi_doutui", "fidget", "zuozi", None),
        ("ZhanliDaoZuozi", "transition", "zhanli", "zuozi"),
        ("zoulu", None, None, None),
    ],
    "dutch": [
        ("Staan_rust", "stance", "staan", None),
        ("Zitten_rust", "stance", "zitten", None),
        ("Zitten_knikken", "gesture", "zitten", None),
        ("Staan_schouders_ophalen", "gesture", "staan", None),
        ("Staan_gewicht_verplaatsen", "fidget", "staan", None),
        ("Zitten_keel_schrapen", "fidget", "zitten", None),
        ("StaanNaarZitten", "transition", "staan", "zitten"),
    ],
    "polish": [
        ("Siedząc_spoczynek", "stance", "siedząc", None),
        ("Stojąc_spoczynek", "stance", "stojąc", None),
        ("Siedzac_kiwniecie", "gesture", "siedząc", None),
        ("Stojąc_ziewanie", "fidget", "stojąc", None),
    ],
    "russian": [
        ("Сидя_ожидание", "stance", "сидя", None),
        ("Стоя_ожидание", "stance", "стоя", None),
        ("Сидя_кивок", "gesture", "сидя", None),
        ("СтояПожатьПлечами", "gesture", "стоя", None),
        ("Сидя_зевает", "fidget", "сидя", None),
    ],
    "korean": [
        ("앉기_대기", "stance", "앉기", None),
        ("서기_대기", "stance", "서기", None),
        ("앉기_끄덕이기", "gesture", "앉기", None),
        ("서기_손흔들기", "gesture", "서기", None),
        ("앉기_하품", "fidget", "앉기", None),
    ],
}  # fmt: skip


def told(names: list[str], name: str | None = None, patterns: Patterns | None = None) -> dict[str, Any]:
    guess = read_names(names, patterns)[name or names[0]]
    return {f.name: b.value for f in fields(guess) if (b := getattr(guess, f.name)) is not None}


@pytest.mark.parametrize("language", SETS)
def test_names_of_a_language_are_read_as_english_ones_are(language: str) -> None:
    rows = SETS[language]
    found = read_names([row[0] for row in rows])
    assert [
        (
            name,
            g.kind.value if g.kind else None,
            g.stance.value if g.kind and g.stance else None,
            g.end_stance.value if g.end_stance else None,
        )
        for name, g in found.items()
    ] == rows
    assert all(g.other is not None for g in found.values() if g.kind is None)


# --- edges


def test_one_name_alone_tells_its_language_by_a_word_that_is_no_english_one() -> None:
    assert told(["Schulterzucken"]) == {
        "kind": "gesture",
        "limb": "both",
        "layer": "arms",
        "tags": ("unsure",),
    }
    assert told(["点头"])["kind"] == "gesture" and "kind" not in told(["Hoppeln"])


def test_accents_umlauts_and_letters_taken_apart_do_not_matter() -> None:
    for word in ("kopfschütteln", "kopfschuetteln", "kopfschutteln", "KOPFSCHÜTTELN", "Kopf-Schütteln"):
        for form in ("NFC", "NFD"):
            assert told([unicodedata.normalize(form, f"Sitzen_{word}"), "Sitzen_Ruhe"])["layer"] == "head", (
                word
            )
    assert told(["座り_ｳﾅｽﾞｷ", "座り待機"])["kind"] == "gesture"
    assert told(["ｓｉｔ＿ｎｏｄ０２"]) | {"stance": ""} == told(["sit_nod02"]) | {"stance": ""}


def test_reasons_quote_names_as_they_are_written() -> None:
    found = read_names(["Sitzen_KopfSchütteln", "Sitzen_Ruhe", "Sitzen_zu_Stehen", "Stehen_Ruhe"])
    kind, way = found["Sitzen_KopfSchütteln"].kind, found["Sitzen_zu_Stehen"].kind
    assert kind is not None and kind.reason == "name says 'KopfSchütteln'"
    assert way is not None and way.reason == "name says 'zu_Stehen'"
    nod = read_names([unicodedata.normalize("NFD", "座り_うなずき２"), "座り待機"])
    said = [unicodedata.normalize("NFC", g.kind.reason) for g in nod.values() if g.kind is not None]
    assert said == ["name says 'うなずき'", "name says '待機'"]


def test_a_letter_that_is_a_word_of_spanish_still_tells_stances_apart() -> None:
    names = ["Sit_A", "Sit_B", "Sit_A_To_Sit_B", "Sit_A_Nod", "Sit_B_Nod"]
    assert (
        told(names, "Sit_A_To_Sit_B")["end_stance"] == "sit b"
        and told(names, "Sit_B_Nod")["stance"] == "sit b"
    )
    names = ["Sentado_A_reposo", "Sentado_B_reposo", "Sentado_A_asentir", "Sentado_B_asentir"]
    assert told(names, "Sentado_B_asentir")["stance"] == "sentado b"
    assert told(names, "Sentado_A_asentir")["kind"] == "gesture"


def test_english_words_keep_their_meaning_in_english_batches() -> None:
    assert told(["Die", "Die_Backwards", "Walk"])["other"] == "die"
    assert told(["idle_no", "idle", "idle_me", "idle_salute"])["kind"] == "gesture"
    assert told(["sit_you", "sit_idle", "sit_me"])["tags"] == ("you",)
    names = ["human_idle", "human_wave", "human_gross_motor", "human_main_menu"]
    assert told(names, "human_gross_motor").get("kind") != "fidget"


def test_articles_of_german_are_no_deaths() -> None:
    names = ["Stehen_Ruhe", "Stehen_zeigt_auf_die_Tuer", "Stehen_reibt_die_Haende", "Stehen_gähnt"]
    assert [g.kind.value if g.kind else None for g in read_names(names).values()] == [
        "stance", "gesture", "fidget", "fidget",
    ]  # fmt: skip


def test_batches_of_two_languages_are_read_in_both() -> None:
    names = ["Sitzen_Ruhe", "Sitzen_Nicken", "idle_nod", "idle_look_around", "Sitzen_wave", "Sitzen_gähnen"]
    assert [g.kind.value if g.kind else None for g in read_names(names).values()] == [
        "stance", "gesture", "gesture", "fidget", "gesture", "fidget",
    ]  # fmt: skip
    assert told([*names, "座り_うなずく"], "座り_うなずく")["kind"] == "gesture"


def test_zuo_is_sitting_where_a_name_begins_and_left_where_it_goes_on() -> None:
    names = ["zuo_daiji", "zuo_huishou_zuo", "zuo_diantou", "zhan_daiji", "zhan_dao_zuo"]
    assert told(names, "zuo_huishou_zuo")["limb"] == "left" and told(names, "zuo_diantou")["stance"] == "zuo"
    assert told(names, "zhan_dao_zuo")["end_stance"] == "zuo"


def test_letters_are_sides_where_both_stand_at_ends_and_none_counts() -> None:
    names = ["Seduto_riposo", "Seduto_saluto_S", "Seduto_indicare_D", "Seduto_indicare_S_02"]
    assert [told(names, n).get("limb") for n in names] == [None, "left", "right", "left"]
    names = ["Seduto_riposo", *(f"Seduto_saluto_{letter}" for letter in "ABCDS")]
    assert all(told(names, n).get("limb") is None for n in names)


def test_the_order_of_names_does_not_matter() -> None:
    names = [row[0] for rows in SETS.values() for row in rows]
    assert read_names(names) == read_names(names[::-1])


@settings(max_examples=60, deadline=None)
@given(st.lists(st.text("aöñçЖ座り待機へから→_ 0１'’́ｶﾞß가나", max_size=12), max_size=5))
def test_whatever_letters_names_have_they_are_read(names: list[str]) -> None:
    assert set(read_names(names)) == set(names)


# --- what users say


def test_words_of_a_language_are_changed_and_taken_away() -> None:
    names = ["Sitzen_Ruhe", "Sitzen_Nicken", "Sitzen_Schulterzucken"]
    mine = Patterns().with_pattern("kinds", "schulterzucken", "fidget")
    changed = told(names, names[2], mine)
    assert changed["kind"] == "fidget" and changed["limb"] == "both", "what was not changed holds"
    gone = (
        Patterns().with_pattern("synonyms", "schulterzucken", None).with_pattern("synonyms", "nicken", None)
    )
    assert told(names, names[2], gone).get("tags") is None
    assert told(names, names[1], gone).get("layer") != "head"
    assert (
        gone.with_pattern("synonyms", "nicken", "nod")
        .with_pattern("synonyms", "schulterzucken", "shrug")
        .changes["synonyms"]
        == {}
    )


def test_words_of_a_house_stand_for_english_ones() -> None:
    house = Patterns().with_pattern("synonyms", "blorp", "head shake")
    assert told(["idle_blorp", "idle"], patterns=house)["layer"] == "head"
    assert Patterns.from_json(house.to_json()) == house


def test_corrections_are_remembered_by_the_words_of_the_name() -> None:
    names = ["Sitzen_Ruhe", "Sitzen_Nicken", "Sitzen_nicken_02"]
    taught = learn_correction(Patterns(), "Sitzen_Nicken", "kind", "fidget", names)
    assert taught.learned["kind"] == {"nicken": {"fidget": 1}}
    assert told(names, "Sitzen_nicken_02", taught)["kind"] == "fidget"


# --- the words


@pytest.mark.parametrize("source", load_language_files().values(), ids=load_language_files())
def test_every_word_stands_for_words_that_mean_something(source: LanguageFile) -> None:
    known = {w for name, t in DEFAULTS.items() if name != "synonyms" for p in t for w in p.split()}
    known |= {"chest", "desk", "wall", "table", "bench", "side"}  # parts and places beside a word of posture
    for phrase, meaning in source.phrases.items():
        assert meaning in MARKS or known & set(meaning.replace("|", " ").split()), (phrase, meaning)


def test_letters_are_folded_and_keep_their_places() -> None:
    assert fold_letters("") == ("", (0,)) and fold_letters("Añ")[0] == "An"
    text = "e\u0301ß"
    assert fold_letters(text) == ("ess", (0, 2, 2, 3))
    assert list_spellings("schütteln") == {"schutteln", "schuetteln"}
    assert {"jesucha", "jesuchaa"} & list_romaji("じぇすちゃー") and "kitte" in list_romaji("きって")


def test_names_are_cut_where_writings_change() -> None:
    cut = [t.text for t in cut_tokens("座りPose０2うなずき_KopfSchütteln") if isinstance(t, Token)]
    assert cut == ["座り", "pose", "02", "うなずき", "kopf", "schutteln"]


def test_words_are_read_from_their_files_when_names_are_first_read() -> None:
    code = (
        "import sys; import metagraph.suggest.words.names; from metagraph.suggest.words import files; "
        "read = files.load_language_files, files.list_english_meanings; "
        "sys.exit(sum(each.cache_info().currsize for each in read))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False, timeout=300).returncode == 0


def test_the_languages_have_their_words() -> None:
    assert min(len(language.exact) for language in list_word_languages()) > 400
