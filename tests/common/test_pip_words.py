"""What pip says is turned into plain words, and its failures into what to do."""

from __future__ import annotations

import pytest

from metagraph.common.pip_words import describe_pip_line, explain_pip_failure, find_download_size


@pytest.mark.parametrize(
    ("line", "words", "size"),
    [
        ("Collecting numba>=0.60", "Looking for numba…", 0),
        ("  Downloading numba-0.68.1-cp311-cp311-linux.whl (3.7 MB)", "Downloading numba, 3.7 MB…", 3.7e6),
        (
            "  Downloading numba-0.68.1-cp311-cp311-linux.whl.metadata (2.8 kB)",
            "Downloading numba, 0.0 MB…",
            2800,
        ),
        ("  Using cached llvmlite-0.50.0-cp311-linux.whl (56 MB)", "Downloading llvmlite…", 0),
        ("Processing /a folder/ufbx-0.0.5-cp311.whl", None, 0),
        ("Processing ./ufbx-0.0.5-cp311.whl", "Reading ufbx…", 0),
        ("Installing collected packages: llvmlite, numba", "Unpacking llvmlite, numba…", 0),
        ("Looking in links: folder", None, 0),
        ("", None, 0),
    ],
)
def test_a_line_of_pips_is_said_plainly(line, words, size):
    if words is not None or not line.startswith("Processing"):
        assert describe_pip_line(line) == words
    assert find_download_size(line) == size


@pytest.mark.parametrize(
    ("said", "from_folder", "words"),
    [
        ("WARNING: Retrying (Retry(total=1))\nERROR: No matching distribution found", False,
         "The network could not be reached"),
        ("ERROR: No matching distribution found for numba", False, "No numba>=0.60 was found"),
        ("ERROR: No matching distribution found for llvmlite<1", True, "folder has no llvmlite<1 that fits"),
        ("ERROR: Could not install: [Errno 28] No space left on device", False, "The disk is full"),
        ("ERROR: ResolutionImpossible: for help", False, "No version of numba>=0.60 fits"),
        ("SSLError(CERTIFICATE_VERIFY_FAILED)", False, "certificate is not trusted"),
        ("ERROR: [Errno 13] Permission denied: 'x'", False, "cannot be written to"),
        ("", False, "pip ended with 2"),
    ],
)  # fmt: skip
def test_a_failure_says_the_cause_and_the_remedy(said, from_folder, words):
    assert words in explain_pip_failure(said.splitlines(), 2, "numba>=0.60", from_folder)
