"""The panel in which the character plays, its transport, and which character it is."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtWidgets import QFileDialog

from app.features.character.character_panel import PreviewPanel
from app.features.character.mesh_menu import MeshButton
from app.features.character.watch_commands import fill_watch, watch_commands
from app.project.files import Files
from app.shell.actions import Command
from app.shell.context import Contribution, Panel, Shell
from app.shell.places import Places
from app.shell.workspace_keeper import Workspaces
from app.translation import tr, tr_error
from metagraph.graph import edits

FRAME = 1 / 30  # seconds of a step


def contribute(shell: Shell) -> Contribution:
    session, document, stage = shell.stage.session, shell.document, shell.stage

    def make() -> PreviewPanel:
        panel = PreviewPanel(
            session,
            stage.performance,
            stage.playhead,
            stage.figures,
            shell.widget,
            lambda: shell.actions["character"].trigger(),
            lambda: shell.actions["character"].isEnabled(),
        )
        panel.mesh_button = MeshButton(panel, show_meshes)
        panel.watch_button.menu_of.aboutToShow.connect(lambda: fill_watch(shell, panel.watch_button.menu_of))
        panel.view.failed.connect(shell.tell)
        panel.view.painted.connect(lambda _: stage.painted.emit())
        shell.services[Workspaces].changed.connect(lambda: panel.set_bare(shell.services[Places].alone))
        return panel

    def preview() -> PreviewPanel:
        panel: PreviewPanel = shell.panel("character")
        return panel

    def step(frames: int) -> None:
        session.transport.set_playing(False)
        session.transport.seek(session.transport.seconds + frames * FRAME)

    def play_alone() -> None:
        clip = (
            session.selection.clips[0]
            if session.selection.clips
            else next((a.clip for a in session.selection.selected_actions()), None)
        )
        if clip is not None:
            session.transport.show_clip(clip)

    def play_in_context() -> None:
        ident = (
            session.selection.actions[0]
            if session.selection.actions
            else session.selection.clips[0]
            if session.selection.clips
            else None
        )
        if ident is not None:
            session.show_context(ident)

    def only() -> None:
        places = shell.services[Places]
        places.only("character")
        preview().set_bare(places.alone)

    def show_meshes() -> None:
        from app.features.character.meshes_dialog import MeshesDialog

        MeshesDialog(document, stage.figures, shell.widget).show()

    shell.services[Files].opened.connect(lambda: preview().frame_all())
    some = lambda: bool(session.selection.clips or session.selection.actions)  # noqa: E731
    sound, play, view = stage.sound, "&Play", "&View"
    return Contribution(
        panels=(
            Panel(
                "character",
                tr("Character"),
                "right",
                make,
                late=False,
                where={
                    "graph": "side",
                    "label": "side",
                    "time": "large",
                    "perform": "large",
                    "talk": "large",
                },
                least=(300, 230),
            ),
        ),
        commands=(
            Command(
                "character",
                "&File",
                "character",
                tr("Choose &character…"),
                lambda: choose_character(shell),
                tip=tr("The GLB that is drawn"),
            ),
            Command(
                "meshes",
                "&File",
                "character",
                tr("&Meshes of the character…"),
                show_meshes,
                tip=tr("Which of its meshes are drawn"),
                enabled=lambda: document.project.character is not None,
            ),
            Command(
                "no_character",
                "&File",
                "character",
                tr("Draw a stick figure"),
                lambda: document.edit(tr("Draw a stick figure"), lambda p: edits.set_character(p, None)),
                enabled=lambda: document.project.character is not None,
            ),
            Command(
                "play",
                play,
                "transport",
                tr("Play or &pause"),
                lambda: session.transport.set_playing(not session.transport.playing),
                ("Space",),
                study=True,
            ),
            Command(
                "to_start",
                play,
                "transport",
                tr("Back to the &start"),
                lambda: session.transport.seek(0.0),
                ("Home",),
                study=True,
            ),
            Command("back", play, "transport", tr("A frame back"), lambda: step(-1), (",",), study=True),
            Command("forward", play, "transport", tr("A frame forward"), lambda: step(1), (".",), study=True),
            Command(
                "mute",
                play,
                "live",
                tr("&Mute"),
                lambda: sound.set_muted(not sound.muted),
                ("Ctrl+M",),
                checked=lambda: sound.muted,
                study=True,
            ),
            Command(
                "loop",
                play,
                "live",
                tr("&Loop"),
                lambda: preview().toggle_loop(),
                ("L",),
                checked=lambda: session.transport.loop,
                study=True,
            ),
            Command(
                "show_plan",
                play,
                "show",
                tr("The whole &performance"),
                session.transport.show_plan,
                ("Escape",),
                checked=lambda: session.transport.show == "plan",
                study=True,
            ),
            Command(
                "alone",
                play,
                "show",
                tr("The clip &alone"),
                play_alone,
                ("Ctrl+Return",),
                enabled=some,
                study=True,
            ),
            Command(
                "in_context",
                play,
                "show",
                tr("In &context"),
                play_in_context,
                ("Shift+Return",),
                enabled=some,
                study=True,
            ),
            Command(
                "frame",
                view,
                "character",
                tr("&Frame the character"),
                lambda: preview().frame_all(),
                ("F",),
                study=True,
            ),
            Command(
                "face",
                view,
                "character",
                tr("Close-up of the &face"),
                lambda: preview().frame_face(),
                ("Shift+F",),
                study=True,
            ),
            *(
                Command(
                    f"see_{side}",
                    view,
                    "sides",
                    words,
                    lambda side=side: preview().looking.see_from(side),  # type: ignore[misc]
                    keys,
                    study=True,
                )
                for side, words, keys in (
                    ("front", tr("From the f&ront"), ("Num+1",)),
                    ("left", tr("From its &left"), ("Num+3",)),
                    ("right", tr("From its ri&ght"), ("Ctrl+Num+3",)),
                    ("back", tr("From b&ehind"), ("Ctrl+Num+1",)),
                    ("quarter", tr("&Three quarters"), ("Num+9",)),
                    ("above", tr("From a&bove"), ("Num+7",)),
                )
            ),
            Command(
                "see_hands",
                view,
                "sides",
                tr("Close-up of the &hands"),
                lambda: preview().looking.see_hands(),
                ("Shift+H",),
                study=True,
            ),
            Command(
                "flat",
                view,
                "sides",
                tr("&Orthographic"),
                lambda: preview().looking.set_flat(not preview().looking.flat),
                ("Num+5",),
                checked=lambda: preview().looking.flat,
                tip=tr("Near and far of one size"),
                study=True,
            ),
            Command(
                "turntable",
                view,
                "sides",
                tr("T&urntable"),
                lambda: preview().looking.set_turning(not preview().looking.turning),
                checked=lambda: preview().looking.turning,
                study=True,
            ),
            Command(
                "trails",
                view,
                "sides",
                tr("Trails of hands an&d head"),
                lambda: preview().looking.set_trailing(not preview().looking.trailing),
                ("Shift+T",),
                checked=lambda: preview().looking.trailing,
                tip=tr("Where they were and will be; a dot for each frame"),
                study=True,
            ),
            *watch_commands(shell, preview),
            Command(
                "copy_picture",
                view,
                "character",
                tr("&Copy the picture"),
                lambda: preview().looking.copy(),
                ("Ctrl+Shift+C",),
                tip=tr("The character as it stands, to the clipboard"),
            ),
            Command(
                "bones",
                view,
                "character",
                tr("Show the &skeleton"),
                lambda: preview().toggle_bones(),
                ("B",),
                checked=lambda: preview().bones,
                study=True,
            ),
            Command(
                "big",
                view,
                "character",
                tr("Only the &character"),
                only,
                ("F11",),
                study=True,
            ),
        ),
        close=lambda: preview().stop(),
    )


def choose_character(shell: Shell) -> None:
    """Ask which file the character is drawn from; it is read on a thread."""
    document = shell.document
    name, _ = QFileDialog.getOpenFileName(
        shell.widget,
        tr("Choose the character to draw"),
        str(document.folder or Path.home()),
        tr("Characters (*.glb *.gltf *.vrm)"),
    )
    if not name:
        return
    from metagraph.formats.characters import CharacterFile, look_at
    from metagraph.formats.store import relative

    folder = document.folder
    path = relative(Path(name), folder) if folder is not None else Path(name).as_posix()
    left, skeleton = document.project.character, document.project.skeleton

    def done(found: CharacterFile) -> None:
        if document.folder != folder or document.project.character != left:
            return
        if found.why_not is not None:
            shell.tell(
                tr(
                    "{name} is no character to draw: its mesh {why}.",
                    name=Path(name).name,
                    why=found.why_not,
                )
            )
            return
        document.edit(tr("Choose character"), found.into)
        for note in found.notes:
            shell.tell(note)

    shell.jobs.start(
        tr("Reading {name}", name=Path(name).name),
        lambda _: look_at(path, folder, skeleton),
        done,
        lambda error: shell.tell(tr_error(error)),
    )
