"""Read and write name patterns as a file, for a team or for a run without a window."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

from app.translation import tr, tr_error, tr_noop
from metagraph.common.budgets import LIST_FILE
from metagraph.common.files import read_file
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically

if TYPE_CHECKING:
    from metagraph.suggest.words.patterns import Patterns

REMEDY = tr_noop("Export name patterns from the window, or write them as docs/animators/label-files.md says.")


def read_patterns(path: Path) -> Patterns:
    """Return the patterns in a file. Raises FileError naming the place."""
    from metagraph.suggest.words.patterns import Patterns, PatternsError

    try:
        return Patterns.from_json(json.loads(read_file(path, LIST_FILE).decode("utf-8")))
    except json.JSONDecodeError as error:
        raise FileError(
            path,
            tr("it is not JSON: {why}", why=error.msg),
            tr("line {number}", number=error.lineno),
            tr(REMEDY),
        ) from None
    except (UnicodeDecodeError, RecursionError):
        raise FileError(path, tr("it is not JSON"), tr("while reading name patterns"), tr(REMEDY)) from None
    except PatternsError as error:
        raise FileError(path, tr_error(error), tr("while reading name patterns"), tr(REMEDY)) from None


def write_patterns(path: Path, patterns: Patterns) -> None:
    """Write patterns, whole or not at all. Raises FileError."""
    write_atomically(path, (json.dumps(patterns.to_json(), ensure_ascii=False, indent=2) + "\n").encode())
