// Metagraph in C++17: plays what `metagraph export` writes. Headers alone; README.md says how they are used.
#pragma once

#include "character.hpp"
#include "loading.hpp"
#include "talk.hpp"
