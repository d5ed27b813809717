"""The document and its files, journals, watching and jobs."""
