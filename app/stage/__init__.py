"""What is looked at and what plays: selection, transport, performance, pictures, sound."""
