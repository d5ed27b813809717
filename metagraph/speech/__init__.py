"""Speech: from sound files and phones to what the life layers and the planner need to know of a spoken
line.
"""
