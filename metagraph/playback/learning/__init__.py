"""What annotated recordings teach: acts, sequences and the models they give."""
