"""Packs of one's own: what is wrong with them is said with file, line, field and remedy.
Good ones are read.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from metagraph.errors import FileError
from metagraph.formats.language_files import gather_packs, read_pack
from metagraph.speech.language_packs import FOLDER, list_language_packs

GOOD = """\
code: sv
name: Swedish
responses: ja, jaha, just det, no
hesitations:
- "öh, öhm"
- liksom
lexical: [liksom]
small: [jag, "och, att, det"]
"""


def pack(folder: Path, text: str, name: str = "sv.yaml") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("text", "place", "cause"),
    [
        ("", "its beginning", "no fields"),
        ("- ja", "its beginning", "no fields"),
        ("code: [sv", "line", "neither YAML nor JSON"),
        ("code: sv\nresponses: ja", "", "name"),
        ("code: Schwedisch\nname: x\nresponses: ja", "line 1, 'code'", ""),
        ("code: sv\nname: x\nresponses:\n- ja\n- 3", "line 5, 'responses[1]'", "str"),
        ("code: sv\nname: x\nresponses: ja\nwords: ja", "", "words"),
        ("code: sv\nname: x\nresponses: ja, '...'", "line 3, 'responses'", "no letters"),
        ("code: sv\nname: x\nresponses: ja\nsmall: i den", "line 4, 'small'", "more than one word"),
        ("code: sv\nname: x\nresponses: []", "line 3, 'responses'", "has no words"),
        ("code: sv\nname: x\nresponses: ja\nborrows: [tlh]", "line 4, 'borrows'", "'tlh'"),
        ("code: sv\nname: x\nresponses: ja\nletters_a_word: 0", "line 4, 'letters_a_word'", ""),
        ("code: sv\nname: x\nresponses: &a ja", "line 3", "anchors"),
    ],
)
def test_what_is_wrong_is_said_with_its_place_and_a_remedy(
    tmp_path: Path, text: str, place: str, cause: str
) -> None:
    with pytest.raises(FileError) as told:
        read_pack(pack(tmp_path, text))
    message = str(told.value)
    assert message.startswith("sv.yaml") and place in message and cause in message
    assert told.value.remedy and "docs/animators/talk-languages.md" in message


def test_a_pack_that_is_not_there_is_said(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"sv\.yaml"):
        read_pack(tmp_path / "sv.yaml")


def test_yaml_and_json_are_read(tmp_path: Path) -> None:
    swedish = read_pack(pack(tmp_path, GOOD))
    assert swedish.responses == ("ja", "jaha", "just det", "no")  # "no" is a word, not false
    assert swedish.hesitations == ("öh", "öhm", "liksom") and swedish.small == {"jag", "och", "att", "det"}
    for path in FOLDER.glob("*.json"):  # those that come with the program are of the same form
        assert read_pack(path).responses == list_language_packs()[path.stem].responses


def test_a_pack_takes_the_place_of_one_of_its_code(tmp_path: Path) -> None:
    own = pack(tmp_path, GOOD.replace("code: sv", "code: de"))
    packs = gather_packs([own])
    assert packs["de"].name == "Swedish" and set(packs) == set(list_language_packs())
    assert list_language_packs()["de"].name == "German"
    assert "sv" in gather_packs([pack(tmp_path, GOOD, "b.yaml")])
