"""A copy of a small project for each test, and a desk on it."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from app.authoring.desk import AuthorDesk
from app.authoring.project_file import AuthoredFile
from app.authoring.tool import make_plain


@pytest.fixture
def project_path(few: Path, tmp_path: Path) -> Path:
    """The file of a project that may be changed."""
    return Path(shutil.copytree(few.parent, tmp_path / "few")) / few.name


@pytest.fixture
def desk(project_path: Path) -> AuthorDesk:
    return AuthorDesk(AuthoredFile(project_path))


@pytest.fixture
def call(desk: AuthorDesk) -> Callable[..., dict[str, Any]]:
    """Calls a tool and returns what it told."""

    def do(tool: str, **given: Any) -> dict[str, Any]:
        return make_plain(desk.call(tool, given, lambda *_: None).told)

    return do
