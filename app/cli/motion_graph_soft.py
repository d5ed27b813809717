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
    group = parser.add_argument_group("beside the constraints")
    group.add_argument(
        "--sounds",
        type=Path,
        nargs="+",
        default=[],
        metavar="FILE",
        help="sounds of the recordings, called as the takes are, and as the speech of --new; of one with two "
        "channels each has its own",
    )
    group.add_argument(
        "--transcripts",
        type=Path,
        nargs="+",
        default=[],
        metavar="FILE",
        help="words with their times, called likewise, where the files of --speech hold none: .TextGrid, "
        ".srt, .vtt, .json …",
    )
    group.add_argument(
        "--loudness",
        type=float,
        default=0.0,
        metavar="W",
        help="what a second costs that was said louder or softer than it is now, by the speaker's spread, of "
        "the threshold (default: 0; try 0.25)",
    )
    group.add_argument(
        "--rate",
        type=float,
        default=0.0,
        metavar="W",
        help="the same of how fast it was said (default: 0; try 0.25)",
    )
    group.add_argument(
        "--word",
        action="append",
        default=[],
        metavar="WORD",
        help='a word that wants motion from where a take says it, or one alike: big, or "big = huge, tall"',
    )
    group.add_argument(
        "--words", type=Path, metavar="FILE", help="a file of such words, a line each; # for what is none"
    )
    group.add_argument(
        "--word-price",
        type=float,
        default=2.0,
        metavar="W",
        help="what a word costs that is missed, of the threshold (default: 2)",
    )
    group.add_argument(
        "--words-must",
        action="store_true",
        help="words have to be met, and are given up last but one",
    )
    group.add_argument(
        "--retime",
        type=float,
        default=0.0,
        metavar="PERCENT",
        help="play it faster and slower by up to so much, outside of strokes, steps and transitions, where "
        "that brings starts, ends and stresses nearer (default: 0; try 15)",
    )


def read_soft_wish(options: Namespace) -> SoftWish:
    """Return what is wished. Raises ValueError, and FileError for a file of words."""
    from metagraph.formats.word_lists import read_word_lists
    from metagraph.synthesis.iconic_words import word_wish
    from metagraph.synthesis.soft_constraints import SoftWish

    words = tuple(word_wish(text) for text in options.word)
    if options.words is not None:
        words += read_word_lists(options.words)
    if options.words_must and not words:
        raise ValueError("--words-must says that words have to be met: say which, with --word or --words")
    if options.loudness and not options.sounds:
        raise ValueError(
            "--loudness compares sounds: give those of the recordings with --sounds, called as the takes are"
        )
    return SoftWish(
        options.loudness, options.rate, words, options.word_price, options.words_must, options.retime / 100
    )
