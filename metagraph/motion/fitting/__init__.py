"""Bodies on skeletons that they were not made for.

`bind` brings a skeleton into the pose in which a body was made, `fit` brings the body's surface to the
skeleton's measures and says which joints each point follows, and `fit_character` makes a character of both.
`footing` says how a skeleton stands.
"""
