# Vectors and rotations as plain tuples, for code that computes one pose at a time, the same in all languages. Vectors are x, y,
# z; quaternions xyzw, of length 1.
#
# Translated from metagraph/motion/plain_vectors.py; change that, and translate anew.

const Util = preload("util.gd")


# Return the product: rotate by `b`, then by `a`.
static func times(a, b):
	var both = a
	var ax = both[0]
	var ay = both[1]
	var az = both[2]
	var aw = both[3]
	var both2 = b
	var bx = both2[0]
	var by = both2[1]
	var bz = both2[2]
	var bw = both2[3]
	return [
		aw * bx + ax * bw + ay * bz - az * by,
		aw * by - ax * bz + ay * bw + az * bx,
		aw * bz + ax * by - ay * bx + az * bw,
		aw * bw - ax * bx - ay * by - az * bz
	]


# Return a vector rotated.
static func rotated(q, v):
	var both = q
	var x = both[0]
	var y = both[1]
	var z = both[2]
	var w = both[3]
	var both2 = v
	var vx = both2[0]
	var vy = both2[1]
	var vz = both2[2]
	var tx = 2.0 * (y * vz - z * vy)
	var ty = 2.0 * (z * vx - x * vz)
	var tz = 2.0 * (x * vy - y * vx)
	return [vx + w * tx + y * tz - z * ty, vy + w * ty + z * tx - x * tz, vz + w * tz + x * ty - y * tx]


# Return the shortest rotation that takes one direction to another, both of length 1.
static func between(a, b):
	var both = a
	var ax = both[0]
	var ay = both[1]
	var az = both[2]
	var both2 = b
	var bx = both2[0]
	var by = both2[1]
	var bz = both2[2]
	var along = ax * bx + ay * by + az * bz
	if along < -0.999999999:  # half a turn about any axis across
		return unit_turn([0.0, az, -ay, 0.0] if Util.absolute(ax) < 0.9 else [-az, 0.0, ax, 0.0])
	return unit_turn([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx, 1.0 + along])


# Return the length of a vector.
static func length(v):
	var both = v
	var x = both[0]
	var y = both[1]
	var z = both[2]
	return sqrt(x * x + y * y + z * z)


# Return a vector of length 1 in the same direction; the zero vector stays as it is.
static func unit(v):
	return scaled(v, 1.0 / Util.most(length(v), 1e-12))


# Return a quaternion of length 1.
static func unit_turn(q):
	var both = q
	var x = both[0]
	var y = both[1]
	var z = both[2]
	var w = both[3]
	var k = 1.0 / Util.most(sqrt(x * x + y * y + z * z + w * w), 1e-12)
	return [x * k, y * k, z * k, w * k]


# Return the inverse rotation.
static func back(q):
	var both = q
	var x = both[0]
	var y = both[1]
	var z = both[2]
	var w = both[3]
	return [-x, -y, -z, w]


# Return the sum.
static func plus(a, b):
	var both = a
	var ax = both[0]
	var ay = both[1]
	var az = both[2]
	var both2 = b
	var bx = both2[0]
	var by = both2[1]
	var bz = both2[2]
	return [ax + bx, ay + by, az + bz]


# Return the difference.
static func minus(a, b):
	var both = a
	var ax = both[0]
	var ay = both[1]
	var az = both[2]
	var both2 = b
	var bx = both2[0]
	var by = both2[1]
	var bz = both2[2]
	return [ax - bx, ay - by, az - bz]


# Return a vector times a number.
static func scaled(a, k):
	var both = a
	var x = both[0]
	var y = both[1]
	var z = both[2]
	return [x * k, y * k, z * k]


# Return the scalar product.
static func dot(a, b):
	var both = a
	var ax = both[0]
	var ay = both[1]
	var az = both[2]
	var both2 = b
	var bx = both2[0]
	var by = both2[1]
	var bz = both2[2]
	return ax * bx + ay * by + az * bz
