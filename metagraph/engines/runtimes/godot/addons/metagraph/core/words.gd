# The words layers, modes and mouth shapes are told apart by.

const Util = preload("util.gd")
const LAYERS = Util.LAYERS
const MODES = ["idle", "listening", "talking", "thinking", "reacting"]
const VISEMES = ["sil", "PP", "FF", "TH", "DD", "kk", "CH", "SS", "nn", "RR", "aa", "E", "I", "O", "U"]
