"""The tiny study, for the command line."""

from tests.app.features.study.conftest import tiny as tiny
