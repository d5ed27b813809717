"""The features: each a folder that exports `contribute(shell)`, and none knows another."""
