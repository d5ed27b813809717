// Vectors and rotations as plain tuples, for code that computes one pose at a time, the same in all languages. Vectors
// are x, y, z; quaternions xyzw, of length 1.
//
// Translated from metagraph/motion/plain_vectors.py; change that, and translate anew.
#pragma once

#include "language.hpp"

namespace metagraph {


namespace plain_vectors {

inline std::tuple<double, double, double, double> times(
    const std::tuple<double, double, double, double>& a,
    const std::tuple<double, double, double, double>& b
);
inline std::tuple<double, double, double> rotated(
    const std::tuple<double, double, double, double>& q,
    const std::tuple<double, double, double>& v
);
inline std::tuple<double, double, double, double> between(
    const std::tuple<double, double, double>& a,
    const std::tuple<double, double, double>& b
);
inline double length(const std::tuple<double, double, double>& v);
inline std::tuple<double, double, double> unit(const std::tuple<double, double, double>& v);
inline std::tuple<double, double, double, double> unit_turn(const std::tuple<double, double, double, double>& q);
inline std::tuple<double, double, double, double> back(const std::tuple<double, double, double, double>& q);
inline std::tuple<double, double, double> plus(
    const std::tuple<double, double, double>& a,
    const std::tuple<double, double, double>& b
);
inline std::tuple<double, double, double> minus(
    const std::tuple<double, double, double>& a,
    const std::tuple<double, double, double>& b
);
inline std::tuple<double, double, double> scaled(const std::tuple<double, double, double>& a, double k);
inline double dot(const std::tuple<double, double, double>& a, const std::tuple<double, double, double>& b);

}  // namespace plain_vectors

namespace plain_vectors {

/// Return the product: rotate by `b`, then by `a`.
inline std::tuple<double, double, double, double> times(
    const std::tuple<double, double, double, double>& a,
    const std::tuple<double, double, double, double>& b
) {
    auto [ax, ay, az, aw] = a;
    auto [bx, by, bz, bw] = b;
    return std::tuple<double, double, double, double>{
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz
    };
}

/// Return a vector rotated.
inline std::tuple<double, double, double> rotated(
    const std::tuple<double, double, double, double>& q,
    const std::tuple<double, double, double>& v
) {
    auto [x, y, z, w] = q;
    auto [vx, vy, vz] = v;
    double tx = 2.0 * (y * vz - z * vy);
    double ty = 2.0 * (z * vx - x * vz);
    double tz = 2.0 * (x * vy - y * vx);
    return std::tuple<double, double, double>{
        vx + w * tx + y * tz - z * ty,
        vy + w * ty + z * tx - x * tz,
        vz + w * tz + x * ty - y * tx
    };
}

/// Return the shortest rotation that takes one direction to another, both of length 1.
inline std::tuple<double, double, double, double> between(
    const std::tuple<double, double, double>& a,
    const std::tuple<double, double, double>& b
) {
    auto [ax, ay, az] = a;
    auto [bx, by, bz] = b;
    double along = ax * bx + ay * by + az * bz;
    if (along < -0.999999999) { // half a turn about any axis across
        return plain_vectors::unit_turn(
            std::abs(ax) < 0.9
                ? std::tuple<double, double, double, double>{0.0, az, -ay, 0.0}
                : std::tuple<double, double, double, double>{-az, 0.0, ax, 0.0}
        );
    }
    return plain_vectors::unit_turn(
        std::tuple<double, double, double, double>{ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx, 1.0 + along}
    );
}

/// Return the length of a vector.
inline double length(const std::tuple<double, double, double>& v) {
    auto [x, y, z] = v;
    return std::sqrt(x * x + y * y + z * z);
}

/// Return a vector of length 1 in the same direction; the zero vector stays as it is.
inline std::tuple<double, double, double> unit(const std::tuple<double, double, double>& v) {
    return plain_vectors::scaled(v, 1.0 / std::max(plain_vectors::length(v), 1e-12));
}

/// Return a quaternion of length 1.
inline std::tuple<double, double, double, double> unit_turn(const std::tuple<double, double, double, double>& q) {
    auto [x, y, z, w] = q;
    double k = 1.0 / std::max(std::sqrt(x * x + y * y + z * z + w * w), 1e-12);
    return std::tuple<double, double, double, double>{x * k, y * k, z * k, w * k};
}

/// Return the inverse rotation.
inline std::tuple<double, double, double, double> back(const std::tuple<double, double, double, double>& q) {
    auto [x, y, z, w] = q;
    return std::tuple<double, double, double, double>{-x, -y, -z, w};
}

/// Return the sum.
inline std::tuple<double, double, double> plus(
    const std::tuple<double, double, double>& a,
    const std::tuple<double, double, double>& b
) {
    auto [ax, ay, az] = a;
    auto [bx, by, bz] = b;
    return std::tuple<double, double, double>{ax + bx, ay + by, az + bz};
}

/// Return the difference.
inline std::tuple<double, double, double> minus(
    const std::tuple<double, double, double>& a,
    const std::tuple<double, double, double>& b
) {
    auto [ax, ay, az] = a;
    auto [bx, by, bz] = b;
    return std::tuple<double, double, double>{ax - bx, ay - by, az - bz};
}

/// Return a vector times a number.
inline std::tuple<double, double, double> scaled(const std::tuple<double, double, double>& a, double k) {
    auto [x, y, z] = a;
    return std::tuple<double, double, double>{x * k, y * k, z * k};
}

/// Return the scalar product.
inline double dot(const std::tuple<double, double, double>& a, const std::tuple<double, double, double>& b) {
    auto [ax, ay, az] = a;
    auto [bx, by, bz] = b;
    return ax * bx + ay * by + az * bz;
}

}  // namespace plain_vectors

}  // namespace metagraph
