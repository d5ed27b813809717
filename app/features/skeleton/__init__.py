"""Roles and body parts of the joints."""
