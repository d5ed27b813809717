"""The parent's end of the process that looks for a person in pictures."""

from __future__ import annotations

import json
from contextlib import suppress
from typing import Any

from metagraph.common.child_channel import Child
from metagraph.common.extras import EXTRAS, find_extra_folder
from metagraph.common.wording import phrase
from metagraph.formats.filmed.estimator_child import HEAD
from metagraph.formats.filmed.video import FilmedPicture

EXTRA = "camera"
CHILD = "metagraph.formats.filmed.estimator_child"
PATIENCE = 2.0  # seconds for the child to end by itself


class EstimatorError(RuntimeError):
    """Pictures cannot be looked at; the message says why and what to do."""


class EstimatorMissingError(EstimatorError):
    """The extra is not installed."""

    def __init__(self) -> None:
        extra = EXTRAS[EXTRA]
        super().__init__(
            phrase(
                "Videos and cameras need MediaPipe, which is not installed ({megabytes} MB, {licence}). "
                "Install it: metagraph extras add {extra}. Or give keypoints of any pose estimator.",
                megabytes=extra.megabytes,
                licence=extra.licence,
                extra=EXTRA,
            )
        )


class PoseEstimator:
    """Looks for a person in pictures; close it. name: of the estimator, with its version. Raises
    EstimatorMissingError where the extra is missing, EstimatorError where it does not run here.
    """

    def __init__(self) -> None:
        folder = find_extra_folder(EXTRA)
        if folder is None:
            raise EstimatorMissingError
        try:
            self._child = Child(CHILD, str(folder))
        except OSError as error:
            raise EstimatorError(phrase("MediaPipe does not start: {words}.", words=error)) from None
        try:
            self.name = str(self._receive().get("estimator", ""))
        except BaseException:
            self.close()
            raise

    def look(self, picture: FilmedPicture) -> dict[str, Any]:
        """Return a frame of keypoints, as `metagraph.formats.keypoints.reader` reads one. Raises
        EstimatorError.
        """
        height, width = picture.picture.shape[:2]
        with suppress(OSError):  # it has ended; receiving says so
            self._child.send(HEAD.pack(picture.seconds, height, width) + picture.picture.tobytes())
        return self._receive()

    def _receive(self) -> dict[str, Any]:
        try:
            answer = json.loads(self._child.receive())
        except (EOFError, ValueError):
            self._child.end(PATIENCE)
            raise EstimatorError(
                phrase(
                    "MediaPipe stopped by itself (code {code}). It needs a processor with AVX. Give "
                    "keypoints of any other pose estimator.",
                    code=self._child.process.returncode,
                )
            ) from None
        if not isinstance(answer, dict) or "error" in answer:
            words = answer.get("error") if isinstance(answer, dict) else answer
            raise EstimatorError(
                phrase(
                    "MediaPipe does not run here: {words}. Install it again: metagraph extras add {extra}.",
                    words=str(words)[:300],
                    extra=EXTRA,
                )
            )
        return answer

    def close(self) -> None:
        """End the process."""
        self._child.close(PATIENCE)
