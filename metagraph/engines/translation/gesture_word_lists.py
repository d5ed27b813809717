"""The lexicons of gestures as a JavaScript module, with the small words of their languages."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

from metagraph.engines.translation.listing import RUNTIMES
from metagraph.speech.language_packs import languages
from metagraph.speech.text_gestures import gesture_words, known_languages
from metagraph.speech.word_gestures import GestureRule

PLACE = RUNTIMES / "javascript" / "gesture_words.js"
_HEAD = (
    "/**\n * Lexicons of gestures by language, as `word_gestures.js` has them, with words that say little by "
    "themselves.\n *\n * Made from metagraph/speech/gesture_words/*.json; change those, and translate anew.\n"
    " */\n\n"
)


def gesture_word_lists() -> dict[Path, str]:
    """Return the text of the module by its path."""
    parts = [f"  {code}: {_listed(code)},\n" for code in known_languages()]
    return {PLACE: f"{_HEAD}export const GESTURE_WORDS = {{\n{''.join(parts)}}};\n"}


def _listed(code: str) -> str:
    lexicon, pack = gesture_words(code), languages().get(code)
    rows = [
        ("rules", "[\n" + "".join(f"      {_rule(rule)},\n" for rule in lexicon.rules) + "    ]"),
        *((name, _rule(getattr(lexicon, name))) for name in ("question", "exclamation", "clause")),
        ("small", json.dumps(sorted(pack.small) if pack is not None else [], ensure_ascii=False)),
    ]
    return "{\n" + "".join(f"    {name}: {text},\n" for name, text in rows) + "  }"


def _rule(rule: GestureRule) -> str:
    told: dict[str, Any] = {k: v for k, v in asdict(rule).items() if v not in ((), "")}
    return json.dumps(told, ensure_ascii=False)
