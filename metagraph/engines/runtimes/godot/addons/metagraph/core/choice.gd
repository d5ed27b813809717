# Keyed randomness: every draw is a hash of (seed, key, purpose), in 32-bit integers that any language mixes in the same way.
#
# Draws remember nothing, so a change of one request does not change the draws of the others.
#
# Translated from metagraph/playback/planning/choice.py; change that, and translate anew.

const Hashing = preload("hashing.gd")
const Util = preload("util.gd")
const ALL = 4294967296.0  # numbers of 32 bits


# Return the 32-bit hash of a seed and words: FNV-1a over their UTF-8 bytes, each word closed by a zero byte, then mixed.
#
# The mixed seed is xored into FNV's offset basis.
static func key32(seed_, words):
	return Hashing.mix(keyed(seed_, words))


# Return the hash of a seed and words before it is mixed, which all draws of one key share.
static func keyed(seed_, words):
	var value = Hashing.begun(seed_)
	for word in words:
		value = Hashing.absorb(value, word)
	return value


# Return a number in the open interval (0, 1).
static func uniform(seed_, words):
	return (Hashing.mix(keyed(seed_, words)) + 0.5) / ALL


# Return the number that `uniform` returns for a key and one more word.
static func chance_of(key, purpose):
	return (Hashing.mix(Hashing.absorb(key, purpose)) + 0.5) / ALL


# Return a log-normal number from two uniform ones in (0, 1) by Box and Muller, in a way that any language can compute: `a = ln(1
# + (s / m)^2)`, `z = sqrt(-2 ln u) cos(2 pi v)`, `m exp(sqrt(a) z - a / 2)`.
static func log_normal(mean, deviation, u, v):
	var share = deviation / mean
	var spread = Util.log1p(share * share)
	var z = sqrt(-2.0 * log(u)) * cos(2.0 * PI * v)
	return mean * exp(sqrt(spread) * z - spread / 2.0)


# Return one of the ids, chosen as by `picked`.
static func pick(seed_, key, purpose, weights):
	return picked(keyed(seed_, [key]), purpose, weights)


# Return one of the ids, id k with probability weight_k / sum.
#
# Each id draws its own exponential time, -log(u_k) / weight_k, and the shortest wins. So adding or removing a candidate changes
# the choice only if that candidate wins. Raises ValueError when no weight is positive.
static func picked(key, purpose, weights):
	var best = ""
	var shortest = INF
	var start = Hashing.absorb(key, purpose)
	for ident in weights:
		var weight = weights[ident]
		if weight > 0:
			var time = -log((Hashing.mix(Hashing.absorb(start, ident)) + 0.5) / ALL) / weight
			if time < shortest or (time == shortest and ident < best):
				best = ident
				shortest = time
	if best == "":
		push_error("nothing to choose from")
		return null
	return best
