"""What the three papers show, beside what Metagraph does: tables and drawings that one command makes
again.
"""
