"""Proposals for labels: what a clip is, from its name, its motion, and what is labelled already; each with a
reason in words.
"""
