"""Hold the document and its files: who has one open, saving and recovering, other programs, watching, and
jobs.
"""
