// The words modes are told apart by.
#pragma once

#include "language.hpp"

namespace metagraph {
namespace words {

inline const List<std::string> MODES = List<std::string>{"idle", "listening", "talking"};

}  // namespace words
}  // namespace metagraph
