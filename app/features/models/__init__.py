"""What follows what: models learned from annotations."""
