# Keyed randomness: every draw is a hash of (seed, key, purpose), in 32-bit integers that any language can mix alike.
#
# Nothing is remembered between draws, so changing one request leaves the draws of all others as they were.
#
# Translated from metagraph/playback/choice.py; change that, and translate anew.

const Hashing = preload("hashing.gd")


# Return the 32-bit hash of a seed and words: FNV-1a over their UTF-8 bytes, each word closed by a zero byte, then mixed.
#
# The seed, mixed, is xored into FNV's offset basis.
static func key32(seed_, words):
	var value = Hashing.begun(seed_)
	for word in words:
		value = Hashing.absorb(value, word)
	return Hashing.mix(value)


# Return a number in the open interval (0, 1).
static func uniform(seed_, words):
	return _unit(key32(seed_, words))


# Return one of the ids, id k with probability weight_k / sum.
#
# Each id runs its own race, the shortest of exponential times -log(u_k) / weight_k wins; so adding or removing one candidate
# changes the choice only where that candidate wins. Raises ValueError when no weight is positive.
static func pick(seed_, key, purpose, weights):
	var best = ""
	var shortest = INF
	var start = Hashing.absorb(Hashing.absorb(Hashing.begun(seed_), key), purpose)
	for ident in weights:
		var weight = weights[ident]
		if weight > 0:
			var time = -log(_unit(Hashing.mix(Hashing.absorb(start, ident)))) / weight
			if time < shortest or (time == shortest and ident < best):
				best = ident
				shortest = time
	if best == "":
		push_error("nothing to choose from")
		return null
	return best


static func _unit(bits):
	return (bits + 0.5) / 4294967296.0
