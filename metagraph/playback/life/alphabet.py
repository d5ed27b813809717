"""What is known of letters: their plain forms and what kind of character they are, as Unicode has it."""

from __future__ import annotations

import unicodedata
from zlib import crc32


class Alphabet:
    """Each runtime has its own: languages know different parts of Unicode."""

    def letters(self, text: str) -> list[str]:
        """Return a text's code points, a text each."""
        return list(text)

    def stripped(self, text: str) -> str:
        """Return a text without blanks at its ends."""
        return text.strip()

    def plain(self, word: str) -> list[str]:
        """Return a word in small letters without accents, a letter each."""
        apart = unicodedata.normalize("NFD", word.casefold())
        return [c for c in apart if not unicodedata.combining(c)]

    def kind(self, letter: str) -> str:
        """Return "syllable" for a digit and for a letter of a script without small ones, "letter" for others,
        "mark" for what combines with the letter before it; "" for all else.
        """
        if letter.isalnum():
            return "syllable" if letter.isdigit() or unicodedata.category(letter) == "Lo" else "letter"
        return "mark" if unicodedata.combining(letter) else ""

    def code(self, letter: str) -> int:
        """Return a letter's code point."""
        return ord(letter)

    def scatter(self, word: str) -> int:
        """Return 0..99, the same for the same word: the checksum that ZIP files use of its UTF-8 bytes."""
        return crc32(word.encode()) % 100


ALPHABET = Alphabet()
