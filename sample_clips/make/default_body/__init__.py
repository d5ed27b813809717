"""The default body, which is drawn for every skeleton without a mesh of its own: its joints, its forms, and
which joints each point follows.
"""
