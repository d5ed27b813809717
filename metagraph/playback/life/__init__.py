"""What keeps a character alive: breathing, gaze, saccades, blinks, lids and lips, all added to what the
layers play.
"""
