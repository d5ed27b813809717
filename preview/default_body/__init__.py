"""The default body: a mannequin that is drawn for every skeleton of a person without a mesh of its own.

It was sculpted once (`sample_clips.make.default_body`). `bind` brings a skeleton into the pose in which it
was sculpted, `fit` brings its surface to the skeleton's measures and says which joints each point
follows, and `figure` draws it.
"""
