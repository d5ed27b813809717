"""The parts of a study's report: figures, tables, words and style."""
