"""The table of the window's commands."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from app.features.manual.manual_place import META_ONLY
from app.project.files import PRACTICE, SAMPLE
from app.shell.actions import Command, Standard
from metagraph.graph import edits
from metagraph.graph.model import KINDS, LAYERS

if TYPE_CHECKING:
    from app.shell.window import Window

CONVERSATION = ("converse", "rename_conversation", "rates", "word_lists", "side_sounds", "write_segments", "remove_conversation")
LAYER_KEYS = {"body": "Alt+1", "arms": "Alt+2", "head": "Alt+3"}


def commands(window: Window) -> tuple[Command, ...]:
    """Return every command, in the order of the menus."""
    s, d, f, c, o = window.session, window.document, window.files, window.canvas, window.dialogs
    some = lambda: bool(s.clips or s.actions)  # noqa: E731
    drawn = lambda: bool(s.states or s.links)  # noqa: E731
    gone = lambda: bool(s.clips or s.actions or s.asks or drawn())  # noqa: E731
    out = [
        Command("new", "&File", "&New project", f.new, (Standard.New,)),
        Command("open", "&File", "&Open…", f.ask_open, (Standard.Open,)),
        Command("sample", "&File", "Open the &sample project", lambda: f.open(SAMPLE, template=True)),
        Command("practice", "&File", "Open the &practice project", lambda: f.open(PRACTICE, template=True), tip="152 clips to label"),
        Command("save", "&File", "&Save", f.save, (Standard.Save,), line=True),
        Command("save_as", "&File", "Save &as…", f.save_as, (Standard.SaveAs,)),
        Command("import", "&File", "&Import folder…", f.ask_import_folder, ("Ctrl+I",), line=True, icon="folder"),
        Command("import_files", "&File", "Import &files…", f.ask_import_files, ("Ctrl+Shift+I",)),
        Command("annotate", "&File", "Import &annotation…", o.annotate, tip="Learn from an ELAN file what follows what"),
        Command("watch", "&File", "Follow changed &files", window.toggle_watching, checked=lambda: window.watcher.on,
                tip="Clips that are exported again are read again, in place"),
        Command("find_missing", "&File", "Find missing files…", f.find_missing),
        Command("character", "&File", "Choose &character…", o.choose_character, line=True, tip="The GLB that is drawn"),
        Command("no_character", "&File", "Draw a stick figure",
                lambda: d.edit("Draw a stick figure", lambda p: edits.set_character(p, None)),
                enabled=lambda: d.project.character is not None),
        Command("export", "&File", "&Export…", o.export, ("Ctrl+E",), line=True, icon="export", tip="JSON and GLB for engines",
                enabled=lambda: any(True for _ in d.project.actions()) or any(m.states for m in d.project.manual.values())),
        Command("render", "&File", "&Write performance…", o.render, ("Ctrl+R",), tip="Video with sound, contact sheet, or motion",
                enabled=lambda: d.project.skeleton is not None),
        Command("quit", "&File", "&Quit", window.close, (Standard.Quit, "Ctrl+Q"), line=True),
        Command("undo", "&Edit", "&Undo", d.undo, (Standard.Undo,), icon="undo", enabled=d.undo_stack.canUndo),
        Command("redo", "&Edit", "&Redo", d.redo, (Standard.Redo, "Ctrl+Y"), icon="redo", enabled=d.undo_stack.canRedo),
        Command("delete", "&Edit", "&Remove", window.remove, (Standard.Delete,), enabled=gone, line=True),
        Command("rename", "&Edit", "Re&name…", window.rename, ("F2",)),
        Command("copy", "&Edit", "&Copy properties", window.copy_properties, (Standard.Copy,), line=True,
                enabled=lambda: len(s.actions) == 1 or drawn()),
        Command("paste", "&Edit", "&Paste properties…", lambda: o.batch("paste"), (Standard.Paste,),
                tip="Give the selected actions what another one has",
                enabled=lambda: s.mode == "manual"
                or (bool(s.actions) and s.copied is not None and d.project.action(s.copied) is not None)),
        Command("replace_clip", "&Edit", "Replace c&lip…", lambda: o.batch("replace"), tip="Another clip, the same settings",
                enabled=lambda: bool(s.actions)),
        Command("twins", "&Edit", "Make &mirrored twin", o.make_twins, tip="The same to the other side, as new clips and actions",
                enabled=some),
        Command("repairs", "&Edit", "Repa&irs…", o.repairs, tip="What reading the files put right, and what to leave as it is",
                enabled=lambda: bool(d.project.clips)),
        Command("select_all", "&Edit", "Select &all", window.select_all, (Standard.SelectAll,), line=True),
        Command("find", "&Edit", "&Find clip", window.library.search.setFocus, (Standard.Find,)),
        Command("manual", "&Graph", "&Manual state machine", lambda: s.set_mode("meta" if s.mode == "manual" else "manual"),
                checked=lambda: s.mode == "manual", tip="Draw states and links one by one, as in the engines' editors"),
        Command("new_stance", "&Graph", "&New stance…", c.new_stance, ("Ctrl+Shift+N",)),
    ]  # fmt: skip
    out.append(
        Command("propose", "&Graph", "&Label clips…", o.label, ("Ctrl+P",), tip="Propose what each clip is, by name and motion",
                enabled=lambda: any(clip not in d.project.uses for clip in d.project.clips))
    )  # fmt: skip
    out.append(
        Command("use_times", "&Graph", "Use proposed &times", lambda: window.compatibility.use_proposed(s.actions),
                tip="Begin and end where no jump shows", enabled=lambda: bool(s.actions) and window.compatibility.judged is not None)
    )  # fmt: skip
    out.append(
        Command("motion_graph", "&Graph", "Motion &graph of takes…", o.motion_graph, tip="New motion from takes, and clips cut from them",
                enabled=lambda: bool(d.project.clips))
    )  # fmt: skip
    out.append(Command("patterns", "&Graph", "Name &patterns…", o.patterns, tip="What words in clip names mean"))
    for number, kind in enumerate(KINDS, 1):
        text = f"Label as &{number} {kind}"
        out.append(
            Command(f"label_{kind}", "&Graph", text, lambda k=kind: c.place_selection(k), (str(number),), enabled=some, line=number == 1)
        )
    for layer in LAYERS:
        out.append(
            Command(f"layer_{layer}", "&Graph", f"{layer.capitalize()} layer", lambda x=layer: s.set_layer(x), (LAYER_KEYS[layer],),
                    checked=lambda x=layer: s.layer == x, line=layer == "body")
        )  # fmt: skip
    for number in range(1, 10):
        out.append(
            Command(f"stance_{number}", "&Graph", f"Stance {number}", lambda n=number: window.choose_stance(n - 1), (f"Ctrl+{number}",),
                    line=number == 1, enabled=lambda n=number: len(d.project.graphs[s.layer].stances) >= n)
        )  # fmt: skip
    out += [
        Command("skeleton", "&Graph", "S&keleton…", o.skeleton, line=True, tip="Roles and body parts of the joints",
                enabled=lambda: d.project.skeleton is not None),
        Command("joint_maps", "&Graph", "&Joint maps…", lambda: f.retargeting.change_maps(s.clips),
                tip="How clips of other skeletons were brought onto this one", enabled=lambda: bool(d.project.joint_maps)),
        Command("play", "&Play", "Play or &pause", lambda: s.set_playing(not s.playing), ("Space",)),
        Command("to_start", "&Play", "Back to the &start", lambda: s.seek(0.0), ("Home",)),
        Command("back", "&Play", "A frame back", lambda: window.step(-1), (",",)),
        Command("forward", "&Play", "A frame forward", lambda: window.step(1), (".",)),
        Command("live", "&Play", "Li&ve", window.toggle_live, ("Ctrl+L",), tip="Let programs on this machine drive the character",
                enabled=lambda: d.project.skeleton is not None, checked=lambda: window.performance.live is not None, line=True),
        Command("mimic", "&Play", "Mimic &keypoints…", o.mimic, tip="Let the character do as a person before a camera did",
                enabled=lambda: d.project.skeleton is not None and window.performance.live is None),
        Command("mute", "&Play", "&Mute", lambda: window.sound.set_muted(not window.sound.muted), ("Ctrl+M",),
                checked=lambda: window.sound.muted),
        Command("loop", "&Play", "&Loop", window.preview.toggle_loop, ("L",), checked=lambda: s.loop),
        Command("show_plan", "&Play", "The whole &performance", s.show_plan, ("Escape",), line=True, checked=lambda: s.show == "plan"),
        Command("alone", "&Play", "The clip &alone", window.play_alone, ("Ctrl+Return",), enabled=some),
        Command("in_context", "&Play", "In &context", window.play_in_context, ("Shift+Return",), enabled=some),
        *_of_conversations(window),
        Command("frame", "&View", "&Frame the character", window.preview.frame_all, ("F",)),
        Command("face", "&View", "Close-up of the &face", window.preview.frame_face, ("Shift+F",)),
        Command("bones", "&View", "Show the &skeleton", window.preview.toggle_bones, ("B",), checked=lambda: window.preview.bones),
        Command("machine", "&View", "The &machine beside the graph", window.show_machine, ("M",), line=True,
                checked=lambda: window._machine_wanted),
        Command("compatibility", "&View", "&Compatibility…", o.compatibility, ("Ctrl+K",),
                tip="Which clip enters and leaves which stance without a jump", enabled=lambda: bool(d.project.clips)),
        Command("big", "&View", "Only the &character", window.only_character, ("F11",)),
        Command("arrange", "&View", "&Put the panels back", window.docks.arrange),
        Command("theme", "&View", "&Light theme", window.toggle_theme, checked=lambda: s.theme == "light", line=True, icon="theme"),
        Command("study", "&Study", "&Run a study…", o.run_study, tip="Lead a participant through a timing study"),
        Command("count_operators", "&Study", "&Count operators", window.count_operators, checked=lambda: window.counting is not None,
                tip="Count keys, pointings, buttons and drags as they happen"),
        Command("keys", "&Help", "&Keyboard shortcuts", o.keys, ("F1",)),
        Command("about", "&Help", "&About Metagraph", o.about),
    ]  # fmt: skip
    return tuple(_of_meta(window, x) if x.id in META_ONLY else x for x in out)


def _moved(window: Window) -> bool:
    """Whether somebody on stage moves with new motion instead of a graph."""
    talk = window.document.project.conversations.get(window.session.conversation or "")
    return talk is not None and any(side.motion is not None for side in talk.sides)


def _of_conversations(window: Window) -> tuple[Command, ...]:
    """Return what can be done with the conversation on stage."""
    s, o = window.session, window.dialogs
    staged = lambda: s.conversation is not None  # noqa: E731
    menu = "&Conversation"
    return (
        Command("converse", menu, "Conversation from &sound…", o.converse, tip="Read what two say, and let both characters move with it"),
        Command("rename_conversation", menu, "Re&name conversation…", o.rename_conversation, enabled=staged, line=True),
        Command("rates", menu, "&Rates…", o.rates, enabled=staged, tip="How often each of the two gestures and nods"),
        Command("word_lists", menu, "&Word lists…", o.word_lists, enabled=staged, tip="Which words are responses, which hesitations"),
        Command("side_sounds", menu, "S&ounds and names…", o.side_sounds, enabled=staged, tip="Who the two are, and which sound is whose"),
        Command("other_side", menu, "The &other's plan", lambda: s.set_side(1 - s.side), enabled=staged, line=True,
                tip="Whose plan the timeline shows"),
        Command("graph_again", menu, "Move with the &graph again", o.graph_again, enabled=lambda: _moved(window),
                tip="Instead of new motion that was found for it"),
        Command("keep_conversation", menu, "&Keep as performances", window.performance.keep_conversation, enabled=staged,
                tip="What both do, as requests that can be edited one by one, and exported"),
        Command("write_segments", menu, "&Export segments…", o.write_segments, enabled=staged, tip="As ELAN or Praat TextGrid", line=True),
        Command("remove_conversation", menu, "Remove conversation", o.remove_conversation, enabled=staged, line=True),
    )  # fmt: skip


def _of_meta(window: Window, command: Command) -> Command:
    """Return a command that can be used only while the meta-graph is edited."""
    before = command.enabled
    return replace(command, enabled=lambda: window.session.mode == "meta" and (before is None or before()))
