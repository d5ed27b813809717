"""Another character, body or voice for one who talks, chosen from what lies beside the project: a click on
the name, and one on the choice.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from pathlib import Path

from PySide6.QtWidgets import QMenu, QWidget

from app.project.document import Document
from app.project.speech_files import SOUNDS, count_channels
from app.translation import make_lazy_texts, tr, tr_error
from metagraph.formats.project.paths import make_path_relative
from metagraph.formats.store import SUFFIX
from metagraph.graph.conversation.edits import change_side
from metagraph.graph.conversation.model import Conversation, get_side_name
from metagraph.graph.edit_error import EditError

BODIES = (".glb", ".gltf")
MOST = 24  # files of a kind that a menu offers; all others are chosen in the dialog
LOOKED_AT = 2000  # files of a folder
EARS = make_lazy_texts(lambda: (tr("left"), tr("right")))


def make_partner_menu(
    parent: QWidget, document: Document, ident: str, side: int, more: object = None
) -> QMenu:
    """Return the menu of one who talks. more: called for what the menu does not offer."""
    return fill_partner(QMenu(parent), document, ident, side, more)


def fill_partner(menu: QMenu, document: Document, ident: str, side: int, more: object = None) -> QMenu:
    conversation = document.project.conversations[ident]
    of = conversation.sides[side]

    def offer(inner: QMenu, words: str, chosen: bool, **changes: object) -> None:
        action = inner.addAction(words, partial(_set, document, ident, side, changes))
        action.setCheckable(True)
        action.setChecked(chosen)

    menu.setToolTipsVisible(True)
    body = menu.addMenu(tr("Character"))
    offer(body, tr("The character of its project"), of.character is None, character=None)
    used = (s.character for c in document.project.conversations.values() for s in c.sides)
    for path in _beside(document, BODIES, (*used, document.project.character)):
        offer(body, Path(path).stem, path == of.character, character=path)
    mover = menu.addMenu(tr("Body language from"))
    offer(mover, tr("This project"), of.project is None, project=None)
    used = (s.project for c in document.project.conversations.values() for s in c.sides)
    own = document.path.resolve() if document.path is not None else None
    for path in _beside(document, (SUFFIX,), used):
        if own is None or ((document.folder or Path()) / path).resolve() != own:
            offer(mover, Path(path).name.removesuffix(SUFFIX), path == of.project, project=path)
    voice = menu.addMenu(tr("Voice"))
    offer(voice, tr("No sound"), of.audio is None, audio=None, channel=None)
    for path in _beside(document, SOUNDS, (s.audio for s in conversation.sides)):
        count = count_channels((document.folder or Path()) / path)
        name = Path(path).name
        for channel in (None,) if count < 2 else range(count):
            ear = (
                ""
                if channel is None
                else f", {EARS[channel] if count == 2 else tr('channel {number}', number=channel + 1)}"
            )
            here = path == of.audio and of.channel == channel
            offer(voice, f"{name}{ear}", here, audio=path, channel=channel)
    for inner, tip in (
        (body, tr("The character mesh of this speaker")),
        (mover, tr("The project whose graph moves this speaker")),
        (voice, tr("The sound of this speaker. The words and segments do not change.")),
    ):
        inner.setToolTipsVisible(True)
        inner.menuAction().setToolTip(tip)
    if callable(more):
        menu.addSeparator()
        menu.addAction(tr("More options and position…"), more)
    return menu


def fill_all(menu: QMenu, document: Document, ident: str, more: object = None) -> None:
    """Fill a menu with one for each who talks."""
    conversation: Conversation = document.project.conversations[ident]
    for side in range(len(conversation.sides)):
        fill_partner(menu.addMenu(get_side_name(conversation, side)), document, ident, side, more)


def _set(document: Document, ident: str, side: int, changes: dict[str, object]) -> None:
    words = {
        "character": tr("Change character"),
        "project": tr("Change body language"),
        "audio": tr("Change voice"),
    }
    text = next(t for name, t in words.items() if name in changes)
    try:
        document.edit(text, lambda p: change_side(p, ident, side, **changes))
    except EditError as error:
        document.failed.emit(tr_error(error))


def _beside(document: Document, suffixes: tuple[str, ...], used: Iterable[str | None]) -> list[str]:
    """Return paths of files of some kinds: what is used already, then those in the folders of what is used
    and of the project, relative to it.
    """
    folder = document.folder or Path()
    known = list(dict.fromkeys(x for x in used if x is not None))
    out = [x for x in known if x.lower().endswith(suffixes)]
    for place in dict.fromkeys((folder, *((folder / x).parent for x in known))):
        try:
            found = sorted(x for x in _some(place) if x.name.lower().endswith(suffixes))
        except OSError:
            continue
        paths = [
            make_path_relative(x, folder) if document.folder is not None else x.as_posix() for x in found
        ]
        out += [x for x in paths if x not in out]
    return out[:MOST]


def _some(place: Path) -> list[Path]:
    """Return the first so many files of a folder."""
    return [x for _, x in zip(range(LOOKED_AT), place.iterdir(), strict=False)]
