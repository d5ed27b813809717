"""`metagraph moods`: which moods a project's character and lines are in; set them, or hear them in voices."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from app.cli.command_output import open_for_command, say
from app.cli.outputs import ProjectOutput
from metagraph.graph.model import Project
from metagraph.graph.words import FEELINGS


def add_arguments(parser: ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument(
        "--mood",
        metavar="MOOD",
        help=f"put the character in a mood: {', '.join(FEELINGS)}, or 'valence,arousal'",
    )
    parser.add_argument(
        "--intensity", type=float, help="how large gestures play, 0 to 2; 1 is the size of the clips"
    )
    parser.add_argument(
        "--from-voices",
        action="store_true",
        help="set the arousal of lines without a mood from their sound",
    )


def run(options: Namespace) -> int:
    """Print the moods; set the requested ones and save them in the project."""
    from metagraph.graph.editing.performances import set_life
    from metagraph.playback.planning.understand import read_mood

    told = read_mood(_mood(options.mood), options.intensity)  # type: ignore[arg-type]
    if not told and not options.from_voices:
        return _said(options, open_for_command(options.project))
    with ProjectOutput(options.project) as output:
        before = project = open_for_command(options.project)
        if told:
            project = set_life(project, **told)
        if options.from_voices:
            from metagraph.speech.voice_mood import with_voice_moods

            project = with_voice_moods(project, options.project.resolve().parent)
        if project != before:
            output.save(project)
    return _said(options, project)


def _said(options: Namespace, project: Project) -> int:
    life = project.life
    words = [
        f"the character: valence {life.valence:g}, arousal {life.arousal:g}, intensity {life.intensity:g}"
    ]
    lines = {i: x.mood for i, x in project.lines.items() if x.mood is not None}
    for ident, mood in lines.items():
        words.append(f"line {ident}: {mood if isinstance(mood, str) else ', '.join(f'{x:g}' for x in mood)}")
    data = {"valence": life.valence, "arousal": life.arousal, "intensity": life.intensity, "lines": lines}
    say(options, "\n".join(words), data)
    return 0


def _mood(word: str | None) -> str | tuple[float, ...] | None:
    """Return the mood that a word stands for. Raises ValueError for an unknown word."""
    if word is None or word in FEELINGS:
        return word
    try:
        point = tuple(float(x) for x in word.split(","))
    except ValueError:
        point = ()
    if len(point) != 2 or not all(-1 <= x <= 1 for x in point):
        raise ValueError(
            f"there is no mood '{word}'; the moods are {', '.join(FEELINGS)}, and 'valence,arousal'"
        )
    return point
