"""A zoo of made label sets: whole sets of clips, as other studios would have them, with the truth about each.

All come from the sample clips, layered or put together to recordings of the whole body, and from a few made
steps and exercises; by seed they get another figure, another recording, other names and other troubles. See
`sets` for what there is; nothing of it was recorded elsewhere.
"""
