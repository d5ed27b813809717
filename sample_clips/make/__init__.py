"""Code that makes the sample clips, the mannequin and the sample projects: `python -m sample_clips.make`."""
