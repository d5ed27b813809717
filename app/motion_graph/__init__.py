"""The window of the frame-level motion graph: takes, what counts as a jump, new motion that goes with speech."""
