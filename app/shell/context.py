"""Define what the shell and the features know of each other: a feature's `contribute(shell)` takes a `Shell`
and returns a `Contribution`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, Protocol, TypeVar

if TYPE_CHECKING:
    from PySide6.QtCore import QSettings
    from PySide6.QtWidgets import QMainWindow, QWidget

    from app.project.document import Document
    from app.project.importing import FileDrop
    from app.project.jobs import Jobs
    from app.shell.actions import Actions, Command
    from app.stage.stage import Stage

T = TypeVar("T")
When = Literal["any", "meta", "manual"]
Place = Literal["left", "right", "right below", "bottom", "centre", "beside"]


class Services:
    """The services that lower layers offer to all features, by class: `services[Files]`."""

    def __init__(self) -> None:
        self._by_class: dict[type, Any] = {}

    def add(self, service: T) -> T:
        """Offer a service under its own class; return it. Raises ValueError if there is one already."""
        if type(service) in self._by_class:
            raise ValueError(f"there is a {type(service).__name__} already")
        self._by_class[type(service)] = service
        return service

    def __getitem__(self, kind: type[T]) -> T:
        """Return the service of a class. Raises LookupError if there is none."""
        try:
            found: T = self._by_class[kind]
        except KeyError:
            raise LookupError(f"nobody offers a {kind.__name__}") from None
        return found


class Shell(Protocol):
    """What a feature gets. `widget` is the window as Qt knows it, the parent of dialogs. `settings` are kept
    between runs of the program.
    """

    document: Document
    stage: Stage
    jobs: Jobs
    services: Services
    actions: Actions

    @property
    def widget(self) -> QMainWindow: ...

    @property
    def settings(self) -> QSettings: ...

    def tell(self, words: str) -> None:
        """Show a message in the status bar."""

    def panel(self, ident: str) -> Any:
        """Return a panel's widget, which is made now if it was not yet. Raises LookupError if there is no
        such panel.
        """

    def show(self, ident: str, on: bool = True) -> None:
        """Show a panel in front of those with the same place, or hide it."""


@dataclass(frozen=True)
class Panel:
    """A panel of the window.

    `make` makes its widget. `place` is where it is when all panels are shown at once. A `late` panel is made
    when it is first seen or needed, and not before the first picture. `when` is the mode in which it is
    shown, and `instead_of` the panel whose place it then takes. `study` says whether it is shown during a
    study's task. `imports` are modules that are imported on a thread before it is made for being seen.

    `where` has, by workspace, the area in which it is; the first workspace is its home. `opens` has, by
    workspace, the area in which it opens on demand. `rank` says which of an area's panels is in front: the
    lowest. `least` is the width and height in pixels to which it can always shrink; content that needs more
    room is scrolled.
    """

    id: str
    title: str
    place: Place
    make: Callable[[], QWidget]
    late: bool = True
    when: When = "any"
    instead_of: str = ""
    study: bool = True
    where: Mapping[str, str] = field(default_factory=dict)
    opens: Mapping[str, str] = field(default_factory=dict)
    rank: int = 5
    least: tuple[int, int] = (200, 90)
    imports: tuple[str, ...] = ()


@dataclass(frozen=True)
class HeaderItem:
    """Something in the bar on top. `side` is left, middle or right. `make` makes its widget, or is the id of
    a command to show as a button.
    """

    side: Literal["left", "middle", "right"]
    make: Callable[[QWidget], QWidget] | str


@dataclass(frozen=True)
class Contribution:
    """What a feature adds to the window. `close` is called when the window closes."""

    panels: tuple[Panel, ...] = ()
    commands: tuple[Command, ...] = ()
    header: tuple[HeaderItem, ...] = ()
    drops: tuple[FileDrop, ...] = ()
    close: Callable[[], object] | None = None


Contribute = Callable[[Shell], Contribution]
