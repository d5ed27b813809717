"""Edits beside `graph.edits`: pure functions Project -> Project, one subject a module."""
