"""What the shell and the features know of each other: a feature's `contribute(shell)` takes a `Shell` and
returns a `Contribution`.
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
    """What the rooms below offer to all features, by class: `services[Files]`."""

    def __init__(self) -> None:
        self._by_class: dict[type, Any] = {}

    def add(self, service: T) -> T:
        """Offer a service under its own class; return it. Raises ValueError where there is one."""
        if type(service) in self._by_class:
            raise ValueError(f"there is a {type(service).__name__} already")
        self._by_class[type(service)] = service
        return service

    def __getitem__(self, kind: type[T]) -> T:
        """Return the service of a class. Raises LookupError where nobody offers one."""
        try:
            found: T = self._by_class[kind]
        except KeyError:
            raise LookupError(f"nobody offers a {kind.__name__}") from None
        return found


class Shell(Protocol):
    """What a feature is given. widget: the window as Qt knows it, the parent of dialogs. settings: kept
    between programs.
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
        """Say something in the status bar."""

    def panel(self, ident: str) -> Any:
        """Return a panel's widget, which is made now where it was not made yet. Raises LookupError where
        there is no such panel.
        """

    def show(self, ident: str, on: bool = True) -> None:
        """Show a panel in front of those it shares its place with, or hide it."""


@dataclass(frozen=True)
class Panel:
    """A panel of the window. make: its widget. place: where it stands where all stand at once. late: made
    when it is first seen or asked for, and not before the first picture. when: in which mode it is shown.
    instead_of: the panel whose place it takes then. study: whether it is shown while somebody works on a
    study's task. imports: modules that are imported on a thread before it is made because it is seen.

    where: by workspace the area in which it stands; the first is where it is at home. opens: by workspace
    the area in which it opens when it is asked for. rank: which of an area's panels is in front, the lowest.
    least: width and height in pixels, so small it can always be made; what needs more room is scrolled.
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
    """Something in the bar on top. side: left, middle or right. make: its widget, or the id of a command to
    show as a button.
    """

    side: Literal["left", "middle", "right"]
    make: Callable[[QWidget], QWidget] | str


@dataclass(frozen=True)
class Contribution:
    """What a feature adds to the window. close: called when the window closes."""

    panels: tuple[Panel, ...] = ()
    commands: tuple[Command, ...] = ()
    header: tuple[HeaderItem, ...] = ()
    drops: tuple[FileDrop, ...] = ()
    close: Callable[[], object] | None = None


Contribute = Callable[[Shell], Contribution]
