"""Hold what the user looks at and what plays: selection, transport, performance, pictures, sound."""
