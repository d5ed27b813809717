"""The commands of the character: which one it is, its transport, and from where it is seen."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtWidgets import QMenu

from app.features.character import character_choice
from app.features.character.character_panel import PreviewPanel
from app.features.character.mesh_menu import MeshButton
from app.features.character.watch_commands import fill_watch
from app.shell.actions import Command
from app.shell.command_table import (
    Feature,
    has_actions_selected,
    has_character,
    has_clips_selected,
    require_any,
)
from app.shell.context import Shell
from app.shell.places import PanelPlaces
from app.shell.workspace_keeper import Workspaces
from app.stage.navigation import NAVIGATIONS, choose_navigation, get_navigation
from app.translation import tr, tr_noop

if TYPE_CHECKING:
    from app.features.character.own_window import OwnWindow

FRAME = 1 / 30  # seconds of a step
FILE, PLAY, VIEW = "&File", "&Play", "&View"


class CharacterFeature(Feature):
    """Makes the panel of the character, and does the commands of this module."""

    def __init__(self, shell: Shell) -> None:
        super().__init__(shell)
        self.stage, self.transport = shell.stage, self.session.transport
        self.own_window: OwnWindow | None = None

    @property
    def panel(self) -> PreviewPanel:
        found: PreviewPanel = self.shell.panel("character")
        return found

    def make_panel(self) -> PreviewPanel:
        shell, stage = self.shell, self.stage
        panel = PreviewPanel(
            self.session,
            stage.performance,
            stage.playhead,
            stage.figures,
            shell.widget,
            lambda: shell.actions["character"].trigger(),
            lambda: shell.actions["character"].isEnabled(),
        )
        panel.mesh_button = MeshButton(panel, self.show_meshes)
        panel.watch_button.menu_of.aboutToShow.connect(lambda: fill_watch(shell, panel.watch_button.menu_of))
        panel.view.failed.connect(shell.tell)
        panel.view.painted.connect(lambda _: stage.painted.emit())
        shell.services[Workspaces].changed.connect(lambda: panel.set_bare(shell.services[PanelPlaces].alone))
        return panel

    # --- which character

    def choose_character(self) -> None:
        from app.features.character.character_gallery import CharacterGallery

        CharacterGallery(self.shell).show()

    def show_meshes(self) -> None:
        from app.features.character.meshes_dialog import MeshesDialog

        MeshesDialog(self.document, self.stage.figures, self.shell.widget).show()

    def draw_default_body(self) -> None:
        character_choice.draw_default_body(self.shell)

    # --- transport

    def play_or_pause(self) -> None:
        self.transport.set_playing(not self.transport.playing)

    def go_to_start(self) -> None:
        self.transport.seek(0.0)

    def step_back(self) -> None:
        self._step(-FRAME)

    def step_forward(self) -> None:
        self._step(FRAME)

    def _step(self, seconds: float) -> None:
        self.transport.set_playing(False)
        self.transport.seek(self.transport.seconds + seconds)

    def toggle_mute(self) -> None:
        self.stage.sound.set_muted(not self.stage.sound.muted)

    def is_muted(self) -> bool:
        return self.stage.sound.muted

    def toggle_loop(self) -> None:
        self.panel.toggle_loop()

    def loops(self) -> bool:
        return self.transport.loop

    def show_performance(self) -> None:
        self.transport.show_plan()

    def shows_performance(self) -> bool:
        return self.transport.show == "plan"

    def play_alone(self) -> None:
        """Play the first selected clip, else that of the first selected action."""
        selection = self.session.selection
        clips = (*selection.clips, *(a.clip for a in selection.selected_actions()))
        if clips:
            self.transport.show_clip(clips[0])

    def play_in_context(self) -> None:
        selected = (*self.session.selection.actions, *self.session.selection.clips)
        if selected:
            self.session.show_context(selected[0])

    # --- view

    def frame(self) -> None:
        self.panel.frame_all()

    def frame_face(self) -> None:
        self.panel.frame_face()

    def fill_navigation(self, menu: QMenu) -> None:
        """Offer the ways in which the mouse moves the camera."""
        for ident, navigation in NAVIGATIONS.items():
            action = menu.addAction(tr(navigation.title))
            action.triggered.connect(lambda _, chosen=ident: self.navigate_as(chosen))
            action.setToolTip(tr(navigation.words))
            action.setCheckable(True)
            action.setChecked(get_navigation().id == ident)
        menu.setToolTipsVisible(True)

    def navigate_as(self, ident: str) -> None:
        choose_navigation(ident)
        self.panel.show_navigation()

    def see_from(self, side: str) -> None:
        self.panel.looking.see_from(side)

    def see_hands(self) -> None:
        self.panel.looking.see_hands()

    def toggle_flat(self) -> None:
        self.panel.looking.set_flat(not self.is_flat())

    def is_flat(self) -> bool:
        return self.panel.looking.flat

    def toggle_turntable(self) -> None:
        self.panel.looking.set_turning(not self.turns())

    def turns(self) -> bool:
        return self.panel.looking.turning

    def toggle_trails(self) -> None:
        self.panel.looking.set_trailing(not self.shows_trails())

    def shows_trails(self) -> bool:
        return self.panel.looking.trailing

    def copy_picture(self) -> None:
        self.panel.looking.copy()

    def toggle_skeleton(self) -> None:
        self.panel.toggle_bones()

    def shows_skeleton(self) -> bool:
        return self.panel.bones

    def toggle_own_window(self) -> None:
        """Show the character in a window of its own, too, or close that."""
        if self.own_window is not None:
            self.own_window.close()
            return
        from app.features.character.own_window import OwnWindow

        self.own_window = OwnWindow(self.panel, self.panel.scene, self.shell.widget)
        self.own_window.closed.connect(self._forget_window)
        self.panel.shown_elsewhere = True
        self.own_window.show()
        self.shell.actions.refresh_soon()

    def has_own_window(self) -> bool:
        return self.own_window is not None

    def _forget_window(self) -> None:
        self.own_window, self.panel.shown_elsewhere = None, False
        self.shell.actions.refresh_soon()

    def close(self) -> None:
        """Stop drawing, at closing."""
        if self.own_window is not None:
            self.own_window.close()
        self.panel.stop()

    def show_only_character(self) -> None:
        places = self.shell.services[PanelPlaces]
        places.only("character")
        self.panel.set_bare(places.alone)


SIDES = {
    "front": (tr_noop("From the f&ront"), "Num+1"),
    "left": (tr_noop("From its &left"), "Num+3"),
    "right": (tr_noop("From its ri&ght"), "Ctrl+Num+3"),
    "back": (tr_noop("From b&ehind"), "Ctrl+Num+1"),
    "quarter": (tr_noop("&Three quarters"), "Num+9"),
    "above": (tr_noop("From a&bove"), "Num+7"),
}
COMMANDS = (
    Command(
        "character",
        FILE,
        "character",
        tr_noop("Choose &character…"),
        CharacterFeature.choose_character,
        tip=tr_noop("Choose who is drawn: Ada, Ben, the default body or a GLB, glTF or VRM file of yours"),
    ),
    Command(
        "meshes",
        FILE,
        "character",
        tr_noop("&Meshes of the character…"),
        CharacterFeature.show_meshes,
        tip=tr_noop("Hide or show parts of the character, such as clothes"),
        enabled=has_character,
    ),
    Command(
        "no_character",
        FILE,
        "character",
        tr_noop("Draw the default body"),
        CharacterFeature.draw_default_body,
        enabled=has_character,
    ),
    Command(
        "play",
        PLAY,
        "transport",
        tr_noop("Play or &pause"),
        CharacterFeature.play_or_pause,
        ("Space",),
        study=True,
    ),
    Command(
        "to_start",
        PLAY,
        "transport",
        tr_noop("Back to the &start"),
        CharacterFeature.go_to_start,
        ("Home",),
        study=True,
    ),
    Command(
        "back", PLAY, "transport", tr_noop("Previous frame"), CharacterFeature.step_back, (",",), study=True
    ),
    Command(
        "forward",
        PLAY,
        "transport",
        tr_noop("Next frame"),
        CharacterFeature.step_forward,
        (".",),
        study=True,
    ),
    Command(
        "mute",
        PLAY,
        "live",
        tr_noop("&Mute"),
        CharacterFeature.toggle_mute,
        ("Ctrl+M",),
        checked=CharacterFeature.is_muted,
        study=True,
    ),
    Command(
        "loop",
        PLAY,
        "live",
        tr_noop("&Loop"),
        CharacterFeature.toggle_loop,
        ("L",),
        checked=CharacterFeature.loops,
        study=True,
    ),
    Command(
        "show_plan",
        PLAY,
        "show",
        tr_noop("Play the whole &performance"),
        CharacterFeature.show_performance,
        ("Escape",),
        checked=CharacterFeature.shows_performance,
        study=True,
    ),
    Command(
        "alone",
        PLAY,
        "show",
        tr_noop("Play only the &clip"),
        CharacterFeature.play_alone,
        ("Ctrl+Return",),
        enabled=require_any(has_clips_selected, has_actions_selected),
        study=True,
    ),
    Command(
        "in_context",
        PLAY,
        "show",
        tr_noop("Play in &context"),
        CharacterFeature.play_in_context,
        ("Shift+Return",),
        enabled=require_any(has_clips_selected, has_actions_selected),
        study=True,
    ),
    Command(
        "frame",
        VIEW,
        "character",
        tr_noop("&Frame the character"),
        CharacterFeature.frame,
        ("F",),
        study=True,
    ),
    Command(
        "face",
        VIEW,
        "character",
        tr_noop("Close-up of the &face"),
        CharacterFeature.frame_face,
        ("Shift+F",),
        study=True,
    ),
    *(
        Command(
            f"see_{side}",
            VIEW,
            "sides",
            words,
            partial(CharacterFeature.see_from, side=side),
            (key,),
            study=True,
        )
        for side, (words, key) in SIDES.items()
    ),
    Command(
        "see_hands",
        VIEW,
        "sides",
        tr_noop("Close-up of the &hands"),
        CharacterFeature.see_hands,
        ("Shift+H",),
        study=True,
    ),
    Command(
        "flat",
        VIEW,
        "sides",
        tr_noop("&Orthographic"),
        CharacterFeature.toggle_flat,
        ("Num+5",),
        checked=CharacterFeature.is_flat,
        tip=tr_noop("Show everything without perspective"),
        study=True,
    ),
    Command(
        "turntable",
        VIEW,
        "sides",
        tr_noop("T&urntable"),
        CharacterFeature.toggle_turntable,
        checked=CharacterFeature.turns,
        study=True,
    ),
    Command(
        "navigation",
        VIEW,
        "sides",
        tr_noop("&Navigation"),
        tip=tr_noop("Choose how the mouse or touchpad moves the camera"),
        fill=CharacterFeature.fill_navigation,
        study=True,
    ),
    Command(
        "trails",
        VIEW,
        "sides",
        tr_noop("Motion paths of hands an&d head"),
        CharacterFeature.toggle_trails,
        ("Shift+T",),
        checked=CharacterFeature.shows_trails,
        tip=tr_noop("Show where they were and will be, with a dot for each frame"),
        study=True,
    ),
    Command(
        "copy_picture",
        VIEW,
        "character",
        tr_noop("&Copy the picture"),
        CharacterFeature.copy_picture,
        ("Ctrl+Shift+C",),
        tip=tr_noop("Copies the view to the clipboard"),
    ),
    Command(
        "bones",
        VIEW,
        "character",
        tr_noop("Show the &skeleton"),
        CharacterFeature.toggle_skeleton,
        ("B",),
        checked=CharacterFeature.shows_skeleton,
        study=True,
    ),
    Command(
        "big",
        VIEW,
        "character",
        tr_noop("Show only the &character"),
        CharacterFeature.show_only_character,
        ("F11",),
        study=True,
    ),
    Command(
        "own_window",
        VIEW,
        "character",
        tr_noop("Character in its own &window"),
        CharacterFeature.toggle_own_window,
        ("Shift+F11",),
        tip=tr_noop("For a second screen or a recording: right-click it for its background and full screen"),
        checked=CharacterFeature.has_own_window,
    ),
)
