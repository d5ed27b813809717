# Keyed randomness: every draw is a hash of (seed, words), in 32-bit integers. Nothing is remembered between draws.

const MASK = 0xFFFFFFFF
const OFFSET = 0x811C9DC5  # FNV-1a's, 32 bits
const PRIME = 0x01000193
# MurmurHash3's factors less 2^32: so products stay within 64 signed bits, and their low 32 bits are the same.
const MIX_A = 0x85EBCA6B - 0x100000000
const MIX_B = 0xC2B2AE35 - 0x100000000

var shim


func _init(engine_shim):
	shim = engine_shim


# Returns 32 scrambled bits.
static func mix(value):
	value &= MASK
	value ^= value >> 16
	value = (value * MIX_A) & MASK
	value ^= value >> 13
	value = (value * MIX_B) & MASK
	return value ^ (value >> 16)


# Returns the 32-bit hash of a seed and words: FNV-1a over their UTF-8 bytes, each word closed by a zero byte, then mixed.
func key32(seed32, words):
	var value = (OFFSET ^ mix(seed32)) & MASK
	for word in words:
		value = _absorb(value, word)
	return mix(value)


# Returns a number in the open interval (0, 1).
func uniform(seed32, words):
	return (key32(seed32, words) + 0.5) / 4294967296.0


# Returns one of the ids of `weights` {id: weight}, id k with probability weight_k / sum; "" where no weight is positive.
# Each id runs its own race, so that adding one changes the choice only where that one wins.
func pick(seed32, key, purpose, weights):
	var best = ""
	var shortest = INF
	var begun = _absorb(_absorb((OFFSET ^ mix(seed32)) & MASK, key), purpose)
	for ident in weights:
		if weights[ident] > 0:
			var time = -log((mix(_absorb(begun, ident)) + 0.5) / 4294967296.0) / weights[ident]
			if time < shortest or (time == shortest and ident < best):
				best = ident
				shortest = time
	return best


func _absorb(value, word):
	for byte in shim.utf8(word):
		value = ((value ^ byte) * PRIME) & MASK
	return (value * PRIME) & MASK  # the closing zero byte
