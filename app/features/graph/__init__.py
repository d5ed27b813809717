"""The meta-graph on its canvas, its layers and stances."""

from __future__ import annotations

from functools import partial

from PySide6.QtWidgets import QWidget

from app.features.graph.graph_canvas import Canvas
from app.features.graph.graph_drops import Drop
from app.project.importing import Importing
from app.shell.actions import Command
from app.shell.context import Contribution, HeaderItem, Panel, Shell
from app.shell.places import Places
from app.shell.verbs import Verbs
from app.stage.problem_watch import ProblemWatch
from app.translation import tr
from app.widgets.choice_row import ChoiceRow
from app.widgets.vocabulary import titled, word
from metagraph.formats.imports import Imported
from metagraph.graph.model import KINDS, LAYERS, Kind, Layer

LAYER_KEYS: dict[Layer, str] = {"body": "Alt+1", "arms": "Alt+2", "head": "Alt+3"}


def contribute(shell: Shell) -> Contribution:
    session, document, stage = shell.stage.session, shell.document, shell.stage
    importing, problems, verbs = (
        shell.services[Importing],
        shell.services[ProblemWatch],
        shell.services[Verbs],
    )
    meta = lambda: session.onstage.mode == "meta"  # noqa: E731

    def make() -> Canvas:
        canvas = Canvas(document, session, stage.performance, stage.thumbnails, shell.widget)
        canvas.row_actions = shell.actions.of_menu("action")
        canvas.files_dropped.connect(lambda paths, drop: importing.import_paths(list(paths), drop))
        canvas.acts.refused.connect(stage.refused)
        canvas.acts.labelled.connect(go_on)
        problems.changed.connect(lambda: canvas.set_misfits(problems.misfits))
        return canvas

    def go_on(clips: tuple[str, ...], made: tuple[str, ...]) -> None:
        """After a label by key the next clip without one is selected and plays; what was made is in sight."""
        following = shell.panel("library").next_unlabelled(clips[-1])
        canvas().reveal(made)
        places = shell.services[Places]
        if places.belongs("properties", places.workspace) and not places.dock("properties").isHidden():
            places.show("properties")
        if following is not None:
            session.selection.select_clips((following,))
            session.transport.show_clip(following)

    def canvas() -> Canvas:
        found: Canvas = shell.panel("graph")
        return found

    def imported(result: Imported, place: object) -> None:
        load = importing.load_for(result)
        if isinstance(place, Drop) and load.clips:
            canvas().acts.do(place, load)

    importing.imported.connect(imported)
    verbs.offer(
        "remove", lambda: meta() and bool(session.selection.actions), lambda: canvas().acts.remove_selection()
    )
    verbs.offer("rename", meta, lambda: canvas().acts.rename_stance(), rank=9)
    verbs.offer(
        "select_all",
        meta,
        lambda: session.selection.select_actions(tuple(a.id for a in canvas().acts.listed())),
        rank=9,
    )
    some = lambda: bool(session.selection.clips or session.selection.actions)  # noqa: E731
    stances = lambda: list(document.project.graphs[session.place.layer].stances.values())  # noqa: E731

    def label(kind: Kind) -> None:
        canvas().acts.place_selection(kind)

    def shift(steps: int) -> None:
        canvas().acts.shift(steps)

    def on_layer(layer: Layer) -> bool:
        return session.place.layer == layer

    def has_stance(place: int) -> bool:
        return place < len(stances())

    def choose(place: int) -> None:
        if has_stance(place):
            session.place.set_stance(stances()[place].id)

    def name(place: int) -> str:
        found = stances()
        return found[place].name if place < len(found) else tr("Stance {number}", number=place + 1)

    menu = "&Graph"
    labels = (
        Command(
            f"label_{kind}",
            menu,
            "label",
            tr("Label as &{number} {kind}", number=number, kind=word(kind)),
            partial(label, kind),
            (str(number),),
            enabled=some,
            when="meta",
            study=True,
            menus=("clip label",),
        )
        for number, kind in enumerate(KINDS, 1)
    )
    layers = (
        Command(
            f"layer_{layer}",
            menu,
            "layers",
            tr("{layer} layer", layer=titled(layer)),
            partial(session.place.set_layer, layer),
            (LAYER_KEYS[layer],),
            checked=partial(on_layer, layer),
            study=True,
        )
        for layer in LAYERS
    )
    places = (
        Command(
            f"stance_{n + 1}",
            menu,
            "stances",
            partial(name, n),
            partial(choose, n),
            (f"Ctrl+{n + 1}",),
            enabled=partial(has_stance, n),
            visible=partial(has_stance, n),
            when="meta",
            study=True,
        )
        for n in range(9)
    )
    order = (
        Command(
            f"list_{ident}",
            menu,
            "label",
            text,
            partial(shift, steps),
            (f"Alt+{key}",),
            tip=tip,
            enabled=lambda: bool(session.selection.actions),
            when="meta",
            menus=("action",),
        )
        for ident, key, steps, text, tip in (
            (
                "earlier",
                "Up",
                -1,
                tr("List earlier in its node"),
                tr("Move the selected actions a place earlier in their node; what plays does not change"),
            ),
            (
                "later",
                "Down",
                1,
                tr("List later in its node"),
                tr("Move the selected actions a place later in their node; what plays does not change"),
            ),
        )
    )
    new = Command(
        "new_stance",
        menu,
        "author",
        tr("&New stance…"),
        lambda: canvas().acts.new_stance(),
        ("Ctrl+Shift+N",),
        when="meta",
        study=True,
    )
    return Contribution(
        panels=(
            Panel(
                "graph",
                tr("Graph"),
                "centre",
                make,
                late=False,
                when="meta",
                where={"graph": "large", "time": "list"},
                opens={"label": "below"},
                least=(250, 200),
                rank=0,
            ),
        ),
        commands=(new, *labels, *order, *layers, *places),
        header=(HeaderItem("left", lambda parent: LayerTabs(shell, parent)),),
        close=lambda: canvas().stop(),
    )


class LayerTabs(ChoiceRow):
    """The layers, each with how many actions it has; the current one is pressed."""

    def __init__(self, shell: Shell, parent: QWidget) -> None:
        tips = (
            (titled(x), tr("The {layer} layer ({key})", layer=word(x), key=LAYER_KEYS[x])) for x in LAYERS
        )
        super().__init__(parent, tips, least_width=56)
        self.document, self.session = shell.document, shell.stage.session
        self.chosen.connect(lambda n: self.session.place.set_layer(LAYERS[n]))
        self.session.place.layer_changed.connect(self.refresh)
        self.document.changed.connect(
            lambda before, after: self.refresh() if before.graphs is not after.graphs else None
        )
        self.refresh()

    def refresh(self) -> None:
        """Show the layer and the counts as they are now."""
        for number, layer in enumerate(LAYERS):
            count = len(self.document.project.graphs[layer].actions)
            self.button(number).setText(f"{titled(layer)}  {count}" if count else titled(layer))
        self.show_choice(LAYERS.index(self.session.place.layer))
