"""How a project is kept: its text and fields, its journal, versions, merging and verifying."""
