# The words modes are told apart by.

const MODES = ["idle", "listening", "talking"]
