"""The files of words that clips' names are read by: what they must hold, and one more language."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from metagraph.errors import FileError
from metagraph.suggest.words.files import FOLDER, LanguageFile, list_phrases, read_words

ESPERANTO = {
    "doubtful": "al",
    "endings": "anta as i o",
    "words": {
        "idle": "ripozo",
        "stand": "stari, staranta",
        "sit": ["sidi", "sidanta"],
        "nod": "kapjesi, kapjeso",
        "to": "al",
    },
}


def test_a_language_is_added_by_a_file(tmp_path: Path) -> None:
    folder = tmp_path / "words"
    shutil.copytree(FOLDER, folder)
    (folder / "esperanto.json").write_text(json.dumps(ESPERANTO))
    code = (
        "import sys; from pathlib import Path; from metagraph.suggest.words import files as words_files\n"
        "words_files.FOLDER = Path(sys.argv[1])\n"
        "from metagraph.suggest.words.names import read_names\n"
        "for name, guess in read_names(['Sidi_ripozo', 'Sidi_kapjesi', 'Sidanta_al_staranta']).items():\n"
        "    print(name, guess.kind and guess.kind.value, guess.stance and guess.stance.value)"
    )
    ran = subprocess.run(
        [sys.executable, "-c", code, str(folder)], capture_output=True, text=True, check=True, timeout=300
    )
    assert ran.stdout.splitlines() == [
        "Sidi_ripozo stance sidi",
        "Sidi_kapjesi gesture sidi",
        "Sidanta_al_staranta transition sidi",
    ]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("", "truncated"),
        ("[]", "Expected `object`"),
        ('{"endings": "s"}', "missing required field `words`"),
        ('{"words": {"sit": "sidi"}, "ending": "i"}', "unknown field `ending`"),
        ('{"words": {"sit": " , "}}', "'sit' has no phrases"),
        ('{"words": {"sit": 3}}', "at `$.words[...]`"),
        ('{"words": {"sit": "sidi"}, "sides": "m"}', "sides are two letters"),
    ],
)
def test_a_file_with_something_wrong_is_named(tmp_path: Path, words: str, said: str) -> None:
    path = tmp_path / "esperanto.json"
    path.write_text(words)
    with pytest.raises(FileError, match=r"esperanto\.json") as caught:
        read_words(path, LanguageFile)
    assert said in str(caught.value)


def test_phrases_have_commas_between_them_and_may_take_several_lines() -> None:
    assert list_phrases(" look  around,, nod ") == ["look around", "nod"]
    assert list_phrases(("look around, nod", "shrug")) == ["look around", "nod", "shrug"]
