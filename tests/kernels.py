"""Compiles what tests would wait for longer than a window is given: `python -m tests.kernels`, into numba's cache."""

from __future__ import annotations

from pathlib import Path


def main() -> None:
    from app.features.motion_graph.synthesis_jobs import Wish, synthesise, takes_of, usable
    from metagraph.formats.store import open_project
    from metagraph.synthesis.graph import build
    from metagraph.synthesis.states import states_of

    project = open_project(Path(__file__).resolve().parents[1] / "sample_clips" / "sample.metagraph.yaml").project
    takes = takes_of(project, [i for i in usable(project) if project.clips[i].name.endswith("__stance")])
    synthesise(build(states_of(takes.clips)), takes, Wish(4.0, ()), "new")


if __name__ == "__main__":
    main()
