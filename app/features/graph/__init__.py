"""The meta-graph on its canvas, its layers and stances."""

from __future__ import annotations

from functools import partial

from app.features.graph.graph_commands import COMMANDS, GraphFeature
from app.features.graph.layer_tabs import LayerTabs
from app.shell.command_table import bind_commands, has_actions_selected, is_meta_graph_shown, require_all
from app.shell.context import Contribution, HeaderItem, Panel, Shell
from app.shell.verbs import Verbs
from app.translation import tr


def contribute(shell: Shell) -> Contribution:
    graph, verbs = GraphFeature(shell), shell.services[Verbs]
    shown = partial(is_meta_graph_shown, graph)
    graph.importing.imported.connect(graph.place_imported)
    verbs.offer(
        "remove", partial(require_all(is_meta_graph_shown, has_actions_selected), graph), graph.remove_actions
    )
    verbs.offer("rename", shown, graph.rename_stance, rank=9)
    verbs.offer("select_all", shown, graph.select_all, rank=9)
    return Contribution(
        panels=(
            Panel(
                "graph",
                tr("Graph"),
                "centre",
                graph.make_canvas,
                late=False,
                when="meta",
                where={"graph": "large", "time": "list"},
                opens={"label": "below"},
                least=(250, 200),
                rank=0,
            ),
        ),
        commands=bind_commands(COMMANDS, graph),
        header=(HeaderItem("left", partial(LayerTabs, shell)),),
        close=lambda: graph.canvas.stop(),
    )
