"""Propose labels for clips, from their names, their motion, and existing labels; each with a reason
in words.
"""
