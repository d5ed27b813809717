// Where something is: a name or a point.
#pragma once

#include "language.hpp"
#include "rotation.hpp"

namespace metagraph {

/// A named point, or one in metres of the character's space.
struct Spot {
    std::string name;
    std::optional<Vec> point;
};

namespace spots {

/// What has a name.
inline Ref<Spot> named(const std::string& name) { return lang::made<Spot>(Spot{name, {}}); }

/// A point of three numbers.
inline Ref<Spot> point(const List<double>& at) { return lang::made<Spot>(Spot{"", Vec{at[0], at[1], at[2]}}); }

/// The point that a name stands for among places, else what was given.
inline Ref<Spot> placed(const Map<std::string, List<double>>& places, const Ref<Spot>& to) {
    const List<double>* found = to->point.has_value() ? nullptr : places.find(to->name);
    return found == nullptr ? to : point(*found);
}

/// Whether two names or two points are the same.
inline bool is_same_spot(const Ref<Spot>& one, const Ref<Spot>& other) {
    return one->name == other->name && one->point == other->point;
}

}  // namespace spots
}  // namespace metagraph
