"""Transcripts of speech services, a module each. Each is written from the service's published description."""
