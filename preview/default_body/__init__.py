"""The default body: a mannequin that is drawn for every skeleton of a person without a mesh of its own.

It was sculpted once (`sample_clips.make.default_body`). `metagraph.motion.fitting` brings it to a skeleton,
and `figure` draws it.
"""
