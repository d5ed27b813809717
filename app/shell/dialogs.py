"""What the window opens over itself; every dialog is imported when it is first wanted."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtGui import QKeySequence
from PySide6.QtWidgets import QFileDialog, QMessageBox

from app.look.plural import clips_words
from app.look.theme import KIND_MARKS
from metagraph.graph import edits
from metagraph.graph.model import KINDS

if TYPE_CHECKING:
    from app.shell.window import Window


class Dialogs:
    """Opens the window's dialogs on what is selected in it."""

    def __init__(self, window: Window) -> None:
        self.window = window

    def batch(self, what: str) -> None:
        """Edit the selected actions together: "rename", "paste" or "replace"."""
        w = self.window
        if what == "paste" and w.manual.takes("paste"):
            return
        from app.features.batch import batch_dialogs as batch

        actions, copied = w.session.actions, w.session.copied
        if what == "paste" and copied is not None:
            batch.PasteDialog(w.document, copied, actions, w).open()
        elif what != "paste" and actions:
            kind = batch.RenameDialog if what == "rename" else batch.ReplaceDialog
            kind(w.document, actions, w).open()

    def make_twins(self) -> None:
        """Make left/right twins of the selected actions or clips."""
        w = self.window
        from app.features.twins.twin_command import make_twins

        make_twins(w)

    def repairs(self, title: str = "", clips: tuple[str, ...] = (), lines: tuple[str, ...] = ()) -> None:
        """Show what reading clips put right: those given, else the selected ones, else all."""
        w = self.window
        from app.features.repairs.repairs_dialog import RepairsDialog

        chosen = clips or w.session.clips or tuple(a.clip for a in w.session.selected_actions()) or tuple(w.document.project.clips)
        words = title or f"Repairs of {clips_words(len(set(chosen)))}"
        RepairsDialog(w.document, w.jobs, words, dict.fromkeys(chosen), lines, w).show()

    def label(self) -> None:
        """Go through proposals for the clips that are not placed yet."""
        w = self.window
        from app.features.labelling.review_dialog import ReviewDialog

        ReviewDialog(w.document, w.session, w.jobs, w.figures, w.learned, w).show()

    def compatibility(self) -> None:
        """Show which clip can enter and leave which stance."""
        w = self.window
        from app.features.compatibility.matrix_dialog import MatrixDialog

        dialog = w.findChild(MatrixDialog) or MatrixDialog(w.document, w.session, w.compatibility, w.jobs, w)
        dialog.show()
        dialog.raise_()
        dialog.activateWindow()

    def motion_graph(self) -> None:
        """Show the motion graph of takes."""
        w = self.window
        from app.features.motion_graph.motion_graph_dialog import MotionGraphDialog

        dialog = w.findChild(MotionGraphDialog) or MotionGraphDialog(w.document, w.session, w.jobs, w)
        dialog.show()
        dialog.raise_()
        dialog.activateWindow()

    def patterns(self) -> None:
        """Show what words in clip names mean, and what was learned."""
        w = self.window
        from app.features.labelling.patterns_dialog import PatternsDialog

        PatternsDialog(w.document, w.session, w.learned, w).open()

    def choose_character(self) -> None:
        w = self.window
        start = str(w.document.folder or Path.home())
        name, _ = QFileDialog.getOpenFileName(w, "Choose the character to draw", start, "Characters (*.glb *.gltf *.vrm)")
        if name:
            from metagraph.formats.store import relative

            folder = w.document.folder
            path = relative(Path(name), folder) if folder is not None else Path(name).as_posix()
            from metagraph.errors import FileError
            from metagraph.formats.gltf import morph_targets
            from metagraph.graph.face import with_morphs

            try:
                morphs = morph_targets(name)
            except FileError as error:
                w.tell(str(error))
                return
            w.document.edit("Choose character", lambda p: with_morphs(edits.set_character(p, path), morphs))

    def skeleton(self) -> None:
        w = self.window
        from app.features.skeleton.skeleton_dialog import SkeletonDialog

        SkeletonDialog(w.document, w.session, w).open()

    def annotate(self, path: str = "") -> None:
        """Import an annotation; without a path it is asked for."""
        w = self.window
        from app.features.models.annotation_dialog import open_annotation

        open_annotation(w, path)

    def mimic(self, path: str = "") -> None:
        """Mimic keypoints; without a path they are asked for."""
        w = self.window
        from app.features.mimic.mimic_dialog import open_keypoints

        open_keypoints(w, path)

    def converse(self, paths: Sequence[Path] = ()) -> None:
        """Read a conversation from sounds and transcripts; without any they are asked for."""
        from app.features.conversation import conversation_commands as offers

        offers.converse(self.window, paths)

    def rename_conversation(self) -> None:
        from app.features.conversation import conversation_commands as offers

        offers.rename(self.window)

    def graph_again(self) -> None:
        """Let the graph move both again, instead of new motion that was found for them."""
        from app.features.conversation import conversation_commands as offers

        offers.graph_again(self.window)

    def rates(self) -> None:
        """Set how often each of the two moves with what is said."""
        from app.features.conversation import conversation_commands as offers

        offers.rates(self.window)

    def word_lists(self) -> None:
        """Change which words make a segment a response or a hesitation."""
        from app.features.conversation import conversation_commands as offers

        offers.word_lists(self.window)

    def side_sounds(self) -> None:
        """Say who the two are and which sound is whose."""
        from app.features.conversation import conversation_commands as offers

        offers.side_sounds(self.window)

    def write_segments(self) -> None:
        """Write the segments as an ELAN file or a TextGrid."""
        from app.features.conversation import conversation_commands as offers

        offers.write_segments(self.window)

    def remove_conversation(self) -> None:
        from app.features.conversation import conversation_commands as offers

        offers.remove(self.window)

    def export(self) -> None:
        w = self.window
        from app.features.export.export_dialog import ExportDialog

        ExportDialog(w.document, w.jobs, w, w.session.mode == "manual").open()

    def render(self) -> None:
        w = self.window
        from app.features.render.render_dialog import RenderDialog

        RenderDialog(w.performance, w.session, w.jobs, w).open()

    def run_study(self) -> None:
        """Lead a participant through a timing study; which and who is asked."""
        w = self.window
        from app.features.study.study_chooser import run_study

        run_study(w)

    def keys(self) -> None:
        w = self.window
        rows = []
        for command in w.actions.commands:
            keys = ", ".join(k.toString(QKeySequence.SequenceFormat.NativeText) for k in w.actions[command.id].shortcuts())
            if keys and not command.id.startswith("stance_"):
                rows.append(f"<tr><td style='padding-right:24px'>{command.text.replace('&', '')}</td><td><b>{keys}</b></td></tr>")
        rows.append("<tr><td>Stance 1 to 9</td><td><b>Ctrl+1 … Ctrl+9</b></td></tr>")
        rows.append("<tr><td colspan=2>In a conversation: 1 2 3 label, S split, M merge, P stress, Tab and arrows choose</td></tr>")
        box = QMessageBox(
            QMessageBox.Icon.NoIcon, "Keyboard shortcuts", f"<table>{''.join(rows)}</table>", QMessageBox.StandardButton.Ok, w
        )
        box.open()

    def about(self) -> None:
        w = self.window
        from metagraph import __version__

        kinds = " &nbsp; ".join(f"{KIND_MARKS[k]} {k}" for k in KINDS)
        text = f"<h3>Metagraph {__version__}</h3><p>Drop clips; the state machine draws itself.</p><p>{kinds}</p>"
        QMessageBox.about(w, "About Metagraph", text)
