# Thirty-two bits from texts: FNV-1a over their UTF-8 bytes, and MurmurHash3's finaliser.

const MASK = 0xFFFFFFFF
const OFFSET = 0x811C9DC5  # FNV-1a's, 32 bits
const PRIME = 0x01000193
# MurmurHash3's factors less 2^32: so products stay within 64 signed bits, and their low 32 bits are the same.
const MIX_A = 0x85EBCA6B - 0x100000000
const MIX_B = 0xC2B2AE35 - 0x100000000


# Returns 32 scrambled bits.
static func mix(value):
	value &= MASK
	value ^= value >> 16
	value = (value * MIX_A) & MASK
	value ^= value >> 13
	value = (value * MIX_B) & MASK
	return value ^ (value >> 16)


# Returns a hash that has taken in a word and the zero byte that closes it.
static func absorb(value, word):
	for byte in _utf8(word):
		value = ((value ^ byte) * PRIME) & MASK
	return (value * PRIME) & MASK


# Returns the hash before any word.
static func begun(seed_):
	return (OFFSET ^ mix(seed_)) & MASK


# Returns a text's bytes. Godot 4 has another name for it.
static func _utf8(word):
	return word.to_utf8() if Engine.get_version_info().major < 4 else word.to_utf8_buffer()
