// Rotations as unit quaternions xyzw, vectors as xyz. `multiply(a, b)` applies b first, then a.
//
// All is worked out in doubles: a chain of joints multiplies errors, and of what a processor does here most is waiting
// for memory. What is kept of clips is floats, which halves that memory and is finer than the clips' own 16 bits.
#pragma once

#include "language.hpp"

namespace metagraph {

struct Vec {
    double x = 0.0, y = 0.0, z = 0.0;

    double operator[](int n) const { return n == 0 ? x : n == 1 ? y : z; }
    Vec operator+(const Vec& b) const { return {x + b.x, y + b.y, z + b.z}; }
    Vec operator-(const Vec& b) const { return {x - b.x, y - b.y, z - b.z}; }
    Vec operator*(double k) const { return {x * k, y * k, z * k}; }
    Vec& operator+=(const Vec& b) { return x += b.x, y += b.y, z += b.z, *this; }
    bool operator==(const Vec& b) const { return x == b.x && y == b.y && z == b.z; }
    bool operator!=(const Vec& b) const { return !(*this == b); }
};

struct Quat {
    double x = 0.0, y = 0.0, z = 0.0, w = 1.0;

    Quat back() const { return {-x, -y, -z, w}; }
};

/// A joint: its rotation and translation in its parent's space, metres.
struct Joined {
    Quat rotation;
    Vec translation;
};

namespace rotation {

inline double dot(const Vec& a, const Vec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline double dot(const Quat& a, const Quat& b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }

inline Quat multiply(const Quat& a, const Quat& b) {
    return {
        a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
        a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
        a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
        a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
    };
}

/// A vector turned.
inline Vec rotate(const Quat& q, const Vec& v) {
    const double tx = 2 * (q.y * v.z - q.z * v.y);
    const double ty = 2 * (q.z * v.x - q.x * v.z);
    const double tz = 2 * (q.x * v.y - q.y * v.x);
    return {
        v.x + q.w * tx + q.y * tz - q.z * ty,
        v.y + q.w * ty + q.z * tx - q.x * tz,
        v.z + q.w * tz + q.x * ty - q.y * tx,
    };
}

inline Quat scaled(const Quat& q, double k) { return {q.x * k, q.y * k, q.z * k, q.w * k}; }

/// To unit length.
inline Quat normalized(const Quat& q) { return scaled(q, 1 / std::sqrt(std::max(dot(q, q), 1e-20))); }

/// The turn by a rotation vector: axis times angle, radians.
inline Quat from_vector(const Vec& v) {
    const double size = std::sqrt(dot(v, v) + 1e-30);
    const double s = std::sin(0.5 * size) / size;
    return {v.x * s, v.y * s, v.z * s, std::cos(0.5 * size)};
}

/// Turned the short way by `weight` times its angle.
inline Quat power(const Quat& q, double weight) {
    const double sign = q.w < 0 ? -1 : 1;
    const double s = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z);
    const double factor = sign * weight * (s > 1e-8 ? 2 * std::atan2(s, sign * q.w) / s : 2);
    return from_vector({q.x * factor, q.y * factor, q.z * factor});
}

/// Blended by `weight` of the second along the shorter arc: a normalised straight line.
inline Quat nlerp(const Quat& a, const Quat& b, double weight) {
    const double v = dot(a, b) < 0 ? -weight : weight, u = 1 - weight;
    return normalized({a.x * u + b.x * v, a.y * u + b.y * v, a.z * u + b.z * v, a.w * u + b.w * v});
}

/// The same at constant speed.
inline Quat slerp(const Quat& a, const Quat& b, double weight) {
    double cosine = dot(a, b);
    const double sign = cosine < 0 ? -1 : 1;
    cosine *= sign;
    if (cosine > 0.9999) return nlerp(a, b, weight); // as good, where they are close
    const double angle = std::acos(cosine);
    const double u = std::sin((1 - weight) * angle) / std::sin(angle);
    const double v = sign * std::sin(weight * angle) / std::sin(angle);
    return {a.x * u + b.x * v, a.y * u + b.y * v, a.z * u + b.z * v, a.w * u + b.w * v};
}

/// Return joints' rotations and positions in the character's space. parents: before their children, -1 for none.
inline List<Joined> globals(const List<int>& parents, const List<Joined>& pose) {
    List<Joined> out = pose;
    for (std::size_t j = 0; j < out.size(); j++) {
        if (parents[j] < 0) continue;
        const Joined& above = out[static_cast<std::size_t>(parents[j])];
        out[j].translation = above.translation + rotate(above.rotation, pose[j].translation);
        out[j].rotation = multiply(above.rotation, pose[j].rotation);
    }
    return out;
}

/// 3x^2 - 2x^3 of x clamped to 0..1.
inline double ease(double x) { return x <= 0 ? 0 : x >= 1 ? 1 : x * x * (3 - 2 * x); }

}  // namespace rotation
}  // namespace metagraph
