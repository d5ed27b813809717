"""The editor of manual state machines: what the meta-graph is compared with, as good as the engines' own."""
