"""The lexicons of gestures as data in the languages of the engines, with words that say little."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

from metagraph.engines.translation.listing import RUNTIMES
from metagraph.speech.language_packs import list_language_packs
from metagraph.speech.text_gestures import list_lexicon_languages, load_gesture_words
from metagraph.speech.word_gestures import GestureRule

JAVASCRIPT = RUNTIMES / "javascript" / "gesture_words.js"
GODOT = RUNTIMES / "godot" / "addons" / "metagraph" / "core" / "gesture_words.gd"
UNITY = RUNTIMES / "unity" / "Runtime" / "Core" / "GestureWordLists.cs"
CPP = RUNTIMES / "cpp" / "gesture_word_lists.hpp"
_ABOUT = "Lexicons of gestures by language, as {} has them, with words that say little by themselves."
_MADE = "Made from metagraph/speech/gesture_words/*.json; change those, and translate anew."


def make_gesture_word_modules() -> dict[Path, str]:
    """Return the texts of the modules by their paths."""
    return {JAVASCRIPT: _javascript(), GODOT: _gdscript(), UNITY: _csharp(), CPP: _cpp()}


def _javascript() -> str:
    head = f"/**\n * {_ABOUT.format('`word_gestures.js`')}\n *\n * {_MADE}\n */\n\n"
    parts = [f"  {code}: {{\n{_fields(code, 4, '{}: {}')}  }},\n" for code in list_lexicon_languages()]
    return f"{head}export const GESTURE_WORDS = {{\n{''.join(parts)}}};\n"


def _gdscript() -> str:
    head = f"# {_ABOUT.format('word_gestures.gd')}\n#\n# {_MADE}\n\n"
    texts = {code: _fields(code, 2, _QUOTED, "\t") for code in list_lexicon_languages()}
    parts = [f'\t"{code}": {{\n{text}\t}},\n' for code, text in texts.items()]
    return f"{head}const GESTURE_WORDS = {{\n{''.join(parts)}}}\n"


def _csharp() -> str:
    """C# has the lists as JSON, which it reads when a language is first spoken."""
    texts = {code: _json(code).replace('"', '""') for code in list_lexicon_languages()}
    parts = [f'            {{ "{code}", @"{text}" }},\n' for code, text in texts.items()]
    return (
        f"// {_MADE}\nusing System.Collections.Generic;\n\nnamespace Metagraph\n{{\n"
        f"    /// <summary>{_ABOUT.format('`GestureWords`')} JSON.</summary>\n"
        "    internal static class GestureWordLists\n    {\n"
        "        public static readonly Dictionary<string, string> Of = new Dictionary<string, string>\n"
        f"        {{\n{''.join(parts)}        }};\n    }}\n}}\n"
    )


def _cpp() -> str:
    """C++ as well, a text for each line: compilers limit how long one is."""
    parts: list[str] = []
    for code in list_lexicon_languages():
        lines = "\n".join(f'            R"json({line})json"' for line in _json(code).splitlines())
        parts.append(f'    if (language == "{code}") {{\n        return\n{lines};\n    }}\n')
    return (
        f"// {_ABOUT.format('word_gestures.hpp')} JSON.\n//\n// {_MADE}\n#pragma once\n\n"
        "#include <string>\n\n"
        "namespace metagraph {\nnamespace gesture_word_lists {\n\n"
        '/// The list of a language, "" where there is none.\n'
        f"inline std::string of(const std::string& language) {{\n{''.join(parts)}"
        '    return "";\n}\n\n}  // namespace gesture_word_lists\n}  // namespace metagraph\n'
    )


_QUOTED = '"{}": {}'


def _json(code: str) -> str:
    return "{\n" + _fields(code, 0, _QUOTED).removesuffix(",\n") + "\n}"


def _fields(code: str, depth: int, form: str, indent: str = " ") -> str:
    """Return a lexicon's fields, each on lines of its own that end with a comma. form: of a name and what it
    is.
    """
    lexicon, pack = load_gesture_words(code), list_language_packs().get(code)
    edge = indent * depth
    deeper = edge + (indent if indent == "\t" else 2 * indent)
    rules = ",\n".join(f"{deeper}{_rule(rule)}" for rule in lexicon.rules)
    rows = [
        ("rules", f"[\n{rules}\n{edge}]"),
        *((name, _rule(getattr(lexicon, name))) for name in ("question", "exclamation", "clause")),
        ("small", json.dumps(sorted(pack.small) if pack is not None else [], ensure_ascii=False)),
    ]
    return "".join(f"{edge}{form.format(name, text)},\n" for name, text in rows)


def _rule(rule: GestureRule) -> str:
    told: dict[str, Any] = {k: v for k, v in asdict(rule).items() if v not in ((), "")}
    return json.dumps(told, ensure_ascii=False)
