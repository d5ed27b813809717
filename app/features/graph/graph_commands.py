"""The commands of the graph: labels, the order of a node's actions, layers and stances."""

from __future__ import annotations

from functools import partial

from app.features.graph.graph_canvas import Canvas
from app.features.graph.graph_drops import Drop
from app.features.graph.layer_tabs import LAYER_KEYS
from app.project.importing import Importing
from app.shell.actions import Command
from app.shell.command_table import Feature, has_actions_selected, has_clips_selected, require_any
from app.shell.context import Shell
from app.shell.places import PanelPlaces
from app.stage.problem_watch import ProblemWatch
from app.translation import tr, tr_noop
from app.widgets.vocabulary import get_vocabulary_title, get_vocabulary_word
from metagraph.formats.imports import Imported
from metagraph.graph.model import KINDS, LAYERS, Kind, Layer, Stance

MENU = "&Graph"
STANCES = 9  # with a command of their own


class GraphFeature(Feature):
    """Makes the canvas of the graph, and does the commands of this module."""

    def __init__(self, shell: Shell) -> None:
        super().__init__(shell)
        self.importing, self.place = shell.services[Importing], self.session.place

    @property
    def canvas(self) -> Canvas:
        found: Canvas = self.shell.panel("graph")
        return found

    def make_canvas(self) -> Canvas:
        shell, problems = self.shell, self.shell.services[ProblemWatch]
        canvas = Canvas(self.document, self.session, self.performance, shell.stage.thumbnails, shell.widget)
        canvas.row_actions = shell.actions.of_menu("action")
        canvas.files_dropped.connect(lambda paths, drop: self.importing.import_paths(list(paths), drop))
        canvas.acts.refused.connect(shell.stage.refused)
        canvas.acts.labelled.connect(self.go_on)
        problems.changed.connect(lambda: canvas.set_misfits(problems.misfits))
        return canvas

    def go_on(self, clips: tuple[str, ...], made: tuple[str, ...]) -> None:
        """After a label by key the next clip without one is selected and plays; what was made is in sight."""
        following = self.shell.panel("library").next_unlabelled(clips[-1])
        self.canvas.reveal(made)
        places = self.shell.services[PanelPlaces]
        if places.belongs("properties", places.workspace) and not places.dock("properties").isHidden():
            places.show("properties")
        if following is not None:
            self.session.selection.select_clips((following,))
            self.session.transport.show_clip(following)

    def place_imported(self, result: Imported, place: object) -> None:
        """Do what was dropped on the canvas, once it is read."""
        load = self.importing.load_for(result)
        if isinstance(place, Drop) and load.clips:
            self.canvas.acts.do(place, load)

    def remove_actions(self) -> None:
        self.canvas.acts.remove_selection()

    def rename_stance(self) -> None:
        self.canvas.acts.rename_stance()

    def select_all(self) -> None:
        self.session.selection.select_actions(tuple(a.id for a in self.canvas.acts.listed()))

    def label(self, kind: Kind) -> None:
        self.canvas.acts.place_selection(kind)

    def list_earlier(self) -> None:
        self.canvas.acts.shift(-1)

    def list_later(self) -> None:
        self.canvas.acts.shift(1)

    def show_layer(self, layer: Layer) -> None:
        self.place.set_layer(layer)

    def shows_layer(self, layer: Layer) -> bool:
        return self.place.layer == layer

    def new_stance(self) -> None:
        self.canvas.acts.new_stance()

    def stances(self) -> list[Stance]:
        """The stances of the layer that is shown."""
        return list(self.document.project.graphs[self.place.layer].stances.values())

    def has_stance(self, number: int) -> bool:
        return number <= len(self.stances())

    def choose_stance(self, number: int) -> None:
        if self.has_stance(number):
            self.canvas.acts.show_stance(self.stances()[number - 1].id)

    def find_stance(self) -> None:
        self.canvas.acts.find_stance()

    def has_stances(self) -> bool:
        return any(graph.stances for graph in self.document.project.graphs.values())

    def stance_earlier(self) -> None:
        self.canvas.acts.shift_stance(-1)

    def stance_later(self) -> None:
        self.canvas.acts.shift_stance(1)

    def stance_name(self, number: int) -> str:
        found = self.stances()
        return found[number - 1].name if number <= len(found) else tr("Stance {number}", number=number)


def _label_text(feature: GraphFeature, number: int, kind: Kind) -> str:
    return tr("Label as &{number} {kind}", number=number, kind=get_vocabulary_word(kind))


def _layer_text(feature: GraphFeature, layer: Layer) -> str:
    return tr("{layer} layer", layer=get_vocabulary_title(layer))


COMMANDS = (
    Command(
        "new_stance",
        MENU,
        "author",
        tr_noop("&New stance…"),
        GraphFeature.new_stance,
        ("Ctrl+Shift+N",),
        when="meta",
        study=True,
    ),
    *(
        Command(
            f"label_{kind}",
            MENU,
            "label",
            partial(_label_text, number=number, kind=kind),
            partial(GraphFeature.label, kind=kind),
            (str(number),),
            enabled=require_any(has_clips_selected, has_actions_selected),
            when="meta",
            study=True,
            menus=("clip label",),
        )
        for number, kind in enumerate(KINDS, 1)
    ),
    Command(
        "list_earlier",
        MENU,
        "label",
        tr_noop("Move up in its node"),
        GraphFeature.list_earlier,
        ("Alt+Up",),
        tip=tr_noop("Move the selected actions one place up in their node. This does not change what plays."),
        enabled=has_actions_selected,
        when="meta",
        menus=("action",),
    ),
    Command(
        "list_later",
        MENU,
        "label",
        tr_noop("Move down in its node"),
        GraphFeature.list_later,
        ("Alt+Down",),
        tip=tr_noop(
            "Move the selected actions one place down in their node. This does not change what plays."
        ),
        enabled=has_actions_selected,
        when="meta",
        menus=("action",),
    ),
    *(
        Command(
            f"layer_{layer}",
            MENU,
            "layers",
            partial(_layer_text, layer=layer),
            partial(GraphFeature.show_layer, layer=layer),
            (LAYER_KEYS[layer],),
            checked=partial(GraphFeature.shows_layer, layer=layer),
            study=True,
        )
        for layer in LAYERS
    ),
    Command(
        "find_stance",
        MENU,
        "stances",
        tr_noop("&Find stance…"),
        GraphFeature.find_stance,
        ("Ctrl+G",),
        tip=tr_noop("Find a stance of any layer by typing its name"),
        enabled=GraphFeature.has_stances,
        when="meta",
        study=True,
    ),
    Command(
        "list_stance_earlier",
        MENU,
        "stances",
        tr_noop("Move stance &left"),
        GraphFeature.stance_earlier,
        ("Alt+Shift+Left",),
        tip=tr_noop(
            "Move the current stance one place to the left in the strip. This does not change what plays."
        ),
        enabled=partial(GraphFeature.has_stance, number=2),
        when="meta",
    ),
    Command(
        "list_stance_later",
        MENU,
        "stances",
        tr_noop("Move stance &right"),
        GraphFeature.stance_later,
        ("Alt+Shift+Right",),
        tip=tr_noop(
            "Move the current stance one place to the right in the strip. This does not change what plays."
        ),
        enabled=partial(GraphFeature.has_stance, number=2),
        when="meta",
    ),
    *(
        Command(
            f"stance_{number}",
            MENU,
            "stances",
            partial(GraphFeature.stance_name, number=number),
            partial(GraphFeature.choose_stance, number=number),
            (f"Ctrl+{number}",),
            enabled=partial(GraphFeature.has_stance, number=number),
            visible=partial(GraphFeature.has_stance, number=number),
            when="meta",
            study=True,
        )
        for number in range(1, STANCES + 1)
    ),
)
