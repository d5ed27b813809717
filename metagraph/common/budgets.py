"""What reading one file may cost, for every reader: nothing is allocated, and no loop begun, that a file asks
for beyond this.

A file is believed to be as large as it is, never as large as it says. What its content may ask for is either
counted here, or grows with its bytes (`Allowance`).
"""

from __future__ import annotations

from collections.abc import Callable

from metagraph.common.wording import phrase

KIB, MIB, GIB = 1 << 10, 1 << 20, 1 << 30

# Bytes of whole files, by what they hold.
MOTION_FILE = 2 * GIB
SOUND_FILE = 8 * GIB  # read block by block
TEXT_FILE = 256 * MIB  # projects, studies, exports, transcripts
MARKS_FILE = 64 * MIB  # annotations of one recording
KEYPOINTS_FILE = 512 * MIB
LOG_FILE = GIB
LIST_FILE = 64 * MIB  # lines of dialogue
ARRAYS = 4 * GIB  # what the arrays of an archive unpack to

# Motion.
FRAMES = 6 * 3600 * 240  # of one clip: six hours of the fastest cameras
FRAME_SECONDS = (1e-4, 60.0)  # one frame lasts
CLIP_SECONDS = 6 * 3600.0
JOINTS = 4096
JOINTS_DEEP = 1024  # each on the one before: what looks along such lines takes their length for each joint
NODES = 250_000
FBX_SAMPLES = 20_000_000  # transforms asked of the library, one by one
FBX_MEMORY = 8 * GIB  # of the process that reads one

# Meshes and pictures.
VERTICES = 20_000_000
PICTURE_PIXELS = 8_192 * 8_192

# Sound and speech. Rates: from what telephones have to the fastest converters.
SOUND_RATES = (4_000, 768_000)
SOUND_CHANNELS = 64
SOUND_SAMPLES = 2 * 7_200 * 48_000  # kept of all channels
SOUND_BLOCK = 4_000_000  # numbers read at once
SOUND_LOUDEST = 2.0**32  # times full scale: some write whole numbers as they are; beyond it is damage
LINE_SECONDS = 1800.0
CONVERSATION_SECONDS = 7200.0
MARKS = 1_000_000  # words, intervals, annotations of one file
KEYPOINT_FRAMES = 2_000_000
KEYPOINT_SECONDS = 36_000.0 - 60.0  # a performance lasts ten hours at most

# Text.
NESTING = 64
NAME_BYTES = 120  # of the stem of a file that we name: with endings and hashes it stays below 255 everywhere
PATH_LENGTH = 4096  # characters of a path that a file names

_FREE, _PER_BYTE, _MOST = 64 * MIB, 64, 8 * GIB


class Allowance:
    """Bytes that may still be allocated for one file: some for any file, and some for each byte it has.
    refuse: called with where it was exceeded; it raises.
    """

    def __init__(self, size: int, refuse: Callable[[str], None]) -> None:
        self._left = min(_FREE + _PER_BYTE * size, _MOST)
        self._refuse = refuse

    def add(self, size: int) -> None:
        """Allow for `size` bytes more that were read."""
        self._left = min(self._left + _PER_BYTE * size, _MOST)

    def spend(self, size: int, where: str = "") -> None:
        """Count `size` bytes about to be allocated."""
        self._left -= size
        if self._left < 0:
            self._refuse(where)


OUT_OF_PROPORTION = phrase("it asks for far more memory than its size warrants")
