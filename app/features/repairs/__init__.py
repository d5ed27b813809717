"""What reading clips put right."""
