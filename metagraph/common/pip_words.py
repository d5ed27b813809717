"""What pip says, in plain words: its progress, and why it failed."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import PurePosixPath

from metagraph.common.wording import Phrase, phrase

_LOADING = re.compile(r"(?:Downloading|Using cached) (\S+?)(?: \(([\d.]+) ?([kMG]B)\))?$")
_UNITS = {"kB": 1e3, "MB": 1e6, "GB": 1e9}
NO_NETWORK = re.compile(
    r"NewConnectionError|ConnectTimeout|ReadTimeout|MaxRetryError|Failed to establish|name resolution|"
    r"Name or service not known|getaddrinfo|Network is unreachable|ProxyError|Could not fetch URL|Retrying \("
)


def describe_pip_line(line: str) -> Phrase | None:
    """Return what pip does now; None for a line that a user need not know."""
    line = line.strip()
    if line.startswith("Collecting "):
        return phrase("Looking for {package}…", package=_name(line.split()[1]))
    if found := _LOADING.match(line):
        package = _name(PurePosixPath(found[1]).name)
        size = find_download_size(line)
        if size:
            return phrase("Downloading {package}, {size:.1f} MB…", package=package, size=size / 1e6)
        return phrase("Downloading {package}…", package=package)
    if line.startswith("Processing "):
        return phrase("Reading {package}…", package=_name(PurePosixPath(line.split()[1]).name))
    if line.startswith("Installing collected packages"):
        return phrase("Unpacking {packages}…", packages=line.partition(": ")[2])
    return None


def find_download_size(line: str) -> float:
    """Return the bytes of the file that pip says it loads; 0.0 for another line."""
    found = _LOADING.match(line.strip())
    return float(found[2]) * _UNITS[found[3]] if found and found[2] and line.strip()[0] == "D" else 0.0


def explain_pip_failure(lines: Sequence[str], code: int, package: str, from_folder: bool) -> Phrase:
    """Return why pip failed, and what to do. lines: what it said. package: what was asked for."""
    said = "\n".join(lines)
    if "No space left" in said:
        return phrase("The disk is full. Make room and try again.")
    if "CERTIFICATE_VERIFY_FAILED" in said or "certificate verify failed" in said:
        return phrase(
            "The network's certificate is not trusted. Ask the people who look after your network "
            "for its certificate file, and name it in the variable SSL_CERT_FILE."
        )
    if "ResolutionImpossible" in said or "conflicting dependencies" in said:
        return phrase(
            "No version of {package} fits the packages that Metagraph has. Update Metagraph.", package=package
        )
    if from_folder and "No matching distribution" in said:
        missing = re.search(r"No matching distribution found for (\S+)", said)
        return phrase(
            "The folder has no {package} that fits this computer. Download the files again with the "
            "line below.",
            package=missing[1] if missing else package,
        )
    if NO_NETWORK.search(said):
        return phrase(
            "The network could not be reached. Check the network and try again, or bring the files from "
            "another computer, as described below."
        )
    if "No matching distribution" in said:
        return phrase(
            "No {package} was found for this Python and this system. Check the network and try again, or "
            "bring the files from another computer, as described below.",
            package=package,
        )
    if "Permission denied" in said:
        return phrase("The folder of the extras cannot be written to. Check who owns it.")
    errors = [line for line in lines if "ERROR" in line] or list(lines[-1:])
    why = " ".join(errors).replace("ERROR: ", "").strip() or f"pip ended with {code}"
    return phrase("It could not be installed ({why}). Check the network and try again.", why=why)


def _name(text: str) -> str:
    """Return a package's name from a file's name or from what was asked for."""
    return re.split(r"[<>=!~;\[ ]|-\d", text)[0]
