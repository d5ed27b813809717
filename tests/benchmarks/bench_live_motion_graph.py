"""Motion of a graph that is extended while it plays, ten minutes of speech it was not made of: how soon its
strokes come, what it looks like, what a search costs; beside the best paths that know all of the speech.

    .venv/bin/python tests/benchmarks/bench_live_motion_graph.py [seconds]
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from metagraph.formats.store import open_project  # noqa: E402
from metagraph.graph.conversation.model import Segment, list_segments_heard_by  # noqa: E402
from metagraph.motion.clip import Clip  # noqa: E402
from metagraph.research.exhibits.material import make_conversations  # noqa: E402
from metagraph.research.generation.planted_speech import make_planted_speech  # noqa: E402
from metagraph.research.motion_graph.extending_evaluation import format_rows_as_text, score_extending  # noqa: E402
from metagraph.synthesis.constraints import find_change_states, find_heard_at  # noqa: E402
from metagraph.synthesis.graph import build_graph  # noqa: E402
from metagraph.synthesis.states import key_states, read_states  # noqa: E402
from tests.synthesis.talking import speech, talking  # noqa: E402

TAKES, LONG = 8, 60.0  # and seconds of each


def measured(
    words: str,
    takes: Sequence[Clip],
    said: Sequence[Sequence[Segment]],
    new: Sequence[Segment],
    seconds: float,
) -> None:
    states = read_states(takes)
    graph = build_graph(states, keys=key_states(states, changes=find_change_states(states, said)))
    kept, edges = graph.size
    print(f"{words}: {kept:,} states, {edges:,} transitions; {seconds:g} s of other speech")
    print(
        format_rows_as_text(list(score_extending([(graph, find_heard_at(states, said), new, seconds)]))),
        flush=True,
    )


def main() -> None:
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 600.0
    said = [speech(LONG, n) for n in range(TAKES)]
    takes = [talking(f"take{n}", said[n], LONG, n) for n in range(TAKES)]
    measured("somebody made up who talks", takes, said, speech(seconds, 99), seconds)
    project = open_project(ROOT / "sample_clips" / "sample.metagraph.yaml").project
    talks = make_conversations(project, TAKES, LONG)
    clips = [clip for talk in talks if (clip := talk.clips[0]) is not None]
    new = list_segments_heard_by(make_planted_speech(seconds, 777, 888, "new").conversation, 0)
    measured(
        "the sample project in conversation",
        clips,
        [list_segments_heard_by(t.conversation, 0) for t in talks],
        new,
        seconds,
    )


if __name__ == "__main__":
    main()
