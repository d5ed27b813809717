"""One kind of error for every file we read: it names the file, the place, the cause and the remedy."""

from __future__ import annotations

from pathlib import Path

from metagraph.common.wording import phrase


def clean_text(text: str) -> str:
    """Return text from a file fit for a message: one line, no control characters, not endless."""
    if text.isprintable() and len(text) <= 400:
        return text
    text = "".join(c if c.isprintable() else "\ufffd" for c in text)
    return text if len(text) <= 400 else f"{text[:400]} ..."


class FileError(Exception):
    """A file could not be read or written.

    `where` is a line, node or field ("line 12", "node 'Hips'"); `remedy` says what the user can do.
    """

    def __init__(self, path: str | Path, cause: str, where: str = "", remedy: str = "") -> None:
        self.path, self.cause, self.where, self.remedy = Path(path), cause, where, remedy
        name = clean_text(self.path.name)  # a name may be bytes in no known encoding
        place = phrase("{file}, {where}", file=name, where=clean_text(where)) if where else name
        words = "{place}: {cause}. {remedy}" if remedy else "{place}: {cause}."
        super().__init__(phrase(words, place=place, cause=clean_text(cause), remedy=remedy))

    @property
    def words(self) -> str:
        """All of it; words that know their templates (`metagraph.common.wording`)."""
        found: str = self.args[0]
        return found

    def __str__(self) -> str:
        return str(self.args[0])

    def __reduce__(self) -> tuple[type[FileError], tuple[Path, str, str, str]]:
        return type(self), (self.path, self.cause, self.where, self.remedy)


def describe_error(error: BaseException) -> str:
    """Return what an error says, as words that know their template where it was made of such."""
    first = error.args[0] if error.args else ""
    return first if isinstance(first, str) and str(error) == first else str(error)
