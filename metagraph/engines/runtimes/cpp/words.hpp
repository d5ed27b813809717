// The words layers, modes and mouth shapes are told apart by.
#pragma once

#include "language.hpp"

namespace metagraph {
namespace words {

/// Layers in the order in which their offsets are multiplied onto the base pose.
inline const List<std::string> LAYERS = List<std::string>{"body", "arms", "head"};
inline const List<std::string> MODES = List<std::string>{"idle", "listening", "talking", "thinking", "reacting"};
inline const List<std::string> VISEMES = List<std::string>{
    "sil", "PP", "FF", "TH", "DD", "kk", "CH", "SS", "nn", "RR", "aa", "E", "I", "O", "U",
};

}  // namespace words
}  // namespace metagraph
