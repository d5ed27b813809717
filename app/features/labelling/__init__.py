"""Proposals for clips, looked through and accepted."""
