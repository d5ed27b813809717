"""List the kinds of files that conversations are written as, a line each, for command line and window."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats.conversations.captions import write_subrip, write_webvtt
from metagraph.formats.conversations.mouth_cues import write_rhubarb
from metagraph.formats.conversations.writers import write_elan, write_json, write_textgrid
from metagraph.graph.conversation.model import Conversation


@dataclass(frozen=True)
class ConversationOutput:
    """A kind of file. name: for people. ending: of its files. xml: whether signs that XML has not are
    replaced. write: takes the conversation, the path, and the folder that sounds are relative to, if any.
    """

    name: str
    ending: str
    write: Callable[[Conversation, Path, Path | None], None]
    xml: bool = False


CONVERSATION_OUTPUTS = (
    ConversationOutput(phrase("ELAN"), ".eaf", write_elan, xml=True),
    ConversationOutput(phrase("Praat TextGrid"), ".TextGrid", lambda c, path, _: write_textgrid(c, path)),
    ConversationOutput(
        phrase("WebVTT, captions with speakers"), ".vtt", lambda c, path, _: write_webvtt(c, path)
    ),
    ConversationOutput(phrase("SubRip, subtitles"), ".srt", lambda c, path, _: write_subrip(c, path)),
    ConversationOutput(
        phrase("Rhubarb, mouth shapes of one speaker"), ".tsv", lambda c, path, _: write_rhubarb(c, path)
    ),
    ConversationOutput(
        phrase("JSON, as in a project"), ".json", lambda c, path, _: write_json(c, path)
    ),
)  # fmt: skip


def find_conversation_output(path: Path) -> ConversationOutput | None:
    """Return the kind of file that a path's ending asks for; None for another."""
    ending = path.suffix.casefold()
    return next((kind for kind in CONVERSATION_OUTPUTS if kind.ending.casefold() == ending), None)


def write_conversation(conversation: Conversation, path: str | Path, folder: Path | None = None) -> None:
    """Write a conversation as its path's ending asks. folder: what the sides' sounds are relative to, None if
    they are absolute. Raises FileError.
    """
    path = Path(path)
    kind = find_conversation_output(path)
    if kind is None:
        endings = ", ".join(k.ending for k in CONVERSATION_OUTPUTS)
        raise FileError(
            path,
            phrase("conversations are not written as '{ending}'", ending=path.suffix),
            "",
            phrase("Choose one of {endings}.", endings=endings),
        )
    kind.write(conversation, path, folder)
