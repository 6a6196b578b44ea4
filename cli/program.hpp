#pragma once
/// The program `noether`, as a function: with parts of one's own it is a program of one's own.

#include "scene/parts.hpp"

namespace noether {

/// Does what the program does with these arguments: every command, over scenes that may name these parts.
///
///     int main(int argc, char** argv) {
///       noether::Parts parts = noether::standard_parts();
///       parts.add_force<Oblateness>();
///       return noether::program(argc, argv, parts);
///     }
///
/// @return the exit code
int program(int argc, char** argv, const Parts& parts = standard_parts());

}  // namespace noether
