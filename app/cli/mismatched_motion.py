"""Motion for a conversation of a project, by a motion graph of takes or by a learned model: what
`study perceive mismatched` asks about.
"""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # reading a command line must not wait for arrays
    from metagraph.graph.conversation.model import Conversation


def write_graph_motion(talk: Conversation, takes: Path, out: Path) -> list[Path]:
    """Write what a motion graph of a folder of takes makes of each side's speech: `out_1.glb` and so on.
    Return the files. Raises FileError, ValueError.
    """
    from metagraph.formats.clips import read_clips
    from metagraph.formats.gltf.writer import write_glb
    from metagraph.generation.take_files import find_takes, read_speech
    from metagraph.research.motion_graph.search_evaluation import cut_segments
    from metagraph.synthesis.assemble import assemble
    from metagraph.synthesis.constraints import find_change_states, find_heard_at
    from metagraph.synthesis.graph import build_graph, find_threshold
    from metagraph.synthesis.search.relaxing import answer_speech
    from metagraph.synthesis.states import key_states, read_states

    clips, speech = [], []
    for files in find_takes([takes])[0]:
        said = read_speech(files).conversation
        if said is not None and files.side < len(said.sides):
            clips.append(read_clips(files.clip)[0])
            speech.append(said.sides[files.side].segments)
    if not clips:
        raise ValueError(f"{takes} has no takes with words beside them")
    states = read_states(clips)
    keys = key_states(states, changes=find_change_states(states, speech))
    graph = build_graph(states, find_threshold(states), keys)
    heard = find_heard_at(states, speech)
    written = []
    for n, side in enumerate(talk.sides, 1):
        asked = cut_segments(side.segments, 0.0, talk.length)
        found = answer_speech(graph, heard, asked, talk.length)
        written.append(out.with_name(f"{out.name}_{n}.glb"))
        clip = assemble(states, clips, found.path, written[-1].stem, retiming=found.retiming)
        write_glb(written[-1], [clip])
    return written


def write_model_motion(talk: Conversation, folder: Path, path: Path, out: Path) -> list[Path]:
    """Write what a model makes of each side's speech: `out_1.glb` and so on; return the files. folder: of the
    project, to which the sounds are relative. Raises FileError, ValueError.
    """
    from app.cli.generate_motion import make_motion, read_heard
    from metagraph.formats.gltf.writer import write_glb
    from metagraph.generation.stored import read_model

    if len(talk.sides) > 2 or any(side.audio is None for side in talk.sides):
        raise ValueError(f"a model needs the sounds of two speakers, which '{talk.name}' does not have")
    sounds = list(dict.fromkeys(folder / str(side.audio) for side in talk.sides))
    model = read_model(path)
    written = []
    for n in range(1, len(talk.sides) + 1):
        asked = Namespace(
            model=path, speech=sounds, words=None, language="auto", words_list=[], side=n, seed=1,
            temperature=1.0, guidance=None, lookahead=None, activity=None, first=None,
        )  # fmt: skip
        clip = make_motion(asked, model, read_heard(asked, model.card.tracks), 1)
        written.append(out.with_name(f"{out.name}_{n}.glb"))
        write_glb(written[-1], [clip])
    return written
