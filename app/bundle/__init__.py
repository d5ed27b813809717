"""Makes the program that needs no Python: a folder with its own, packed as .tar.xz and .deb.

`python -m app.bundle OUT`. It runs on Linux with the glibc of the Python it is made with, or a newer one
(docs/contributing/bundles.md).
"""
