"""Check one part of a project each; `graph.check` calls them all."""
