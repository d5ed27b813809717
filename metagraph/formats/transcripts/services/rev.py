"""Rev AI's and Rev.com's transcripts: monologues[].elements[], `ts` and `end_ts` in seconds, or `timestamp`
and `end_timestamp` as 00:00:01,500.
"""

from __future__ import annotations

from metagraph.formats.transcripts.json_files import add_words
from metagraph.formats.transcripts.json_values import list_row_dicts, name_of, parse_text
from metagraph.formats.transcripts.source import TranscriptSource
from metagraph.formats.transcripts.words import Collected, Transcript


def is_rev(source: TranscriptSource) -> bool:
    return isinstance(source.data, dict) and "monologues" in source.data


def read_rev(source: TranscriptSource) -> Transcript:
    """Read monologues; speakers are called as the file names them, else by their numbers. Marks stay with the
    word before them. Raises FileError.
    """
    out = Collected(source.path)
    names = {
        name_of(one.get("id", "")): name_of(one.get("name", ""))
        for _, one in list_row_dicts(out, source.data, "speakers")
    }
    for where, one in list_row_dicts(out, source.data, "monologues"):
        number = name_of(one.get("speaker", ""))
        words: list[dict[str, object]] = []
        for _, element in list_row_dicts(out, one, "elements", where):
            text = parse_text(element.get("value"))
            if element.get("type") == "text":
                start = element.get("ts", element.get("timestamp"))
                end = element.get("end_ts", element.get("end_timestamp"))
                words.append({"word": text, "start": start, "end": end})
            elif element.get("type") == "punct" and words and text.strip():
                words[-1]["word"] = f"{words[-1]['word']}{text.strip()}"
        add_words(out, words, names.get(number) or number, f"{where}.elements")
    return out.finished()
