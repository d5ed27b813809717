"""What commands draw without a window needs no screen, and leaves no trace on what is started afterwards."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
DRAWING = (
    '<svg xmlns="http://www.w3.org/2000/svg" width="20mm" height="10mm"><text x="1" y="9">a</text></svg>'
)
PAPER = f"""
import os
from app.cli.study_papers import find_pdf_maker
paper = find_pdf_maker()({DRAWING!r})
print(paper[:5], os.environ.get("QT_QPA_PLATFORM"))
"""


def test_a_paper_is_made_without_a_screen_and_the_environment_stays_as_it_was() -> None:
    gone = ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM")
    environment = {k: v for k, v in os.environ.items() if k not in gone}
    done = subprocess.run(
        [sys.executable, "-c", PAPER], cwd=ROOT, env=environment, capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == "b'%PDF-' None"
