# Arithmetic of rotations: unit quaternions xyzw, vectors in metres or radians, in the engine's own types.


# Returns a vector rotated.
static func rotate(q, v):
	var axis = Vector3(q.x, q.y, q.z)
	var t = axis.cross(v) * 2.0
	return v + t * q.w + axis.cross(t)


# Returns a rotation undone.
static func back(q):
	var out = q
	out.x = -q.x
	out.y = -q.y
	out.z = -q.z
	return out


# Returns `a` blended to `b` by `weight` in 0..1: a normalised straight line along the shorter arc.
static func nlerp(a, b, weight):
	return (a * (1.0 - weight) + b * (-weight if a.dot(b) < 0 else weight)).normalized()


# Returns `a` blended to `b` by `weight` in 0..1 at constant speed along the shorter arc.
static func slerp(a, b, weight):
	return a * power(back(a) * b, weight)


# Returns part of a turn as the normalised straight line from no rotation.
static func part(q, weight):
	var out = q * (-weight if q.w < 0 else weight)
	out.w += 1.0 - weight
	return out.normalized()


# Returns a rotation by `weight` times its angle, the short way.
static func power(q, weight):
	var sign_of = -1.0 if q.w < 0 else 1.0
	var size = sqrt(q.x * q.x + q.y * q.y + q.z * q.z)
	var half = atan2(size, q.w * sign_of) * weight
	var k = sign_of * (sin(half) / size if size > 1e-8 else weight)
	var out = q
	out.x = q.x * k
	out.y = q.y * k
	out.z = q.z * k
	out.w = cos(half)
	return out


# Returns the rotation of a rotation vector; `one` is any quaternion.
static func of(vector, one):
	var size = vector.length()
	var k = sin(0.5 * size) / size if size > 1e-12 else 0.5
	one.x = vector.x * k
	one.y = vector.y * k
	one.z = vector.z * k
	one.w = cos(0.5 * size)
	return one
