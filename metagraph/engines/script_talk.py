"""What texts become: sentences, words with their times, and the gestures that go with them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from metagraph.playback.life.alphabet import ALPHABET
from metagraph.playback.planning.hashing import Bits
from metagraph.speech import word_gestures
from metagraph.speech.language_packs import list_language_packs
from metagraph.speech.text_gestures import load_gesture_words
from metagraph.speech.word_gestures import GestureAsk, ToldWord, gesture_asks, proposed_for, sentence_end

# Language, text, seconds it takes if that is reported, and whether a synthesiser tells when its words come.
TEXTS: tuple[tuple[str, str, float | None, bool], ...] = (
    ("en", "Hello! I don't know. You could go there, but first we need a plan?\nNo.", None, False),
    ("en", "Yes, absolutely: it costs 3.5 times as much as the old one. It's huge", 9.0, False),
    ("en", "On the one hand it rains a lot; on the other hand we stay here, which is nice.", None, True),
    ("en", "no no no NO! never, never. i you i you ... ‘Really’? (No!)", None, True),
    ("de", "Grüß Gott, ÄPFEL schmecken großartig! Ich weiß nicht, ob es stimmt. Oder?", None, False),
    ("fr", "Bonjour ! Peut-être qu’il ne vient pas, ÉTÉ comme hiver. C’est énorme.", None, False),
    ("es", "¡Hola! ¿Cómo está usted? No sé; tal vez mañana, señor ÑANDÚ.", 6.25, False),
    ("en", "We walked along the river with some bread", None, False),
    ("en", "Then the others came along the river and we went home together that evening", None, False),
    ("en", "She left the keys under a pot near the door of the house", None, False),
    ("en", "It goes on, and on.  \n ", None, False),
    ("en", "No la la la la la la la la la no la la la la la la la la no la la la", None, True),
    ("en", "Listen to the waves and the rock o'", None, False),
    ("en", "First one line\nthen the “second”. (It ends.)\n\nThird 3.5", None, False),
    ("en", "ぁ a ヿ b ｦ c ﾝ d 㐀 e 豈 f 𠀀 g 가 h 힣 i ﾞa j. ぁぁヿヿ ｦｦﾝﾝ 가힣", None, False),
    ("en", "", None, False),
    ("en", "日本語です。はい！ no、 …?!", None, False),
)


EDGES = (10, 4)  # seeds whose draws for one of the texts lie just on either side of `PLAIN`


def list_talks() -> list[dict[str, Any]]:
    """Return texts with what comes of them, as plain data: for arms that can do all that a lexicon proposes,
    for those that only beat, and with a head that does not move.
    """
    out: list[dict[str, Any]] = []
    for n, (language, text, seconds, told) in enumerate(TEXTS):
        lexicon = load_gesture_words(language)
        every = (lexicon.question, lexicon.exclamation, lexicon.clause, *lexicon.rules)
        arms = ["beat"] if n % 4 == 3 else sorted({tag for rule in every for tag in rule.tags})
        words = word_gestures.words_of(ALPHABET, text)
        times = [[0.25 * k, 0.25 * k + 0.125] for k in range(len(words))][:-1] if told else []
        row: dict[str, Any] = {"language": language, "text": text, "seconds": seconds, "told": times}
        row |= {"seed": 0xFFFFFFFF - 3 * n, "at": 0.5 * n, "arms": arms, "head": n % 3 != 2}
        out.append({**row, **analyse_talk(row)})
        for seed in EDGES if text.startswith("She left") else ():
            out.append({**row, "seed": seed, **analyse_talk({**row, "seed": seed})})
    return out


def analyse_talk(row: Mapping[str, Any]) -> dict[str, Any]:
    """Return what comes of a text: "sentences", "words" (each its text, in small letters, start, end, the
    mark behind it) and "asks" (do, layer, tags, at, stroke, late).
    """
    pack = list_language_packs().get(row["language"])
    words = word_gestures.words_of(
        ALPHABET, row["text"], [ToldWord(start, end) for start, end in row["told"]], row["seconds"]
    )
    made = proposed_for(
        words,
        set(row["arms"]),
        row["head"],
        load_gesture_words(row["language"]),
        set(pack.small) if pack is not None else set(),
        Bits(row["seed"]),
    )
    return {
        "sentences": _sentences(ALPHABET.letters(row["text"])),
        "words": [[w.text, w.plain, _time(w.start), _time(w.end), w.mark] for w in words],
        "asks": [_ask(ask) for ask in gesture_asks(made, row["at"])],
    }


def _sentences(letters: Sequence[str]) -> list[str]:
    out: list[str] = []
    while (end := sentence_end(ALPHABET, letters, True)) > 0:
        out.append("".join(letters[:end]))
        letters = letters[end:]
    return out


def _ask(ask: GestureAsk) -> list[Any]:
    stroke = None if ask.stroke is None else _time(ask.stroke)
    return [ask.do, ask.layer, list(ask.tags), _time(ask.at), stroke, _time(ask.late)]


def _time(seconds: float) -> float:
    return round(float(seconds), 7)
