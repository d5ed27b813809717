"""Manual state machines: values, edits, checks, and the meta-graph they amount to."""
