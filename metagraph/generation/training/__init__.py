"""Learning motion from takes, with torch (extra `metagraph-studio[train]`): the only place that knows it.

It runs in a process of its own (`metagraph.generation.train_process`), and nothing else imports it.
"""
