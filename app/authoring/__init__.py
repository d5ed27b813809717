"""What a program, such as a language model, can do to a project: a table of tools, each a function over the
project, and what keeps their results as steps that can be undone.
"""
