"""What an export can be written for: one module a target, all of one shape
(`metagraph.engines.targets.target.ExportTarget`).
"""
