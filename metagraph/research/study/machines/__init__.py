"""Machines that participants made, in normal form, and what drawing them takes."""
