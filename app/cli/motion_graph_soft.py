"""What new motion of `metagraph motion-graph` should have beside the constraints: how it is said, words, and
another speed.
"""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # reading a command line must not wait for arrays
    from metagraph.synthesis.soft_constraints import SoftWish


def add_soft_arguments(parser: ArgumentParser) -> None:
    """Add the options."""
    group = parser.add_argument_group("preferences beside the constraints")
    group.add_argument(
        "--sounds",
        type=Path,
        nargs="+",
        default=[],
        metavar="FILE",
        help="sounds of the recordings, with the names of the takes and of the speech of --new; a "
        "sound with two channels has a channel for each speaker",
    )
    group.add_argument(
        "--transcripts",
        type=Path,
        nargs="+",
        default=[],
        metavar="FILE",
        help="transcripts with times, with the names of the takes, if the files of --speech have no "
        "words: .TextGrid, .srt, .vtt, .json …",
    )
    group.add_argument(
        "--loudness",
        type=float,
        default=0.0,
        metavar="W",
        help="cost of a second whose loudness differs by one standard deviation of the speaker, as a "
        "share of the threshold (default: 0; try 0.25)",
    )
    group.add_argument(
        "--rate",
        type=float,
        default=0.0,
        metavar="W",
        help="the same for the rate of speech (default: 0; try 0.25)",
    )
    group.add_argument(
        "--word",
        action="append",
        default=[],
        metavar="WORD",
        help='take the motion for this word from where a take says it or a similar word: big, or "big '
        '= huge, tall"',
    )
    group.add_argument(
        "--words",
        type=Path,
        metavar="FILE",
        help="a file of such words, one on each line; lines that begin with # are comments",
    )
    group.add_argument(
        "--word-price",
        type=float,
        default=2.0,
        metavar="W",
        help="cost of each missed word, as a multiple of the threshold (default: 2)",
    )
    group.add_argument(
        "--words-must",
        action="store_true",
        help="treat words as constraints, and drop them last but one",
    )
    group.add_argument(
        "--retime",
        type=float,
        default=0.0,
        metavar="PERCENT",
        help="change the speed by up to this much, outside strokes, steps and transitions, where that "
        "improves the timing of starts, ends and stresses (default: 0; try 15)",
    )


def read_soft_wish(options: Namespace) -> SoftWish:
    """Return the preferences. Raises ValueError, and FileError for a file of words."""
    from metagraph.formats.word_lists import read_word_lists
    from metagraph.synthesis.iconic_words import parse_word_wish
    from metagraph.synthesis.soft_constraints import SoftWish

    words = tuple(parse_word_wish(text) for text in options.word)
    if options.words is not None:
        words += read_word_lists(options.words)
    if options.words_must and not words:
        raise ValueError("--words-must needs the words: give them with --word or --words")
    if options.loudness and not options.sounds:
        raise ValueError(
            "--loudness needs the sounds of the recordings: give them with --sounds, with the names of "
            "the takes"
        )
    return SoftWish(
        options.loudness, options.rate, words, options.word_price, options.words_must, options.retime / 100
    )
