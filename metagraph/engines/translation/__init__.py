"""Translates the rules of playing, typed Python, into the languages of the engines.

`python -m metagraph.engines.translation` writes all of it again. What is translated is given in `listing.py`,
what may be written there in `docs/contributing/translatable-python.md`.
"""
