"""Motion made again from long takes: a graph over their frames, and paths through it (Yang et al.,
"Statistics-based Motion Synthesis for Social Conversations", 2020).
"""
