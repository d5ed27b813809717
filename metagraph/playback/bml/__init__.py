"""Behaviour Markup Language (BML 1.0), read and written."""
